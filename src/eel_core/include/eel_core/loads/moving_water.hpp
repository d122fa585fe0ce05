// SPDX-License-Identifier: Apache-2.0
// Moving water: what a flow u(x, t) adds to momentum, loads, balance and energy. Ours, not the paper's.
//
//     W = V - U,  p = M_f W,  T_f = 1/2 (J_f1 Omega1^2 + W . p)      U: u in section axes
//
// Drag, wake and nose use W instead of V; the roll drag uses Omega1 - 1/2 t1 . curl u. Two forces per length are new: -
// g^T p, and rho_f A a_u of the undisturbed pressure (Froude and Krylov); a_u = u_t + g u is the acceleration of the
// water. The theory assumes an irrotational u that varies little across a section. Without `flow_gradient` g is left
// out of these two forces along the body.
#pragma once

#include "eel_core/loads/drag.hpp"

namespace eel_core {

// Not inlined: in still water the compiled code is the same as without this file, to the last bit.
#define EEL_CORE_APART [[gnu::noinline]]

// The flow along the body, in the shape and place that `work` and state y hold at `time` [s].
template <class M>
EEL_CORE_APART void set_flow(const Swimmer& swimmer, const Water& water, double time, const Vector3<double>& nose,
                             Workspace<M>& work)
{
    work.flowing = water.flow != nullptr;
    if (work.flowing) work.flow.set(water, time, nose, work.head, work.position, swimmer.grid.nodes);
}

// integral (r x q, q), q = M_f U: missing in the momentum of body and water, which is computed from the motion through
// the water.
template <class M>
EEL_CORE_APART Momentum<M, double> momentum_of_flow(const Swimmer& swimmer, const Workspace<M>& work)
{
    Momentum<M, Lanes> sum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto section = swimmer.sections[k].weighed(swimmer.grid.weight[k]);
        const auto frame = work.frame[k];
        const Vector<M, Lanes> linear = frame.parent(section.water_momentum(frame.local(work.flow[k].u)));
        sum += {cross(work.position[k], linear), linear};
    }
    return total_of(sum);
}

// rho_f A g u - g^T p of a block: the part of the force per length due to the flow's gradient, about the head.
template <class M>
Wrench<M, Lanes> load_of_gradient(const Section<Lanes>& section, Lanes displaced, const Workspace<M>& work,
                                  std::size_t k)
{
    const auto frame = work.frame[k];
    const FlowSample<M, Lanes> water = work.flow[k];
    const Vector<M, Lanes> w = work.velocity[k] - water.u, p = frame.parent(section.water_momentum(frame.local(w)));
    const Vector<M, Lanes> force = displaced * water.g.times(water.u) - water.g.transposed_times(p);
    return {cross(work.position[k], force), force};
}

// Its integral over the body, and its power [W].
template <class M>
EEL_CORE_APART std::pair<Wrench<M, double>, double> total_of_gradient(const Swimmer& swimmer, const Workspace<M>& work)
{
    Wrench<M, Lanes> sum{};
    Lanes power(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto load = load_of_gradient<M>(swimmer.sections[k], swimmer.sections.displaced[k], work, k);
        sum += swimmer.grid.weight[k] * load;
        power += swimmer.grid.weight[k] * dot(load.linear, work.velocity[k]);
    }
    return {total_of(sum), total(power)};
}

// rho_f A a_u - g^T p of a block, in the axes of the head: without `flow_gradient` rho_f A u_t.
template <class M>
EEL_CORE_INLINE inline Vector<M, Lanes> force_of_flow(const Swimmer& swimmer, Lanes displaced,
                                                      const FlowSample<M, Lanes>& water, const Vector<M, Lanes>& p)
{
    if (!swimmer.flow_gradient) return displaced * water.u_t;
    return displaced * water.acceleration() - water.g.transposed_times(p);
}

// The flow's part of the load on the momentum of a block, about the sections and weighed by their length: that force,
// and the torque U x p.
template <class M>
EEL_CORE_INLINE inline Wrench<M, Lanes> load_of_flow(const Swimmer& swimmer, const Workspace<M>& work, std::size_t k)
{
    const auto section = swimmer.sections[k].weighed(swimmer.grid.weight[k]);
    const Lanes displaced = swimmer.grid.weight[k] * swimmer.sections.displaced[k];
    const auto frame = work.frame[k];
    const FlowSample<M, Lanes> water = work.flow[k];
    const Vector<M, Lanes> p = frame.parent(section.water_momentum(frame.local(work.relative[k])));
    return {cross(water.u, p), force_of_flow<M>(swimmer, displaced, water, p)};
}

