// SPDX-License-Identifier: Apache-2.0
// Functions of numbers and lanes, to round-off.
#include <gtest/gtest.h>

#include "eel_core/algebra/numbers.hpp"

using namespace eel_core;

namespace {

// Expects that `of` a double, and of lanes all or some of which hold it, is `wanted`.
template <class Of>
void expect_near(double x, double wanted, double error, Of of)
{
    EXPECT_NEAR(of(x), wanted, error) << x;
    std::array<double, width> mixed{};
    for (std::size_t lane = 0; lane < width; ++lane) mixed[lane] = lane % 2 == 0 ? x : 0.5 * x;
    const Lanes found = of(Lanes::load(mixed.data()));
    for (std::size_t lane = 0; lane < width; lane += 2)
        EXPECT_NEAR(found[lane], wanted, error) << x << ", lane " << lane;
}

}  // namespace

TEST(Numbers, SineAndCosineToRoundOff)
{
    for (int k = -4000; k <= 4000; ++k) {
        const double angle = 0.005 * k;
        expect_near(angle, std::sin(angle), 5e-16, [](auto x) { return sine_and_cosine(x)[0]; });
        expect_near(angle, std::cos(angle), 5e-16, [](auto x) { return sine_and_cosine(x)[1]; });
    }
}

TEST(Numbers, SineAndCosineOfGreatAnglesLoseTheirAnglesRoundOffAlone)
{
    for (int k = 0; k <= 4000; ++k) {
        const double angle = 9e4 + 2.5 * k;
        expect_near(angle, std::sin(angle), 1.1e-11, [](auto x) { return sine_and_cosine(x)[0]; });
        expect_near(angle, std::cos(angle), 1.1e-11, [](auto x) { return sine_and_cosine(x)[1]; });
    }
}

TEST(Numbers, InverseFifthRootToRoundOff)
{
    for (int k = 0; k <= 8000; ++k) {
        const double x = std::exp(-69.0 + 92.0 * k / 8000.0), wanted = std::pow(x, -0.2);
        expect_near(x, wanted, 4e-15 * wanted, [](auto number) { return inverse_fifth_root(number); });
    }
}

TEST(Numbers, MaskOfTheFirstLanes)
{
    for (std::size_t count = 0; count <= width + 1; ++count)
        EXPECT_EQ(Mask::below(count).bits(), (1u << std::min(count, width)) - 1u) << count;
}
