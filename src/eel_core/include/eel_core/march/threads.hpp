// SPDX-License-Identifier: Apache-2.0
// Threads that share the items of a task among them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace eel_core {

class Threads {
  public:
    using Task = std::function<void(std::size_t)>;

    // `count` threads, of which the caller's own is one.
    explicit Threads(std::size_t count) : shares_(count)
    {
        for (std::size_t k = 1; k < count; ++k) helpers_.emplace_back([this, k] { help(k); });
    }
    ~Threads()
    {
        {
            const std::scoped_lock lock(mutex_);
            over_ = true;
        }
        begun_.notify_all();
        for (std::thread& helper : helpers_) helper.join();
    }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    // Calls `task`, which must not throw, with each of the numbers below `items` once; returns when all are done. A
    // helper that has not woken by then is not waited for.
    void run(std::size_t items, const Task& task)
    {
        const std::size_t count = shares_.size();
        {
            const std::scoped_lock lock(mutex_);
            for (std::size_t k = 0; k < count; ++k)
                shares_[k].next = k * items / count, shares_[k].end = (k + 1) * items / count;
            task_ = &task, under_way_ = true, ++round_;
        }
        begun_.notify_all();
        work(0);
        std::unique_lock lock(mutex_);
        under_way_ = false;
        ended_.wait(lock, [this] { return busy_ == 0; });
    }

  private:
    // Items of a thread, the same in each round while it keeps up: their data stay in its cache.
    struct alignas(64) Share {  // bytes, a line of the cache
        std::atomic<std::size_t> next{0};
        std::size_t end = 0;
    };

    // Its own items, then what others have left.
    void work(std::size_t own)
    {
        for (std::size_t k = 0; k < shares_.size(); ++k) {
            Share& share = shares_[(own + k) % shares_.size()];
            for (std::size_t item = share.next++; item < share.end; item = share.next++) (*task_)(item);
        }
    }

    void help(std::size_t own)
    {
        std::unique_lock lock(mutex_);
        for (std::size_t seen = 0;;) {
            begun_.wait(lock, [&] { return over_ || (under_way_ && round_ != seen); });
            if (over_) return;
            seen = round_, ++busy_;
            lock.unlock();
            work(own);
            lock.lock();
            if (--busy_ == 0) ended_.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable begun_, ended_;
    const Task* task_ = nullptr;
    std::vector<Share> shares_;
    std::size_t round_ = 0, busy_ = 0;  // busy: helpers at work
    bool under_way_ = false, over_ = false;
    std::vector<std::thread> helpers_;
};

}  // namespace eel_core
