// SPDX-License-Identifier: Apache-2.0
// Works of actuators, wake, nose, drag, flow, fins, appendages and wrenches from outside: integrals of their powers,
// from the Lobatto points of each step.
#pragma once

#include "eel_core/internal_wrench.hpp"

namespace eel_core {

using WorkDone = Powers;  // [J], since the start

// Lobatto's points, as fractions of the step.
inline constexpr std::array<double, 4> lobatto{0.0, 0.276393202250021030, 0.723606797749978970, 1.0};

// For each of the points, the coefficients, constant first, of the cubic that is 1 there and 0 at the others.
constexpr std::array<std::array<double, 4>, 4> lagrange_cubics()
{
    std::array<std::array<double, 4>, 4> result{};
    for (std::size_t i = 0; i < 4; ++i) {
        result[i][0] = 1.0;
        std::size_t degree = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            if (j == i) continue;
            const double scale = 1.0 / (lobatto[i] - lobatto[j]);
            for (std::size_t k = ++degree; k > 0; --k)
                result[i][k] = scale * (result[i][k - 1] - lobatto[j] * result[i][k]);
            result[i][0] *= -lobatto[j] * scale;
        }
    }
    return result;
}

struct StepPowers {
    std::array<Powers, 4> at{};  // [W], at Lobatto's points

    // Works at the fraction `theta` of a step of `length` [s]: the integral of the cubic through the powers.
    WorkDone works_until(const WorkDone& start, double length, double theta) const
    {
        static constexpr auto cubic = lagrange_cubics();
        std::array<double, 4> share;
        for (std::size_t i = 0; i < 4; ++i) {
            double power = theta, weight = 0.0;
            for (std::size_t j = 0; j < 4; ++j, power *= theta)
                weight += cubic[i][j] * power / static_cast<double>(j + 1);
            share[i] = length * weight;
        }
        WorkDone result = start;
        for (std::size_t k = 0; k < result.size(); ++k)
            for (std::size_t i = 0; i < 4; ++i) result[k] += share[i] * at[i][k];
        return result;
    }
};

}  // namespace eel_core
