// SPDX-License-Identifier: Apache-2.0
// Forces at points of a section whose X is the end of a panel: of fins, of appendages, of a blunt tail's base. The
// internal wrench jumps there.
#pragma once

#include "eel_core/model/workspace.hpp"

namespace eel_core {

// A force at a `position`, about the head.
template <class M>
Wrench<M, double> force_at(const Vector<M, double>& position, const Vector<M, double>& force)
{
    return {cross(position, force), force};
}

// The sum of the wrenches (or momenta) of those of `count` that lie ahead of the points of a block, or at them.
// behind(i): the first of the points that lies behind number i. wrench(i): about the head.
Wrench<Space, Lanes> sum_ahead(std::size_t count, std::size_t block, const auto& behind, const auto& wrench)
{
    Wrench<Space, Lanes> sum{};
    const std::size_t start = width * block;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = behind(i);
        const Lanes here = select(Mask::below(first > start ? first - start : 0), 0.0, 1.0);
        const Wrench<Space, double> own = wrench(i);
        sum += {{here * own.angular.x, here * own.angular.y, here * own.angular.z},
                {here * own.linear.x, here * own.linear.y, here * own.linear.z}};
    }
    return sum;
}

}  // namespace eel_core
