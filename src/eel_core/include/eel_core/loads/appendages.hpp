// SPDX-License-Identifier: Apache-2.0
// Drag of appendages and of a blunt tail's base, each a point wrench on the section at its X. Ours, not the paper's.
//
//     w = W(X) + Omega x r,  r = (0, y, z)        section axes; W: velocity through the water
//     law "axis":   F_i = - drag_i |w_i| w_i      bars across the flow: each component by itself
//     law "speed":  F_i = - drag_i |w| w_i        blunt blocks
//     M = r x F
//
// drag_i = 1/2 rho_f C_D A_i. The base of a blunt tail is one at X = l with drag_1 = 1/2 rho_f c_b A(l).
#pragma once

#include "eel_core/loads/moving_water.hpp"
#include "eel_core/loads/point_wrenches.hpp"

namespace eel_core {

inline Vector3<double> in_motion(const Vector3<double>& v, Space) { return v; }
inline Vector2<double> in_motion(const Vector3<double>& v, Plane) { return {v.x, v.y}; }

// The force for the velocity w through the water, both in section axes.
inline Vector3<double> appendage_force(const Appendage& own, const Vector3<double>& w)
{
    if (own.by_speed) {
        const double speed = std::sqrt(dot(w, w));
        return {-own.drag.x * speed * w.x, -own.drag.y * speed * w.y, -own.drag.z * speed * w.z};
    }
    return {-own.drag.x * std::abs(w.x) * w.x, -own.drag.y * std::abs(w.y) * w.y, -own.drag.z * std::abs(w.z) * w.z};
}
inline Vector2<double> appendage_force(const Appendage& own, const Vector2<double>& w)
{
    const auto force = appendage_force(own, Vector3<double>{w.x, w.y, 0.0});
    return {force.x, force.y};
}

// Forces of the appendages from the true velocities, and their sum `appendage_load`.
template <class M>
EEL_CORE_APART void find_appendage_loads(const Swimmer& swimmer, Workspace<M>& work)
{
    work.appendage_load = {};
    const auto& through_water = work.velocity_through_water();
    for (std::size_t i = 0; i < swimmer.appendages.size(); ++i) {
        const Appendage& own = swimmer.appendages[i];
        AppendageMotion<M>& now = work.appendages[i];
        const Vector<M, double> arm = in_motion(own.arm, M());
        Vector<M, double> w;
        if (own.node == Appendage::nose) {  // the section has the head's axes
            const Vector<M, double> lever = cross(work.twist.angular, arm);
            now.arm = now.position = arm;
            now.velocity = work.twist.linear + lever, w = work.nose_through_water() + lever;
            now.force = appendage_force(own, w);
        } else {
            const Frame<M, double> frame = work.frame.node(own.node);
            now.arm = frame.parent(arm), now.position = work.position.node(own.node) + now.arm;
            const Vector<M, double> lever = cross(work.omega.node(own.node), now.arm);
            now.velocity = work.velocity.node(own.node) + lever, w = through_water.node(own.node) + lever;
            now.force = frame.parent(appendage_force(own, Vector<M, double>(frame.local(w))));
        }
        work.appendage_load += force_at<M>(now.position, now.force);
    }
}

// Power [W] of the change of shape against the appendages' drag.
template <class M>
EEL_CORE_APART double shape_power_of_appendages(const Swimmer& swimmer, const Workspace<M>& work)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < swimmer.appendages.size(); ++i) {
        const std::size_t node = swimmer.appendages[i].node;
        if (node == Appendage::nose) continue;
        const AppendageMotion<M>& now = work.appendages[i];
        sum += dot(work.shape_omega.node(node), cross(now.arm, now.force)) +
               dot(work.shape_velocity.node(node), now.force);
    }
    return sum;
}

// Powers [W] of the appendages, and of the base of the tail.
template <class M>
EEL_CORE_APART std::array<double, 2> appendage_powers(const Swimmer& swimmer, const Workspace<M>& work)
{
    std::array<double, 2> sum{};
    for (std::size_t i = 0; i < swimmer.appendages.size(); ++i)
        sum[swimmer.appendages[i].of_body ? 1 : 0] += dot(work.appendages[i].force, work.appendages[i].velocity);
    return sum;
}

// The wrench about the head of the appendages ahead of the stations of a block, or at them.
EEL_CORE_APART inline Wrench<Space, Lanes> appendages_ahead(const Swimmer& swimmer, const Workspace<Space>& work,
                                                            std::size_t block)
{
    return sum_ahead(
        swimmer.appendages.size(), block, [&](std::size_t i) { return swimmer.appendages[i].station_behind; },
        [&](std::size_t i) { return force_at<Space>(work.appendages[i].position, work.appendages[i].force); });
}

}  // namespace eel_core
