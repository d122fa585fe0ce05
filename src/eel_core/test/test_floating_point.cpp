// SPDX-License-Identifier: Apache-2.0
// The flags keep the arithmetic that the mechanics counts on. Inputs are volatile: nothing is computed by the compiler.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "eel_core/build_info.hpp"

TEST(FloatingPoint, NotANumberAndInfinityAreSeen)
{
    volatile double zero = 0.0;
    const double not_a_number = zero / zero;
    const double infinity = 1.0 / zero;
    EXPECT_TRUE(std::isnan(not_a_number));
    EXPECT_TRUE(std::isinf(infinity));
    EXPECT_FALSE(std::isfinite(not_a_number));
    EXPECT_FALSE(not_a_number == not_a_number);
}

TEST(FloatingPoint, SumsKeepTheirOrder)
{
    volatile double large = 1e16;
    volatile double one = 1.0;
    const double a = large, b = one, c = -large;
    EXPECT_EQ((a + b) + c, 0.0);  // b is lost in a; reordered it would be 1
}

TEST(FloatingPoint, SubnormalNumbersStay)
{
    volatile double smallest = std::numeric_limits<double>::min();
    EXPECT_GT(smallest / 4.0, 0.0);
}

TEST(FloatingPoint, ProductAndSumAreOneRoundingWhereTheProcessorHasIt)
{
    if (!eel_core::build_info().sanitizers.empty()) GTEST_SKIP() << "compiled without the optimisation that fuses them";
    volatile double near_one = 1.0 + 0x1p-30;
    volatile double rounded = near_one * near_one;
    const double remainder = near_one * near_one - rounded;  // fused: what the rounding of the product left; else 0
#if defined(__FMA__) || defined(__aarch64__)
    EXPECT_EQ(remainder, 0x1p-60);
#else
    EXPECT_EQ(remainder, 0.0);
#endif
}
