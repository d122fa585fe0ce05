// SPDX-License-Identifier: Apache-2.0
// Accelerations of the head and of the sections, from the balance of the whole body, eq. (60).
//
//     alpha' = R Kddot + omega x R Kdot        acc' = alpha x t1 + omega x (omega x t1)
//
// Both are linear in the head's acceleration, which follows from zero total wrench on the whole body. Observations and
// the ledger need them; a march uses the head's momentum, not its acceleration (momentum.hpp). For robots see
// `find_accelerations_and_drift` in bending/balance.hpp.
#pragma once

#include "eel_core/loads/drag_kinks.hpp"
#include "eel_core/loads/tail_and_nose.hpp"
#include "eel_core/loads/weight.hpp"
#include "eel_core/momentum.hpp"

namespace eel_core {

// alpha', the slope of the angular acceleration along X, of the sections of a block.
inline Vector3<Lanes> angular_acceleration_slope(const LawOnGrid& law, const Workspace<Space>& work, std::size_t k)
{
    const auto frame = work.frame[k];
    return turning(frame, law.combine_both(law.tables->node, work.factor, 2, k)) +
           cross(work.omega[k], turning(frame, work.curvature_rate[k]));
}
// acc', the slope of the linear acceleration, from the angular one.
template <class M>
EEL_CORE_INLINE inline Vector<M, Lanes> linear_acceleration_slope(const Workspace<M>& work,
                                                                  const Field<Angular<M, double>>& angular,
                                                                  std::size_t k)
{
    const auto t1 = work.frame[k].t1();
    const auto omega = work.omega[k];
    return cross(angular[k], t1) + cross(omega, cross(omega, t1));
}

// Angular accelerations without acceleration of the head.
inline void set_turning_acceleration(const Swimmer& swimmer, const LawOnGrid& law, Workspace<Space>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k)
        work.integrand.store(k, {angular_acceleration_slope(law, work, k), Vector3<Lanes>{}});
    swimmer.grid.from_nose.integrate(work.integrand, work.shape_acceleration.angular);
}
inline void set_turning_acceleration(const Swimmer& swimmer, const LawOnGrid& law, Workspace<Plane>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        work.shape_acceleration.angular.store(k, law.combine(law.tables->angle, LawOnGrid::yaw, work.factor, 2, k)[0]);
        work.curvature_rate.store(k, {0.0, law.combine(law.tables->node, LawOnGrid::yaw, work.factor, 1, k)[0]});
    }
}

// The wrench, about the head, needed for the motion of a block's nodes. In section axes:
//
//     f_N = M Vdot + Omega x M V      f_C = J Omegadot + Omega x J Omega + V x M V
template <class M>
EEL_CORE_INLINE inline Wrench<M, Lanes> inertial_wrench(const Section<Lanes>& section, const Workspace<M>& work,
                                                        const Accelerations<M>& acceleration, std::size_t k)
{
    const auto frame = work.frame[k];
    const Angular<M, Lanes> omega = frame.local(work.omega[k]), omega_rate = frame.local(acceleration.angular[k]);
    const Vector<M, Lanes> v = frame.local(work.velocity[k]);
    const Vector<M, Lanes> v_rate = frame.local(acceleration.linear[k]) - cross(omega, v);
    const Vector<M, Lanes> momentum = section.linear_momentum(v);
    const Wrench<M, Lanes> taken{
        section.angular_momentum(omega_rate) + cross(omega, section.angular_momentum(omega)) + cross(v, momentum),
        section.linear_momentum(v_rate) + cross(omega, momentum)};
    return about_head<M>(frame, work.position[k], taken);
}

// The part of the moment m e of sections, m h = `lever`: m (Omegadot x e + Omega x (Omega x e)), and the torque
// m e x (Vdot + Omega x V).
inline Wrench<Space, Lanes> wrench_of_offset(Lanes lever, const Workspace<Space>& work,
                                             const Accelerations<Space>& acceleration, std::size_t k)
{
    const Vector3<Lanes> moment = mass_moment(lever, work.frame[k].axis3), omega = work.omega[k];
    const Vector3<Lanes> force = cross(acceleration.angular[k], moment) + cross(omega, cross(omega, moment));
    return {cross(work.position[k], force) + cross(moment, acceleration.linear[k]), force};
}

// Adds that part to the `density` of the balance. Returns its integral over the body.
EEL_CORE_APART inline Wrench<Space, double> add_offset(const Swimmer& swimmer, const Accelerations<Space>& acceleration,
                                                       Workspace<Space>& work)
{
    Wrench<Space, Lanes> sum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto density = wrench_of_offset(swimmer.sections.lever[k], work, acceleration, k);
        work.density.store(k, work.density[k] + density);
        sum += swimmer.grid.weight[k] * density;
    }
    return total_of(sum);
}

