// SPDX-License-Identifier: Apache-2.0
// Wrenches from outside in the balance: of each a point wrench (T; F) on the section at its X, given over time. Ours,
// not the paper's.
//
//     about the head      (T + r x F; F)
//     power               T . Omega + F . V, of the true velocities
//     of a coordinate     T . omega_m + F . v_m, by its column (bending/columns.hpp)
//
// The internal wrench jumps by it: what lies behind the section does not bear it.
#pragma once

#include "eel_core/loads/moving_water.hpp"
#include "eel_core/loads/point_wrenches.hpp"

namespace eel_core {

inline Wrench<Space, double> in_motion(const Wrench<Space, double>& wrench, Space) { return wrench; }
inline Wrench<Plane, double> in_motion(const Wrench<Space, double>& wrench, Plane)
{
    return {wrench.angular.z, {wrench.linear.x, wrench.linear.y}};
}

template <class M>
Wrench<M, double> about_head(const ExternalLoad<M>& load)
{
    return {load.wrench.angular + cross(load.position, load.wrench.linear), load.wrench.linear};
}

// Those that come with the law, at `time` [s] on the configured body, and their sum about the head.
template <class M>
EEL_CORE_APART void find_external_loads(const LawOnGrid& law, double time, Workspace<M>& work)
{
    work.external.resize(law.wrenches.size()), work.external_load = {};
    for (std::size_t i = 0; i < law.wrenches.size(); ++i) {
        const ExternalWrench& own = law.wrenches[i];
        ExternalLoad<M>& now = work.external[i];
        const Wrench<M, double> given = in_motion(own.at(time), M());
        const bool at_nose = own.node == Appendage::nose;
        now.node = own.node, now.station_behind = own.station_behind;
        now.position = at_nose ? Vector<M, double>{} : work.position.node(own.node);
        if (own.in_world) {
            now.wrench = {work.head.local(given.angular), work.head.local(given.linear)};
        } else if (at_nose) {  // the head's axes are those of the section
            now.wrench = given;
        } else {
            const Frame<M, double> frame = work.frame.node(own.node);
            now.wrench = {frame.parent(given.angular), frame.parent(given.linear)};
        }
        work.external_load += about_head(now);
    }
}

// Their power [W].
template <class M>
EEL_CORE_APART double external_power(const Workspace<M>& work)
{
    double sum = 0.0;
    for (const ExternalLoad<M>& now : work.external) {
        const bool at_nose = now.node == Appendage::nose;
        sum += dot(at_nose ? work.twist.angular : work.omega.node(now.node), now.wrench.angular) +
               dot(at_nose ? work.twist.linear : work.velocity.node(now.node), now.wrench.linear);
    }
    return sum;
}

// What the change of shape does against them [W].
template <class M>
EEL_CORE_APART double shape_power_of_external(const Workspace<M>& work)
{
    double sum = 0.0;
    for (const ExternalLoad<M>& now : work.external)
        if (now.node != Appendage::nose)
            sum += dot(work.shape_omega.node(now.node), now.wrench.angular) +
                   dot(work.shape_velocity.node(now.node), now.wrench.linear);
    return sum;
}

// The wrench about the head of those that lie ahead of the stations of a block, or at them.
EEL_CORE_APART inline Wrench<Space, Lanes> external_ahead(const Workspace<Space>& work, std::size_t block)
{
    return sum_ahead(
        work.external.size(), block, [&](std::size_t i) { return work.external[i].station_behind; },
        [&](std::size_t i) { return about_head(work.external[i]); });
}

}  // namespace eel_core
