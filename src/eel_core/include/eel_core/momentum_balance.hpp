// SPDX-License-Identifier: Apache-2.0
// Motion of the head: eq. (27), in the momentum form of the balance (60). It needs no acceleration. The head's
// acceleration, which the internal wrench needs, is found in accelerations.hpp.
//
// The balance is the time derivative of the total momentum P' = P + m_o V1 E1, L about the head. With that momentum as
// the state, neither accelerations nor Kddot are needed to march:
//
//     twist = I_o^-1 (momentum - momentum of the change of shape)
//     rate of P' = F - m_o (Omega x V)_1 E1 + m_o V1 (Omega x E1)
//     rate of L  = T - V x (P' - m_o V1 E1)
//
// in components along the head's present axes, of vectors of the world; (T, F): wake, drag, weight and wrenches from
// outside.
#pragma once

#include "eel_core/loads/tail_and_nose.hpp"
#include "eel_core/momentum.hpp"

namespace eel_core {

// [position 0:3 m; orientation 3:7, quaternion x y z w; angular 7:10 and linear 10:13 momentum], all in the world's
// axes, momentum about the head. Angles of fins' servos 13:16 [rad], or padding of the lanes.
inline constexpr std::size_t state_size = 13, most_servos = state_space - state_size;
using State = std::array<double, state_space>;

// Axes of the head in the world, from the quaternion of the state, which need not have unit length.
inline Frame3<double> head_frame(const State& y, Space)
{
    const double scale = 1.0 / std::sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6]);
    return Quaternion<double>{scale * y[3], scale * y[4], scale * y[5], scale * y[6]}.frame();
}
inline Frame2<double> head_frame(const State& y, Plane)
{
    const double z = y[5], w = y[6], square = z * z + w * w;
    return {(w * w - z * z) / square, 2.0 * z * w / square};
}

// Momentum of the state in the axes of the head.
inline Momentum<Space, double> momentum_in_head(const State& y, const Frame3<double>& head)
{
    return {head.local(Vector3{y[7], y[8], y[9]}), head.local(Vector3{y[10], y[11], y[12]})};
}
inline Momentum<Plane, double> momentum_in_head(const State& y, const Frame2<double>& head)
{
    return {y[9], head.local(Vector2{y[10], y[11]})};
}

// Stores a momentum, or its rate, given in the axes of the head, in the state, or its rate.
inline void put_momentum(const Momentum<Space, double>& momentum, const Frame3<double>& head, State& y)
{
    const auto angular = head.parent(momentum.angular), linear = head.parent(momentum.linear);
    y[7] = angular.x, y[8] = angular.y, y[9] = angular.z, y[10] = linear.x, y[11] = linear.y, y[12] = linear.z;
}
inline void put_momentum(const Momentum<Plane, double>& momentum, const Frame2<double>& head, State& y)
{
    const auto linear = head.parent(momentum.linear);
    y[7] = y[8] = y[12] = 0.0, y[9] = momentum.angular, y[10] = linear.x, y[11] = linear.y;
}

// Stores the rates of position and orientation for the head's twist. current: [m/s], of the water, in the world's axes.
inline void put_velocity(const Twist<Space, double>& twist, const Frame3<double>& head, const Vector3<double>& current,
                         const State& y, State& rate)
{
    const auto velocity = head.parent(twist.linear) + current;
    const Vector3<double> half = 0.5 * twist.angular;
    const double x = y[3], v = y[4], z = y[5], w = y[6];
    rate[0] = velocity.x, rate[1] = velocity.y, rate[2] = velocity.z;
    rate[3] = w * half.x + v * half.z - z * half.y;
    rate[4] = w * half.y + z * half.x - x * half.z;
    rate[5] = w * half.z + x * half.y - v * half.x;
    rate[6] = -x * half.x - v * half.y - z * half.z;
}
inline void put_velocity(const Twist<Plane, double>& twist, const Frame2<double>& head, const Vector3<double>& current,
                         const State& y, State& rate)
{
    const auto velocity = head.parent(twist.linear);
    rate[0] = velocity.x + current.x, rate[1] = velocity.y + current.y, rate[2] = current.z;
    rate[3] = rate[4] = 0.0, rate[5] = 0.5 * y[6] * twist.angular, rate[6] = -0.5 * y[5] * twist.angular;
}

// Rate of the momentum as a world vector, in the axes of the head, from the loads.
template <class M>
EEL_CORE_INLINE inline Momentum<M, double> momentum_rate_from_loads(const Swimmer& swimmer, const Workspace<M>& work)
{
    const Twist<M, double>& twist = work.twist;
    Wrench<M, double> rate = work.tail + work.drag;
    rate.linear += nose_turning_force(swimmer, twist);
    rate.linear.x += nose_drag(swimmer, work.nose_through_water().x);
    if (work.flowing) rate += work.flow_load;
    Vector<M, double> impulse = work.momentum.linear;
    impulse.x -= swimmer.nose_mass * twist.linear.x;
    rate.angular = rate.angular - cross(twist.linear, impulse);
    if (swimmer.weighs()) rate += work.weight;
    if constexpr (!M::planar)
        if (!work.fins.empty()) rate += work.fin_load;
    if (!work.appendages.empty()) rate += work.appendage_load;
    if (work.has_external) rate += work.external_load;
    return rate;
}

}  // namespace eel_core