// Writes to `density` the wrench per length needed for the motion. Returns its integral over the body.
template <class M>
Wrench<M, double> set_inertial_density(const Swimmer& swimmer, const Accelerations<M>& acceleration, Workspace<M>& work)
{
    Wrench<M, Lanes> sum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto density = inertial_wrench<M>(swimmer.sections[k], work, acceleration, k);
        work.density.store(k, density);
        sum += swimmer.grid.weight[k] * density;
    }
    const auto taken = total_of(sum);
    if constexpr (!M::planar)
        if (swimmer.offset) return taken + add_offset(swimmer, acceleration, work);
    return taken;
}

// Adds the resistance, minus the drag, with the signs at the nodes minus their jumps at the kinks ahead. This is as
// smooth as the motion. `add_jumps` restores the jumps.
template <class M>
void add_resistance(const Swimmer& swimmer, Workspace<M>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto v = speeds_from(work, width * k);
        const Lanes turning = roll_from(work, width * k);
        auto sign = local_signs<M>(work.turbulent_share[k], v, turning);
        for (std::size_t j = 0; j < work.kink_count; ++j)
            sign.of(work.kinks[j].speed) -= jump_behind(work.kinks[j], swimmer.grid.from_nose.place()[k]);
        const auto load = resistive_load(swimmer.sections.drag(k), work.friction_laminar[k], work.friction_excess[k],
                                         sign, v, turning);
        work.density.store(k, work.density[k] - about_head<M>(work.frame[k], work.position[k], load));
    }
}

// Accelerations of the sections without acceleration of the head.
template <class M>
void find_shape_accelerations(const Swimmer& swimmer, const LawOnGrid& law, Workspace<M>& work)
{
    set_turning_acceleration(swimmer, law, work);
    Accelerations<M>& own = work.shape_acceleration;
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k)
        work.integrand.store(k, {own.angular[k], linear_acceleration_slope(work, own.angular, k)});
    swimmer.grid.from_nose.integrate(work.integrand, own.linear, Components<Angular<M, Lanes>>::count);
}

// Force of the water on the nose [N] without its added mass times the acceleration.
template <class M>
double water_on_nose(const Swimmer& swimmer, const Workspace<M>& work)
{
    const double drag = nose_drag(swimmer, work.nose_through_water().x);
    return work.flowing ? drag + swimmer.nose_mass * work.flow.nose().acceleration().x : drag;
}

// The load that accelerates the head in eq. (60), computed with zero acceleration of the head. on_nose: [N], force of
// the water. Sets the accelerations of the shape, and the `density` of the balance for them.
template <class M>
EEL_CORE_INLINE inline Wrench<M, double> accelerating_load(const Swimmer& swimmer, const LawOnGrid& law, double on_nose,
                                                           Workspace<M>& work)
{
    find_shape_accelerations(swimmer, law, work);
    auto left = work.tail + work.drag - set_inertial_density(swimmer, work.shape_acceleration, work);
    left.linear.x += on_nose;
    if (work.flowing) left = left - add_wrench_of_flow(swimmer, work);
    if (swimmer.weighs()) left += work.weight;
    if constexpr (!M::planar)
        if (!work.fins.empty()) left += wrench_of_fins(swimmer, work.shape_acceleration, work);
    if (!work.appendages.empty()) left += work.appendage_load;
    if (work.has_external) left += work.external_load;
    return left;
}

// Acceleration of the head: eq. (60) in accelerations. `work` holds the true velocities, their loads and the factored
// inertia. The density of the balance and the forces of the fins are still those without the head's acceleration.
template <class M>
EEL_CORE_APART void find_head_acceleration(const Swimmer& swimmer, const LawOnGrid& law, Workspace<M>& work)
{
    const double on_nose = water_on_nose(swimmer, work);
    auto head = components_of(accelerating_load(swimmer, law, on_nose, work));
    work.factored.solve(head);
    work.head_acceleration = Components<Twist<M, double>>::make([&](std::size_t k) { return head[k]; });
    work.nose_force = on_nose - swimmer.nose_mass * work.head_acceleration.linear.x;
}

// After that, the accelerations of the sections, and the density of the balance with all loads.
template <class M>
void find_accelerations(const Swimmer& swimmer, Workspace<M>& work)
{
    add_head_motion(swimmer, work.head_acceleration, work.position, work.shape_acceleration.angular,
                    work.shape_acceleration.linear, work.acceleration.angular, work.acceleration.linear);
    work.balance = set_inertial_density(swimmer, work.acceleration, work) - work.drag;
    if (swimmer.resistive) add_resistance(swimmer, work);
    if (work.flowing) work.balance += add_wrench_of_flow(swimmer, work);
    if (swimmer.weighs()) take_weight(swimmer, work);
    if constexpr (!M::planar)
        if (!work.fins.empty()) work.balance = work.balance - wrench_of_fins(swimmer, work.acceleration, work);
    if (!work.appendages.empty()) work.balance = work.balance - work.appendage_load;
    if (work.has_external) work.balance = work.balance - work.external_load;
}

}  // namespace eel_core
