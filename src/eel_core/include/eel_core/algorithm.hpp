// SPDX-License-Identifier: Apache-2.0
// SECTION 7.1: the algorithm of one instant, from the shape and the head's state to their rates, and to the internal
// wrench.
#pragma once

#include "eel_core/internal_wrench.hpp"
#include "eel_core/momentum_balance.hpp"

namespace eel_core {

// Loads on the body from its true velocities: wake, eq. (60), appendages, and drag, section 7.2.1.
template <class M>
EEL_CORE_INLINE inline void find_loads(const Swimmer& swimmer, Workspace<M>& work)
{
    set_tail_load(swimmer, work);
    if (!work.appendages.empty()) find_appendage_loads(swimmer, work);
    work.drag = {}, work.drag_power = 0.0, work.kink_count = 0;
    if (!swimmer.resistive) return;
    set_speeds(swimmer, work);
    set_load_weights(swimmer, work);
    find_kinks(swimmer, work);
    integrate_resistive_load(swimmer, work);
}

// Height [m] of the nose above zero potential energy: z = 0, moving with the current, in whose frame powers are
// defined.
inline double height_in(const Water& water, double time, const State& y) { return y[2] - water.current.z * time; }

// Shape of the body and axes of the head in state y at `time` [s], with the flow of this `water` along it, and its
// fins.
template <class M>
void place_body(const Swimmer& swimmer, const LawOnGrid& law, const Water& water, double time, const State& y,
                Workspace<M>& work)
{
    configure(swimmer, law, time, work);  // eq. (25)
    work.head = head_frame(y, M());
    set_flow(swimmer, water, time, Vector3{y[0], y[1], y[2]}, work);
    if constexpr (!M::planar)
        if (!work.fins.empty()) place_fins(swimmer, law, water, time, y, work);
}

// The same, and the twist of the head. False if the inertia is not positive definite.
template <class M>
bool find_head_motion(const Swimmer& swimmer, const LawOnGrid& law, const Water& water, double time, const State& y,
                      Workspace<M>& work)
{
    place_body(swimmer, law, water, time, y, work);
    work.momentum = momentum_in_head(y, work.head);
    return find_twist(swimmer, work);  // section 6
}

// The same, and the velocities and loads along the body.
template <class M>
bool find_motion(const Swimmer& swimmer, const LawOnGrid& law, const Water& water, double time, const State& y,
                 Workspace<M>& work)
{
    if (!find_head_motion(swimmer, law, water, time, y, work)) return false;
    set_velocities(swimmer, work.twist, work);
    if (work.flowing) set_flow_load(swimmer, work);
    find_loads(swimmer, work);
    work.has_external = !law.wrenches.empty();
    if (work.has_external) find_external_loads(law, time, work);
    if (swimmer.weighs()) set_weight(swimmer, height_in(water, time, y), work);
    if constexpr (!M::planar)
        if (!work.fins.empty()) find_fin_loads(swimmer, law, time, y, work);
    return true;
}

// Rate of state y at `time` [s]: eq. (27).
template <class M>
bool rate_of_state(const Swimmer& swimmer, const LawOnGrid& law, const Water& water, double time, const State& y,
                   Workspace<M>& work, State& rate)
{
    if (!find_motion(swimmer, law, water, time, y, work)) return false;
    put_velocity(work.twist, work.head, water.current, y, rate);
    put_momentum(momentum_rate_from_loads(swimmer, work), work.head, rate);
    for (std::size_t k = state_size; k < state_space; ++k) rate[k] = work.servo_rate[k];
    return true;
}

// Powers [W] of all except the actuators, after the acceleration of the head.
template <class M>
EEL_CORE_INLINE inline Powers powers_of_loads(const Swimmer& swimmer, const Workspace<M>& work)
{
    Powers powers{
        0.0, work.tail_speed * work.tail_energy, work.nose_force * work.twist.linear.x, work.drag_power, 0.0, 0.0, 0.0,
        0.0};
    if (work.flowing) {
        powers[1] += dot(work.tail.linear, work.flow.node(swimmer.grid.nodes - 1).u);
        powers[3] += drag_power_of_flow(swimmer, work);
        powers[4] = flow_power(swimmer, work);
    }
    if constexpr (!M::planar)
        if (!work.fins.empty()) powers[5] = fin_power(swimmer, work);
    if (!work.appendages.empty()) {
        const auto [own, of_base] = appendage_powers(swimmer, work);
        powers[3] += of_base, powers[6] = own;
    }
    if (work.has_external) powers[7] = external_power(work);
    return powers;
}

// Powers [W] of actuators, wake, nose, drag, flow, fins, appendages and wrenches from outside, in the motion held by
// `work`, with the acceleration of the head, eq. (60). Not inlined, so that every caller gets the same bits.
template <class M>
EEL_CORE_APART Powers find_powers(const Swimmer& swimmer, const LawOnGrid& law, Workspace<M>& work)
{
    find_head_acceleration(swimmer, law, work);
    double actuators = power_of_shape(swimmer, work);
    const auto head = components_of(work.head_acceleration), momentum = components_of(work.shape_momentum);
    for (std::size_t k = 0; k < head.size(); ++k) actuators += head[k] * momentum[k];
    if constexpr (!M::planar)
        if (!work.fins.empty()) accelerate_fins(swimmer, work.head_acceleration, work);
    Powers powers = powers_of_loads(swimmer, work);
    powers[0] = actuators;
    return powers;
}

// THE STEP OF THE INTERNAL WRENCH, after the accelerations: the `integral` of the balance's density from the nose to
// the stations. `internal_wrench` then gives eq. (50) there.
inline void find_internal_wrench(const Swimmer& swimmer, const Workspace<Space>& work, UnsignedResistance& resistance,
                                 Field<Wrench<Space, double>>& integral)
{
    swimmer.to_station.integrate(work.density, swimmer.grid.weight, integral);
    add_jumps(swimmer, work, resistance, integral);
}

}  // namespace eel_core
