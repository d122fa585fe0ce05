// SPDX-License-Identifier: Apache-2.0
// Cubics in time between knots [s], ascending; the value is held before the first knot and after the last.
#pragma once

#include <algorithm>
#include <vector>

#include "eel_core/algebra/motion.hpp"

namespace eel_core {

template <class Value>
struct Cubics {
    std::vector<double> knots{0.0, 1.0};
    std::vector<std::array<Value, 4>> pieces{{}};  // by powers of the time since the knot, from the constant on

    std::array<Value, 2> at(double time) const  // value and rate
    {
        const double within = std::clamp(time, knots.front(), knots.back());
        const auto behind = std::upper_bound(knots.begin() + 1, knots.end() - 1, within);
        const auto piece = static_cast<std::size_t>(behind - knots.begin()) - 1;
        const auto& c = pieces[piece];
        const double s = within - knots[piece];
        const Value rate = c[1] + s * (2.0 * c[2] + 3.0 * s * c[3]);
        return {c[0] + s * (c[1] + s * (c[2] + s * c[3])), within == time ? rate : Value{}};
    }
};

}  // namespace eel_core
