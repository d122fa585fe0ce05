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
    explicit Threads(std::size_t count)
    {
        for (std::size_t k = 1; k < count; ++k) helpers_.emplace_back([this] { help(); });
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

    // Calls `task`, which must not throw, with each of the numbers below `items` once; returns when all are done.
    void run(std::size_t items, const Task& task)
    {
        {
            const std::scoped_lock lock(mutex_);
            task_ = &task, items_ = items, next_ = 0, busy_ = helpers_.size(), ++round_;
        }
        begun_.notify_all();
        work(task, items);
        std::unique_lock lock(mutex_);
        ended_.wait(lock, [this] { return busy_ == 0; });
    }

  private:
    void work(const Task& task, std::size_t items)
    {
        for (std::size_t item = next_++; item < items; item = next_++) task(item);
    }

    void help()
    {
        for (std::size_t seen = 0;;) {
            std::unique_lock lock(mutex_);
            begun_.wait(lock, [&] { return over_ || round_ != seen; });
            if (over_) return;
            seen = round_;
            const Task& task = *task_;
            const std::size_t items = items_;
            lock.unlock();
            work(task, items);
            lock.lock();
            if (--busy_ == 0) ended_.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable begun_, ended_;
    const Task* task_ = nullptr;
    std::size_t items_ = 0, busy_ = 0, round_ = 0;  // busy: helpers that have not ended this round
    std::atomic<std::size_t> next_{0};
    bool over_ = false;
    std::vector<std::thread> helpers_;
};

}  // namespace eel_core
