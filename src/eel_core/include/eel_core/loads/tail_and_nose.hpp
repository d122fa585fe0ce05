// SPDX-License-Identifier: Apache-2.0
// Loads at the ends of the body: what the tail gives up to the wake, and the water on the nose; eq. (60).
#pragma once

#include "eel_core/loads/drag.hpp"

namespace eel_core {

// The water's momentum that is swept past a section, in its axes: (V1 J_f1 Omega1 E1; V1 M_f V).
template <class M, Number T>
Wrench<M, T> momentum_flux(const Section<T>& section, const Vector<M, T>& v, const Angular<M, T>& omega)
{
    return {v.x * section.water_roll(omega), v.x * section.water_momentum(v)};
}

// `tail`: the wake's wrench on the body about the head, from the true velocities; with V1 and T_f at the tail. In
// water that moves, all of them by the velocity through it.
template <class M>
void set_tail_load(const Swimmer& swimmer, Workspace<M>& work)
{
    const std::size_t tail = swimmer.grid.nodes - 1;
    const auto frame = work.frame.node(tail);
    const auto position = work.position.node(tail);
    const Section<double> section = swimmer.tail.weighed(swimmer.wake);
    const Vector<M, double> v = frame.local(work.velocity_through_water().node(tail));
    const Angular<M, double> omega = frame.local(work.omega.node(tail));
    work.tail_speed = swimmer.wake * v.x;
    work.tail_energy = section.water_energy(v, omega);
    work.tail =
        about_head<M>(frame, position, plus_axial<M>(momentum_flux<M, double>(section, v, omega), -work.tail_energy));
}

// Drag of the nose, along t1(0) [N].
inline double nose_drag(const Swimmer& swimmer, double v1) { return -swimmer.nose_drag * v1 * std::abs(v1); }

// What is left of the printed load of the nose [N] without two of its parts: the time derivative of the nose's momentum
// m_o V1 E1, and the nose's drag.
template <class M>
Vector<M, double> nose_turning_force(const Swimmer& swimmer, const Twist<M, double>& twist)
{
    Vector<M, double> along{};
    along.x = 1.0;
    auto force = swimmer.nose_mass * twist.linear.x * cross(twist.angular, along);
    force.x -= swimmer.nose_mass * cross(twist.angular, twist.linear).x;
    return force;
}

}  // namespace eel_core
