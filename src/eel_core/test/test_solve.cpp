// SPDX-License-Identifier: Apache-2.0
// Symmetric systems: solutions, and matrices that are not positive definite.
#include <gtest/gtest.h>

#include <random>

#include "eel_core/algebra/solve.hpp"

using eel_core::Factored;

namespace {

// A positive definite matrix whose rows differ by some powers of ten.
template <std::size_t N>
Factored<N> matrix_from(std::mt19937& random)
{
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> exponent(-4.0, 4.0);
    std::array<std::array<double, N>, N> root;
    for (auto& row : root) {
        const double scale = std::exp(exponent(random));
        for (double& entry : row) entry = scale * normal(random);
    }
    Factored<N> matrix;
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j <= i; ++j)
            for (std::size_t k = 0; k < N; ++k) matrix.lower[matrix.at(i, j)] += root[i][k] * root[j][k];
    return matrix;
}

template <std::size_t N>
void expect_solved()
{
    std::mt19937 random(5);  // NOLINT(bugprone-random-generator-seed): the same matrices each time
    std::normal_distribution<double> normal;
    for (int k = 0; k < 50; ++k) {
        const Factored<N> matrix = matrix_from<N>(random);
        std::array<double, N> right;
        for (double& entry : right) entry = normal(random);
        Factored<N> factors = matrix;
        EXPECT_TRUE(factors.factor());
        std::array<double, N> x = right;
        factors.solve(x);
        double largest = 0.0;
        for (const double entry : matrix.lower)
            for (const double component : x) largest = std::max(largest, std::abs(entry * component));
        const std::array<double, N> product = matrix.times(x);
        for (std::size_t i = 0; i < N; ++i) EXPECT_NEAR(product[i], right[i], 1e-9 * largest);

        for (std::size_t i = 0; i < N; ++i) {
            Factored<N> negative = matrix;
            negative.lower[negative.at(i, i)] *= -1.0;
            EXPECT_FALSE(negative.factor());
        }
    }
}

}  // namespace

TEST(Solve, SolutionsOfSixEquations) { expect_solved<6>(); }

TEST(Solve, SolutionsOfThreeEquations) { expect_solved<3>(); }

TEST(Solve, MatricesWithoutANumberZeroOrInfiniteAreNotDefinite)
{
    for (const double value :
         {std::numeric_limits<double>::quiet_NaN(), 0.0, std::numeric_limits<double>::infinity()}) {
        Factored<6> matrix;
        matrix.lower.fill(value);
        EXPECT_FALSE(matrix.factor()) << value;
    }
}
