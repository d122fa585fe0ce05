// SPDX-License-Identifier: Apache-2.0
// Threads that share the items of a task among them.
#pragma once

#include <atomic>
#include <chrono>
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
        try {
            for (std::size_t k = 1; k < count; ++k) helpers_.emplace_back([this, k] { help(k); });
        } catch (...) {  // the system has no more: end those that were started
            call(State::ended);
            throw;
        }
    }
    ~Threads() { call(State::ended); }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    // Wakes the helpers: they wait actively for a task, and sleep again if none comes soon.
    void wake() { call(State::expected); }

    // Calls `task`, which must not throw, with each of the numbers below `items` once; returns when all are done. A
    // helper that has not woken by then is not waited for.
    void run(std::size_t items, const Task& task)
    {
        const std::size_t count = shares_.size();
        for (std::size_t k = 0; k < count; ++k)
            shares_[k].next = k * items / count, shares_[k].end = (k + 1) * items / count;
        task_ = &task;
        call(State::under_way);
        work(0);
        {
            const std::scoped_lock lock(mutex_);
            state_ = State::over;  // no helper begins from now on
        }
        look_out([this] { return busy_ == 0; });
        std::unique_lock lock(mutex_);
        ended_.wait(lock, [this] { return busy_ == 0; });
    }

  private:
    enum class State { over, expected, under_way, ended };

    void call(State state)
    {
        {
            const std::scoped_lock lock(mutex_);
            if (state == State::expected && state_ == State::under_way) return;
            state_ = state, ++calls_;
        }
        called_.notify_all();
    }

    // Waits actively for a while until `come`: waking from sleep takes as long as several items.
    static void look_out(const auto& come)
    {
        using Clock = std::chrono::steady_clock;
        constexpr std::chrono::microseconds patience{100};
        for (const auto start = Clock::now(); !come() && Clock::now() < start + patience;) {
        }
    }

    // Items of a thread, the same in each round while it keeps up: their data stay in its cache.
    struct alignas(64) Share {  // bytes, a line of the cache
        std::atomic<std::size_t> next{0};
        std::size_t end = 0;
    };

    // Its own items, then the remaining ones of others.
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
            called_.wait(lock, [&] { return calls_ != seen; });
            if (state_ == State::expected) {
                lock.unlock();
                look_out([this] { return state_ != State::expected; });
                lock.lock();
            }
            seen = calls_;
            if (state_ == State::ended) return;
            if (state_ != State::under_way) continue;
            ++busy_;
            lock.unlock();
            work(own);
            lock.lock();
            if (--busy_ == 0) ended_.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable called_, ended_;
    const Task* task_ = nullptr;
    std::vector<Share> shares_;
    std::atomic<State> state_ = State::over;
    std::atomic<std::size_t> busy_ = 0;  // helpers at work
    std::size_t calls_ = 0;
    std::vector<std::jthread> helpers_;
};

}  // namespace eel_core
