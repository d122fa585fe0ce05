// SPDX-License-Identifier: Apache-2.0
// The internal wrench, eq. (50), from the balance of the part of the body behind each section; and the actuators'
// power.
#pragma once

#include "eel_core/accelerations.hpp"

namespace eel_core {

using Powers = std::array<double, 6>;  // [W], of actuators, wake, nose, drag, flow and fins

// Integral of the density from the nose to the nodes.
template <class M>
void integrate_balance(const Swimmer& swimmer, Workspace<M>& work)
{
    swimmer.grid.from_nose.integrate(work.density, work.integral);
    add_kinks(swimmer, swimmer.grid.from_nose, false, work, work.integral);
}

// The wrench on the part of the body behind a section, w_tail - integral from X to the tail of the density, about the
// section and in its axes; from the integral `integral` X.
template <class M>
Wrench<M, Lanes> wrench_behind(const Workspace<M>& work, const Wrench<M, Lanes>& integral, const Frame<M, Lanes>& frame,
                               const Vector<M, Lanes>& position)
{
    const auto at_head = integral + (work.tail - work.balance);
    return {frame.local(at_head.angular - cross(position, at_head.linear)), frame.local(at_head.linear)};
}

// THE INTERNAL WRENCH, eq. (50), (51), at a block of sections: the wrench behind each, less the momentum of the water
// that is swept past it. v, omega: velocity of the sections through the water and
// Omega, in their axes.
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

// Bending torque times the rate of bending, of a block.
inline Lanes bending_power(const Vector3<Lanes>& torque, const Vector2<Lanes>& rate)
{
    return torque.y * rate.x + torque.z * rate.y;
}
inline Lanes bending_power(Lanes torque, const Vector2<Lanes>& rate) { return torque * rate.y; }

// - integral of C . Kdot over the body [W]. The water that is swept past a section has no part in C2 and C3.
template <class M>
double actuator_power(const Swimmer& swimmer, const Workspace<M>& work)
{
    Lanes power(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto wrench = wrench_behind<M>(work, work.integral[k], work.frame[k], work.position[k]);
        power -= swimmer.grid.weight[k] * bending_power(wrench.angular, work.curvature_rate[k]);
    }
    return total(power);
}

// What that power lacks for the fins: behind each, their wrench is no longer among those of the part behind. A fin's
// node ends a panel, so that its own value is the one ahead of the fin.
inline double actuator_power_of_fins(const Swimmer& swimmer, const Workspace<Space>& work)
{
    Lanes power(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Wrench<Space, Lanes> ahead = fins_ahead(swimmer, work, k, &Fin::node_behind);
        const Vector3<Lanes> torque = work.frame[k].local(ahead.angular - cross(work.position[k], ahead.linear));
        power += swimmer.grid.weight[k] * bending_power(torque, work.curvature_rate[k]);
    }
    return total(power);
}

}  // namespace eel_core