// Velocities through the water, and the flow's part of the load on the momentum; m_o a_u at the nose.
template <class M>
EEL_CORE_APART void set_flow_load(const Swimmer& swimmer, Workspace<M>& work)
{
    if (work.relative.stride() == 0) work.relative = Field<Vector<M, double>>(swimmer.grid.blocks);
    Wrench<M, Lanes> sum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        work.relative.store(k, work.velocity[k] - work.flow[k].u);
        const Wrench<M, Lanes> load = load_of_flow(swimmer, work, k);
        sum += {cross(work.position[k], load.linear) + load.angular, load.linear};
    }
    work.flow_load = plus_axial<M>(total_of(sum), swimmer.nose_mass * work.flow.nose().acceleration().x);
}

// The wrench about the head that the flow adds to the balance, beside that of a motion through water at rest, of a
// block. In section axes:
//
//     f_N += M_f (Omega x U - R^T u_b) - Omega x M_f U + R^T (g^T p - rho_f A a_u)      f_C += W x p - V x M_f V
//
// u_b = u_t + g v: rate of u as the section meets it.
template <class M>
Wrench<M, Lanes> wrench_of_flow(const Section<Lanes>& section, Lanes displaced, const Workspace<M>& work, std::size_t k)
{
    const auto frame = work.frame[k];
    const FlowSample<M, Lanes> water = work.flow[k];
    const Angular<M, Lanes> omega = frame.local(work.omega[k]);
    const Vector<M, Lanes> velocity = work.velocity[k];
    const Vector<M, Lanes> u = frame.local(water.u), v = frame.local(velocity), w = frame.local(velocity - water.u);
    const Vector<M, Lanes> p = section.water_momentum(w);
    const Vector<M, Lanes> met = frame.local(water.u_t + water.g.times(velocity));
    const Vector<M, Lanes> shared =
        water.g.transposed_times(Vector<M, Lanes>(frame.parent(p))) - displaced * water.acceleration();
    const Vector<M, Lanes> rate = cross(omega, u) - met;
    return about_head<M>(
        frame, work.position[k],
        Wrench<M, Lanes>{cross(w, p) - cross(v, section.water_momentum(v)),
                         section.water_momentum(rate) - cross(omega, section.water_momentum(u)) + frame.local(shared)});
}

// Adds it to the `density` of the balance. Returns its integral over the body.
template <class M>
EEL_CORE_APART Wrench<M, double> add_wrench_of_flow(const Swimmer& swimmer, Workspace<M>& work)
{
    Wrench<M, Lanes> sum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto wrench = wrench_of_flow<M>(swimmer.sections[k], swimmer.sections.displaced[k], work, k);
        work.density.store(k, work.density[k] + wrench);
        sum += swimmer.grid.weight[k] * wrench;
    }
    const Wrench<M, double> whole = total_of(sum);
    if (swimmer.flow_gradient) return whole;
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k)
        work.density.store(
            k, work.density[k] + load_of_gradient<M>(swimmer.sections[k], swimmer.sections.displaced[k], work, k));
    return whole + total_of_gradient(swimmer, work).first;
}

// integral (p . u_t + rho_f A a_u . v) [W].
template <class M>
EEL_CORE_APART double flow_power(const Swimmer& swimmer, const Workspace<M>& work)
{
    Lanes sum(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto frame = work.frame[k];
        const FlowSample<M, Lanes> water = work.flow[k];
        const Vector<M, Lanes> w = work.relative[k], velocity = work.velocity[k];
        const Lanes part = dot(swimmer.sections[k].water_momentum(Vector<M, Lanes>(frame.local(w))),
                               Vector<M, Lanes>(frame.local(water.u_t)));
        sum += swimmer.grid.weight[k] * (part + swimmer.sections.displaced[k] * dot(water.acceleration(), velocity));
    }
    return swimmer.flow_gradient ? total(sum) : total(sum) - total_of_gradient(swimmer, work).second;
}

// What the drag's power lacks where it is that of the motion through the water [W]: integral n . U + c1 t1 . curl u
// / 2.
template <class M>
EEL_CORE_APART double drag_power_of_flow(const Swimmer& swimmer, const Workspace<M>& work)
{
    Lanes sum(0.0);
    for (std::size_t k = 0; swimmer.resistive && k < swimmer.grid.blocks; ++k) {
        const auto frame = work.frame[k];
        const FlowSample<M, Lanes> water = work.flow[k];
        const auto load = weighed_load(swimmer, work, k);
        sum += dot(load.linear, Vector<M, Lanes>(frame.local(water.u))) +
               roll_torque(load) * (0.5 * water.g.curl_along(frame.t1()));
    }
    return total(sum);
}

// integral p . U [J]: what the energy of the water has besides T_f.
EEL_CORE_APART inline double energy_of_flow(const Swimmer& swimmer, const Workspace<Space>& work)
{
    Lanes sum(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto frame = work.frame[k];
        const Vector3<Lanes> u = frame.local(work.flow[k].u), w = frame.local(work.relative[k]);
        sum += swimmer.grid.weight[k] * dot(swimmer.sections[k].water_momentum(w), u);
    }
    return total(sum);
}

}  // namespace eel_core
