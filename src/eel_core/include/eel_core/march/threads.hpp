// SPDX-License-Identifier: Apache-2.0
// Threads that share the items of a task among them.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
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
        over_ = true;
        ++round_;
        round_.notify_all();
        for (std::thread& helper : helpers_) helper.join();
    }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    // Calls `task`, which must not throw, with each of the numbers below `items` once; returns when all are done. A
    // helper that has not woken by then is not waited for.
    void run(std::size_t items, const Task& task)
    {
        const std::size_t count = shares_.size();
        for (std::size_t k = 0; k < count; ++k)
            shares_[k].next = k * items / count, shares_[k].end = (k + 1) * items / count;
        task_ = &task;
        ++round_;
        round_.notify_all();
        work(0);
        ++round_;
        awaited(busy_, [](unsigned helpers) { return helpers == 0; });
    }

  private:
    // Items of a thread, the same in each round while it keeps up: their data stay in its cache.
    struct alignas(64) Share {  // bytes, a line of the cache
        std::atomic<std::size_t> next{0};
        std::size_t end = 0;
    };
    // A thread that sleeps wakes late, so it looks about first: longer than Python takes from one call to the next.
    static constexpr std::chrono::microseconds patience{100};

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
        for (unsigned seen = 0;;) {
            seen = awaited(round_, [&](unsigned round) { return round % 2 == 1 && round != seen; });
            if (over_) return;
            ++busy_;
            if (round_ % 2 == 1) work(own);  // else it is over, and nobody waits
            if (--busy_ == 0) busy_.notify_one();
        }
    }

    // The `number` once it `fits`.
    template <class Fits>
    static unsigned awaited(const std::atomic<unsigned>& number, const Fits& fits)
    {
        const auto sleep = std::chrono::steady_clock::now() + patience;
        for (;;) {
            const unsigned found = number;
            if (fits(found)) return found;
            if (std::chrono::steady_clock::now() < sleep)
                std::this_thread::yield();
            else
                number.wait(found);
        }
    }

    const Task* task_ = nullptr;
    std::vector<Share> shares_;
    std::atomic<unsigned> round_{0}, busy_{0};  // round: odd while it is under way; busy: helpers in it
    std::atomic<bool> over_{false};
    std::vector<std::thread> helpers_;
};

}  // namespace eel_core
