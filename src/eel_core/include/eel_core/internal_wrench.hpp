// SPDX-License-Identifier: Apache-2.0
// The internal wrench, eq. (50), from the balance of the part of the body behind each section; and the actuators' power
// for the change of shape.
#pragma once

#include "eel_core/accelerations.hpp"
#include "eel_core/loads/appendages.hpp"
#include "eel_core/loads/external_wrenches.hpp"

namespace eel_core {

// [W], of actuators, wake, nose, drag, flow, fins, appendages and wrenches from outside
using Powers = std::array<double, 8>;

// The wrench on the part of the body behind a section, w_tail - integral from X to the tail of the density, about the
// section and in its axes; computed from the `integral` from the nose to X.
template <class M>
Wrench<M, Lanes> wrench_behind(const Workspace<M>& work, const Wrench<M, Lanes>& integral, const Frame<M, Lanes>& frame,
                               const Vector<M, Lanes>& position)
{
    const auto at_head = integral + (work.tail - work.balance);
    return {frame.local(at_head.angular - cross(position, at_head.linear)), frame.local(at_head.linear)};
}

// THE INTERNAL WRENCH, eq. (50), (51), at a block of sections: the wrench behind each, minus the momentum of the water
// swept past it. v, omega: velocity of the sections through the water and Omega, in their axes.
template <class M>
Wrench<M, Lanes> internal_wrench(const Swimmer& swimmer, const Workspace<M>& work, const Wrench<M, Lanes>& integral,
                                 const Frame<M, Lanes>& frame, const Vector<M, Lanes>& position,
                                 const Section<Lanes>& section, const Vector<M, Lanes>& v,
                                 const Angular<M, Lanes>& omega)
{
    const Section<Lanes> swept = section.weighed(swimmer.wake);
    const auto wrench = wrench_behind<M>(work, integral, frame, position) - momentum_flux<M, Lanes>(swept, v, omega);
    return swimmer.distributed_pressure ? plus_axial<M, Lanes>(wrench, swept.water_energy(v, omega)) : wrench;
}

// Drag and weight on a block of sections, about them and weighted by their length, in the axes of the head.
template <class M>
EEL_CORE_INLINE inline Wrench<M, Lanes> loads_on_sections(const Swimmer& swimmer, const Workspace<M>& work,
                                                          std::size_t k)
{
    Wrench<M, Lanes> load{};
    const auto frame = work.frame[k];
    if (swimmer.resistive) {
        const auto drag = weighed_load(swimmer, work, k);
        load = {frame.parent(drag.angular), frame.parent(drag.linear)};
    }
    if constexpr (!M::planar)
        if (swimmer.weighs()) {
            const Lanes weight = swimmer.grid.weight[k];
            load.angular +=
                righting_torque(swimmer.righting * (weight * swimmer.sections.lever[k]), frame.axis3, work.up);
            load.linear += swimmer.gravity * (weight * swimmer.sections.net[k]) * work.up;
        }
    return load;
}

// The power [W] needed for the change of shape without acceleration of the head, after `find_head_acceleration`:
//
//     - integral C . Kdot = integral (omega_s . c + v_s . n) - omega_s(l) . C_t - v_s(l) . N_t
//
// by parts, since omega_s' = R Kdot and v_s' = omega_s x t1 of the change of shape. (c, n): wrench needed for a
// section's motion, minus its loads. An acceleration a of the head adds a . (momentum of the change of shape).
template <class M>
double power_of_shape(const Swimmer& swimmer, const Workspace<M>& work)
{
    Lanes sum(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        Wrench<M, Lanes> taken = work.density[k];
        taken.angular = taken.angular - cross(work.position[k], taken.linear);
        taken = swimmer.grid.weight[k] * taken - loads_on_sections(swimmer, work, k);
        sum += dot(work.shape_omega[k], taken.angular) + dot(work.shape_velocity[k], taken.linear);
    }
    const std::size_t tail = swimmer.grid.nodes - 1;
    const Angular<M, double> torque = work.tail.angular - cross(work.position.node(tail), work.tail.linear);
    double power =
        total(sum) - dot(work.shape_omega.node(tail), torque) - dot(work.shape_velocity.node(tail), work.tail.linear);
    if constexpr (!M::planar)
        for (std::size_t i = 0; i < swimmer.fins.size(); ++i) {
            const FinMotion& fin = work.fins[i];
            const std::size_t node = swimmer.fins[i].node;
            power -= dot(work.shape_omega.node(node), cross(fin.arm, fin.whole)) +
                     dot(work.shape_velocity.node(node), fin.whole);
        }
    if (!work.appendages.empty()) power -= shape_power_of_appendages(swimmer, work);
    if (work.has_external) power -= shape_power_of_external(work);
    return power;
}

}  // namespace eel_core
