// SPDX-License-Identifier: Apache-2.0
// Configuration of the body and velocities due to its change of shape: eq. (25), the first loop of section 7.1.
//
//     R' = R hat(K)      omega' = R Kdot      r' = t1      v' = omega x t1
//
// in the axes of the head, about the head: R = 1, r = omega = v = 0 at the nose.
#pragma once

#include "eel_core/model/workspace.hpp"

namespace eel_core {

// R (0, K2, K3): the rotation of sections by their bending, in the axes of the head.
template <Number T>
Vector3<T> turning(const Frame3<T>& frame, const Vector2<T>& bending)
{
    return bending.x * frame.axis2 + bending.y * frame.axis3;
}

// Rotations over the intervals that end at the nodes. They are separate from their product, in which each block waits
// for the previous one.
inline void turn_intervals(const Swimmer& swimmer, const LawOnGrid& law, Workspace<Space>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k)
        work.turn.store(k, law.turn(law.tables->moments, work.factor, k));
}

// Axes of the sections and, in space, their angular velocities.
inline void orient_sections(const Swimmer& swimmer, const LawOnGrid& law, Workspace<Space>& work)
{
    turn_intervals(swimmer, law, work);
    Quaternion<Lanes> before{0.0, 0.0, 0.0, 1.0};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Quaternion<Lanes> q = before * successive_products(work.turn[k]);
        before = {last(q.x), last(q.y), last(q.z), last(q.w)};
        const Frame3<Lanes> frame = q.frame();
        const Vector2<Lanes> rate = law.combine_both(law.tables->node, work.factor, 1, k);
        work.orientation.store(k, q);
        work.frame.store(k, frame);
        work.curvature_rate.store(k, rate);
        work.integrand.store(k, {turning(frame, rate), frame.t1()});
    }
    swimmer.grid.from_nose.integrate(work.integrand, work.shape_omega);
}

// In the plane the angle of a section is the integral of K3, which is tabulated with the law.
inline void orient_sections(const Swimmer& swimmer, const LawOnGrid& law, Workspace<Plane>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto [s, c] = sine_and_cosine(law.combine(law.tables->angle, LawOnGrid::yaw, work.factor, 0, k)[0]);
        work.frame.store(k, {c, s});
        work.shape_omega.store(k, law.combine(law.tables->angle, LawOnGrid::yaw, work.factor, 1, k)[0]);
    }
}

// Shape of the body and velocities due to its change; `set_velocities` adds the head's motion. Sets `factor`, which is
// valid until the next instant.
template <class M>
void configure(const Swimmer& swimmer, const LawOnGrid& law, double time, Workspace<M>& work)
{
    work.factor.resize(law.tables->rows());
    law.set_factors(time, work.factor);
    orient_sections(swimmer, law, work);
    swimmer.grid.from_nose.integrate(work.frame, work.position);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto t1 = work.frame[k].t1();
        work.integrand.store(k, {work.shape_omega[k], cross(work.shape_omega[k], t1)});
    }
    constexpr std::size_t linear = Components<Angular<M, Lanes>>::count;  // row of the linear part
    swimmer.grid.from_nose.integrate(work.integrand, work.shape_velocity, linear);
}

// Adds a motion of the head to fields along the body: a, and b + a x r.
template <class M>
void add_head_motion(const Swimmer& swimmer, const Spatial<M, double>& head, const auto& position,
                     const auto& shape_turning, const auto& shape_moving, auto& turning, auto& moving)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        turning.store(k, head.angular + shape_turning[k]);
        moving.store(k, head.linear + cross(head.angular, position[k]) + shape_moving[k]);
    }
}

// True velocities, from those due to the change of shape and the twist of the head, which is stored in `work.twist`.
template <class M>
void set_velocities(const Swimmer& swimmer, const Twist<M, double>& twist, Workspace<M>& work)
{
    work.twist = twist;
    add_head_motion(swimmer, twist, work.position, work.shape_omega, work.shape_velocity, work.omega, work.velocity);
}

}  // namespace eel_core
