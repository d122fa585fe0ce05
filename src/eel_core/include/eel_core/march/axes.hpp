// SPDX-License-Identifier: Apache-2.0
// Converts axes at the boundary of the core, both ways. The core works in the paper's: at rest the body lies along +x
// from the head, and swims towards -x. Callers of the core give and get world and head in REP-103 axes: x
// forward, y left, z up.
//
// A half turn about axis 3, of world and head alike, takes each into the other. Section axes stay the paper's.
#pragma once

#include "eel_core/momentum_balance.hpp"

namespace eel_core {

// 0 - x, so that what is 0 stays so, without a sign.
template <Number T>
Vector3<T> half_turn(const Vector3<T>& v)
{
    return {0.0 - v.x, 0.0 - v.y, v.z};
}
template <Number T>
Quaternion<T> half_turn(const Quaternion<T>& q)
{
    return {0.0 - q.x, 0.0 - q.y, q.z, q.w};
}
inline Spatial<Space, double> half_turn(const Spatial<Space, double>& s)
{
    return {half_turn(s.angular), half_turn(s.linear)};
}
// Of a state, or of a head's motion: position, orientation, and two vectors.
template <std::size_t N>
std::array<double, N> half_turn(std::array<double, N> y)
{
    for (const std::size_t turned : {0u, 1u, 3u, 4u, 7u, 8u, 10u, 11u}) y[turned] = 0.0 - y[turned];
    return y;
}

}  // namespace eel_core
