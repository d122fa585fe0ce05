// SPDX-License-Identifier: Apache-2.0
// Bodies that weigh: gravity, buoyancy, and a centre of mass off the axis. Ours, not the paper's.
//
// A section's centre of mass lies at e = -h E3 from its centre, where its buoyancy acts. With `lever` m h and `net`
// rho_f A - m, per length and about the section's centre:
//
//     loads      force net g up, torque - m g e x up             potential energy g (lever (1 - t3 . up) - net z)
//     momentum   p_b = m V + Omega x m e,  sigma_b = J Omega + m e x V            J: about the centre, m h^2 included
//     balance    f_N += m (Omegadot x e + Omega x (Omega x e))   f_C += m e x (Vdot + Omega x V)
//
// The loads stand here; what m e adds to the momentum in momentum.hpp, to the balance in accelerations.hpp. Without
// `offset` it adds nothing: the mass stays on the backbone. That is the approximation by a metacentric height. In the
// plane z = 0 the sections stand upright, and nothing of this acts.
#pragma once

#include "eel_core/model/workspace.hpp"

namespace eel_core {

// The torque per length for a `moment` m g h [N], in the axes in which axis 3 of the section and `up` are given.
template <Number T>
Vector3<T> righting_torque(T moment, const Vector3<T>& axis3, const Vector3<double>& up)
{
    return moment * cross(axis3, up);
}

// m e per length, or of a stretch, in the axes in which axis 3 of the section is given; from m h.
template <Number T>
Vector3<T> mass_moment(T lever, const Vector3<T>& axis3)
{
    return -lever * axis3;
}

// Buoyancy less weight of sections at `position` about the head, from their `net` rho_f A - m.
inline Wrench<Space, Lanes> net_weight(const Swimmer& swimmer, const Vector3<double>& up,
                                       const Vector3<Lanes>& position, Lanes net)
{
    const Vector3<Lanes> force = swimmer.gravity * net * up;
    return {cross(position, force), force};
}

// Sets `up` and `weight` from the head's axes, and the `height` of the nose [m] over the level of no potential energy.
inline void set_weight(const Swimmer& swimmer, double height, Workspace<Space>& work)
{
    work.up = work.head.local(Vector3{0.0, 0.0, 1.0}), work.height = height;
    Vector3<Lanes> torque{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Lanes moment = swimmer.righting * (swimmer.grid.weight[k] * swimmer.sections.lever[k]);
        torque += righting_torque(moment, work.frame[k].axis3, work.up);
    }
    work.weight = {total_of(torque), {}};
    if (swimmer.gravity == 0.0) return;
    Wrench<Space, Lanes> sum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k)
        sum += swimmer.grid.weight[k] * net_weight(swimmer, work.up, work.position[k], swimmer.sections.net[k]);
    work.weight += total_of(sum);
}
inline void set_weight(const Swimmer&, double, Workspace<Plane>&) {}

// Takes the weight out of the `density` of the balance and its integral, as any load.
inline void take_weight(const Swimmer& swimmer, Workspace<Space>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Lanes moment = swimmer.righting * swimmer.sections.lever[k];
        Wrench<Space, Lanes> density = work.density[k];
        density.angular = density.angular - righting_torque(moment, work.frame[k].axis3, work.up);
        if (swimmer.gravity != 0.0)
            density = density - net_weight(swimmer, work.up, work.position[k], swimmer.sections.net[k]);
        work.density.store(k, density);
    }
    work.balance = work.balance - work.weight;
}
inline void take_weight(const Swimmer&, Workspace<Plane>&) {}

// Potential energy of weight and buoyancy [J] of a body whose weight is set: 0 where every section stands upright and
// the net weight lies at no height. (t3 - up)^2 / 2 is 1 - t3 . up without cancellation.
inline double potential_energy(const Swimmer& swimmer, const Workspace<Space>& work)
{
    if (!swimmer.weighs()) return 0.0;
    Lanes sum(0.0), raised(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Vector3<Lanes> lean = work.frame[k].axis3 - work.up;
        sum += swimmer.grid.weight[k] * swimmer.sections.lever[k] * dot(lean, lean);
        raised += swimmer.grid.weight[k] * swimmer.sections.net[k] * (work.height + dot(work.up, work.position[k]));
    }
    return 0.5 * swimmer.righting * total(sum) - swimmer.gravity * total(raised);
}

}  // namespace eel_core
