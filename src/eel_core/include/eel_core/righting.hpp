// SPDX-License-Identifier: Apache-2.0
// The righting moment: each section's weight acts a height h below its buoyancy, along its own axis 3. Ours, not the
// paper's. Weight and buoyancy are equal, so that they are a torque alone; per length
//
//     torque m g h (t3 x up)      potential energy m g h (1 - t3 . up)
//
// The mass stays on the backbone: h is not part of the inertia. In the plane z = 0 the sections stand upright, and
// there is no torque.
#pragma once

#include "eel_core/model/workspace.hpp"

namespace eel_core {

// The torque per length for a `moment` m g h [N], in the axes in which axis 3 of the section and `up` are given.
template <Number T>
Vector3<T> righting_torque(T moment, const Vector3<T>& axis3, const Vector3<double>& up)
{
    return moment * cross(axis3, up);
}

// `up` and `righting` from `head`.
inline void set_righting_torque(const Swimmer& swimmer, Workspace<Space>& work)
{
    work.up = work.head.local(Vector3{0.0, 0.0, 1.0});
    Vector3<Lanes> torque{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Lanes moment = swimmer.righting * (swimmer.grid.weight[k] * swimmer.sections.mass[k]);
        torque += righting_torque(moment, work.frame[k].axis3, work.up);
    }
    work.righting = total_of(torque);
}
inline void set_righting_torque(const Swimmer&, Workspace<Plane>&) {}

// Takes the torque out of the `density` of the balance and its integral, as any load.
inline void take_righting_torque(const Swimmer& swimmer, Workspace<Space>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Lanes moment = swimmer.righting * swimmer.sections.mass[k];
        Wrench<Space, Lanes> density = work.density[k];
        density.angular = density.angular - righting_torque(moment, work.frame[k].axis3, work.up);
        work.density.store(k, density);
    }
    work.balance.angular = work.balance.angular - work.righting;
}
inline void take_righting_torque(const Swimmer&, Workspace<Plane>&) {}

// Potential energy of weight and buoyancy [J], 0 where every section stands upright; of a body whose `up` is set.
// (t3 - up)^2 / 2 is 1 - t3 . up without cancellation.
inline double potential_energy(const Swimmer& swimmer, const Workspace<Space>& work)
{
    if (swimmer.righting == 0.0) return 0.0;
    Lanes sum(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Vector3<Lanes> lean = work.frame[k].axis3 - work.up;
        sum += swimmer.grid.weight[k] * swimmer.sections.mass[k] * dot(lean, lean);
    }
    return 0.5 * swimmer.righting * total(sum);
}

}  // namespace eel_core
