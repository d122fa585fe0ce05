// SPDX-License-Identifier: Apache-2.0
// A sanitizer that reports nothing is of no use: here each has something to report.
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <memory>
#include <thread>

#include "eel_core/build_info.hpp"

class Sanitizers : public testing::Test {
    void SetUp() override
    {
        if (eel_core::build_info().sanitizers != "address,undefined") GTEST_SKIP() << "built without these sanitizers";
    }
};

TEST_F(Sanitizers, ReportAReadBehindTheEndOfAnArray)
{
    const auto values = std::make_unique<double[]>(4);
    volatile int behind = 4;
    EXPECT_DEATH(std::printf("%g", values[static_cast<std::size_t>(behind)]), "heap-buffer-overflow");
}

TEST_F(Sanitizers, ReportAnOverflowOfIntegers)
{
    volatile int largest = std::numeric_limits<int>::max();
    EXPECT_DEATH(std::printf("%d", largest + 1), "signed integer overflow");
}

TEST(ThreadSanitizer, ReportsARace)
{
    if (eel_core::build_info().sanitizers != "thread") GTEST_SKIP() << "built without this sanitizer";
    const auto race = [] {
        int shared = 0;
        std::thread other([&shared] { ++shared; });
        ++shared;
        other.join();
        std::exit(0);
    };
    EXPECT_EXIT(race(), testing::ExitedWithCode(66), "data race");
}
