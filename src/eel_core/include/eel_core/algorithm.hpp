// SPDX-License-Identifier: Apache-2.0
// SECTION 7.1: the algorithm of one instant, from the shape and the head's state to the rates of both, and to the
// internal wrench.
#pragma once

#include "eel_core/internal_wrench.hpp"
#include "eel_core/momentum_balance.hpp"

namespace eel_core {

// Loads on the body from its true velocities: wake, eq. (60), and drag, section 7.2.1.
template <class M>
void find_loads(const Swimmer& swimmer, Workspace<M>& work)
{
    set_tail_load(swimmer, work);
    work.drag = {}, work.drag_power = 0.0, work.kink_count = 0;
    if (!swimmer.resistive) return;
    set_speeds(swimmer, work);
    set_load_weights(swimmer, work);
    find_kinks(swimmer, work);
    integrate_resistive_load(swimmer, work);
}

// Height [m] of the nose over the level of no potential energy: z = 0, carried along by the current, in whose frame the
// powers are.
inline double height_in(const Water& water, double time, const State& y) { return y[2] - water.current.z * time; }

// Shape and twist of the head in state y at `time` [s], in such `water`. False where the inertia is not positive
// definite.
template <class M>
bool find_head_motion(const Swimmer& swimmer, const LawOnGrid& law, const Water& water, double time, const State& y,
                      Workspace<M>& work)
{
    configure(swimmer, law, time, work);  // eq. (25)
    work.head = head_frame(y, M());
    work.momentum = momentum_in_head(y, work.head);
    set_flow(swimmer, water, time, Vector3{y[0], y[1], y[2]}, work);
    if constexpr (!M::planar)
        if (!work.fins.empty()) place_fins(swimmer, law, water, time, y, work);
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

// What the internal wrench needs, in the motion that `work` holds: accelerations, eq. (60); then the balance's density
// integrated from the nose, from which `internal_wrench` gives eq. (50) at a section.
template <class M>
void find_internal_wrench(const Swimmer& swimmer, const LawOnGrid& law, Workspace<M>& work)
{
    find_accelerations(swimmer, law, work);
    integrate_balance(swimmer, work);
}

// Powers [W] of all but the actuators, after the accelerations.
template <class M>
Powers powers_of_loads(const Swimmer& swimmer, const Workspace<M>& work)
{
    Powers powers{0.0, work.tail_speed * work.tail_energy, work.nose_force * work.twist.linear.x, work.drag_power, 0.0,
                  0.0};
    if (work.flowing) {
        powers[1] += dot(work.tail.linear, work.flow.node(swimmer.grid.nodes - 1).u);
        powers[3] += drag_power_of_flow(swimmer, work);
        powers[4] = flow_power(swimmer, work);
    }
    if constexpr (!M::planar)
        if (!work.fins.empty()) powers[5] = fin_power(swimmer, work);
    return powers;
}

// Powers [W] of actuators, wake, nose, drag, flow and fins, in the motion that `work` holds.
template <class M>
Powers find_powers(const Swimmer& swimmer, const LawOnGrid& law, Workspace<M>& work)
{
    find_internal_wrench(swimmer, law, work);
    Powers powers = powers_of_loads(swimmer, work);
    powers[0] = actuator_power(swimmer, work);
    if constexpr (!M::planar)
        if (!work.fins.empty()) powers[0] += actuator_power_of_fins(swimmer, work);
    return powers;
}

}  // namespace eel_core
