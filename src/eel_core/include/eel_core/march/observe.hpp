// SPDX-License-Identifier: Apache-2.0
// What an instant shows: pose, velocities, energies, profiles along the body at the stations, and what moves sensors.
//
// The fields go on from the nodes to the stations by the integrals that made them, so a profile is as exact as the run.
// What is in the axes of the world or of the head is turned into those of the outside (axes.hpp).
#pragma once

#include "eel_core/algorithm.hpp"
#include "eel_core/march/axes.hpp"
#include "eel_core/march/missed.hpp"
#include "eel_core/march/profiles.hpp"

namespace eel_core {

// Work space at the stations.
struct StationWork {
    explicit StationWork(const Swimmer& swimmer) : missed(swimmer)
    {
        const std::size_t n = blocks_of(swimmer.stations);
        frame = Field<Frame3<double>>(n), curvature = Field<Vector2<double>>(n), base = Field<Quaternion<double>>(n);
        turn = Field<Quaternion<double>>(swimmer.sensors() > 0 ? n : 0);
        position = omega = velocity = relative = Field<Vector3<double>>(n);
        angular_acceleration = linear_acceleration = Field<Vector3<double>>(n);
        integral = Field<Wrench<Space, double>>(n);
        resistance = {Field<Wrench<Space, double>>(swimmer.grid.blocks), integral};
        for (std::size_t i = 0; i < swimmer.stations; ++i) base.row(3)[i] = 1.0;
    }

    Field<Frame3<double>> frame;
    Field<Quaternion<double>> base;  // of the node before
    Field<Quaternion<double>> turn;  // of the station, where there are sensors
    Field<Vector2<double>> curvature;
    Field<Vector3<double>> position, omega, velocity, angular_acceleration, linear_acceleration;
    FlowValues<Space> flow;                 // where the water moves by itself
    Field<Vector3<double>> relative;        // velocity through that water
    Field<Wrench<Space, double>> integral;  // integral of the balance's density from the nose
    UnsignedResistance resistance;
    MissedWrench missed;  // of the integral, where the sections are from data
};

// Puts components of a block of stations, of which there are `stations`, into rows (stations, Components of the value).
template <class Block>
void put(const Block& value, std::size_t block, std::size_t stations, double* rows)
{
    constexpr std::size_t count = Components<Block>::count;
    const std::size_t first = width * block, lanes = first < stations ? std::min(width, stations - first) : 0;
    Components<Block>::each(value, [&](std::size_t c, Lanes component) {
        for (std::size_t lane = 0; lane < lanes; ++lane) rows[count * (first + lane) + c] = component[lane];
    });
}

// Kinetic energy of the body, and of the water without the nose's, from true velocities; potential energy [J].
inline std::array<double, 3> energies_of(const Swimmer& swimmer, const Workspace<Space>& work)
{
    Lanes body(0.0), water(0.0);
    const auto& through_water = work.velocity_through_water();
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Section<Lanes> section = swimmer.sections[k];
        const Frame3<Lanes> frame = work.frame[k];
        const Vector3<Lanes> v = frame.local(work.velocity[k]), omega = frame.local(work.omega[k]);
        body += swimmer.grid.weight[k] * section.body_energy(v, omega);
        if (swimmer.offset)
            body += swimmer.grid.weight[k] * dot(v, cross(omega, Vector3<Lanes>{0.0, 0.0, -swimmer.sections.lever[k]}));
        const Vector3<Lanes> w = frame.local(through_water[k]);
        water += swimmer.grid.weight[k] * section.water_energy(w, omega);
    }
    const double of_flow = work.flowing ? energy_of_flow(swimmer, work) : 0.0;
    return {total(body), total(water) + of_flow, potential_energy(swimmer, work)};
}

inline void put(const Vector3<double>& v, double* to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }
inline void put(const Spatial<Space, double>& s, double* to) { put(s.angular, to), put(s.linear, to + 3); }

class Observer {
  public:
    // Fills the `sample` of `whole`, as `profiles` has it.
    Observer(const Swimmer& swimmer, const Profiles& profiles, double* whole, std::size_t sample)
        : swimmer_(swimmer), profiles_(profiles), whole_(whole), sample_(sample)
    {
    }

    // With what state y at `time` [s] shows. False where the inertia is not positive definite.
    bool observe(const LawOnGrid& law, const Water& water, double time, const State& y, Workspace<Space>& work,
                 StationWork& here) const
    {
        if (!find_motion(swimmer_, law, water, time, y, work)) return false;
        const Powers powers = find_powers(swimmer_, law, work);
        find_accelerations(swimmer_, work);
        std::copy(powers.begin(), powers.end(), at(Profiles::powers));
        show_head(y, water.current, work);
        show_energies_and_closure(work);
        if (profiles_.fins > 0) show_fins(work);
        place_stations(law, y, work, here);
        const bool all = profiles_.wrench || profiles_.load, sensed = profiles_.sensors > 0;
        if (all || sensed) {
            const std::size_t begin = all ? 0 : first_sensor_block() / FromNose::parts;
            find_velocities(begin, work, here);
            if (work.flowing) find_flow(water, time, y, work, here);
        }
        if (profiles_.wrench) show_internal_wrench(work, here);
        if (profiles_.load || sensed)
            find_accelerations_there(profiles_.load ? 0 : first_sensor_block() / FromNose::parts, law, work, here);
        if (profiles_.load) work.flowing ? show_loads<true>(work, here) : show_loads<false>(work, here);
        if (sensed) show_sensors(y, water.current, work, here);
        return true;
    }

  private:
    double* at(Profiles::Quantity quantity) const { return profiles_.at(whole_, quantity, sample_); }
    std::size_t blocks() const { return blocks_of(swimmer_.stations); }
    std::size_t first_sensor_block() const { return swimmer_.first_sensor() / width; }

    void show_head(const State& y, const Vector3<double>& current, const Workspace<Space>& work) const
    {
        const State shown = half_turn(y);
        std::copy_n(shown.begin(), 3, at(Profiles::position));
        std::copy_n(shown.begin() + 3, 4, at(Profiles::orientation));
        put(half_turn(Twist<Space, double>{work.twist.angular, work.twist.linear + work.head.local(current)}),
            at(Profiles::twist));
        put(half_turn(work.head_acceleration), at(Profiles::head_acceleration));

        Vector3<Lanes> moment{};
        Lanes mass(0.0);
        for (std::size_t k = 0; k < swimmer_.grid.blocks; ++k) {
            const Lanes part = swimmer_.grid.weight[k] * swimmer_.sections[k].mass;
            mass += part, moment += part * work.position[k];
            if (swimmer_.offset)
                moment += mass_moment(swimmer_.grid.weight[k] * swimmer_.sections.lever[k], work.frame[k].axis3);
        }
        const Vector3<double> centre = work.head.parent((1.0 / total(mass)) * total_of(moment));
        put(half_turn(Vector3{y[0], y[1], y[2]} + centre), at(Profiles::center_of_mass));
    }

    void show_energies_and_closure(const Workspace<Space>& work) const
    {
        const auto energies = energies_of(swimmer_, work);
        std::copy(energies.begin(), energies.end(), at(Profiles::energies));

        const auto left = plus_axial<Space>(work.tail - work.balance, work.nose_force);
        double* const closure = at(Profiles::closure);
        closure[0] = std::sqrt(dot(left.angular, left.angular)), closure[1] = std::sqrt(dot(left.linear, left.linear));
    }

    void show_fins(const Workspace<Space>& work) const
    {
        for (std::size_t i = 0; i < swimmer_.fins.size(); ++i) {
            at(Profiles::fin_angle)[i] = work.fins[i].angle;
            put(work.frame.node(swimmer_.fins[i].node).local(work.fins[i].whole), at(Profiles::fin_force) + 3 * i);
        }
    }

    // Backbone, orientation and curvature.
    void place_stations(const LawOnGrid& law, const State& y, const Workspace<Space>& work, StationWork& here) const
    {
        const Quaternion<Lanes> head_turn{y[3], y[4], y[5], y[6]};
        const Vector3<double> nose{y[0], y[1], y[2]};
        swimmer_.to_station.integrate(work.frame, 0, Vector3<double>{}, work.position, here.position);
        for (std::size_t i = 0; i < swimmer_.stations; ++i)
            if (const std::size_t nodes = swimmer_.nodes_before[i]; nodes > 0)
                Components<Quaternion<double>>::each(work.orientation.node(nodes - 1),
                                                     [&](std::size_t c, double value) { here.base.row(c)[i] = value; });
        for (std::size_t k = 0; k < blocks(); ++k) {
            const Vector2<Lanes> curvature = law.combine_both(law.tables->station, work.factor, 0, k);
            const Vector2<Lanes> rate = law.combine_both(law.tables->station, work.factor, 1, k);
            const Quaternion<Lanes> turn = here.base[k] * law.turn(law.tables->station_moments, work.factor, k);
            here.frame.store(k, turn.frame());
            if (profiles_.sensors > 0) here.turn.store(k, turn);
            here.curvature.store(k, curvature);
            show(Profiles::backbone, k, half_turn(nose + work.head.parent(here.position[k])));
            show(Profiles::section_orientation, k, half_turn(head_turn * turn));
            show(Profiles::curvature, k, Vector3<Lanes>{0.0, curvature.x, curvature.y});
            show(Profiles::curvature_rate, k, Vector3<Lanes>{0.0, rate.x, rate.y});
        }
    }

    // True velocities at the stations, relative to the water.
    // From the stretch `begin` of the stations on.
    void find_velocities(std::size_t begin, Workspace<Space>& work, StationWork& here) const
    {
        for (std::size_t k = 0; k < swimmer_.grid.blocks; ++k) {
            const Frame3<Lanes> frame = work.frame[k];
            work.integrand.store(k, {turning(frame, work.curvature_rate[k]), cross(work.omega[k], frame.t1())});
        }
        swimmer_.to_station.integrate(work.integrand, 0, work.twist.angular, work.omega, here.omega, begin);
        swimmer_.to_station.integrate(work.integrand, 3, work.twist.linear, work.velocity, here.velocity, begin);
    }

    EEL_CORE_APART void find_flow(const Water& water, double time, const State& y, const Workspace<Space>& work,
                                  StationWork& here) const
    {
        const Vector3<double> nose{y[0], y[1], y[2]};
        here.flow.set(water, time, nose, work.head, here.position, swimmer_.stations);
        for (std::size_t k = 0; k < blocks(); ++k) here.relative.store(k, here.velocity[k] - here.flow[k].u);
    }

    static const Field<Vector3<double>>& through_water(const Workspace<Space>& work, const StationWork& here)
    {
        return work.flowing ? here.relative : here.velocity;
    }

    void find_accelerations_there(std::size_t begin, const LawOnGrid& law, Workspace<Space>& work,
                                  StationWork& here) const
    {
        for (std::size_t k = 0; k < swimmer_.grid.blocks; ++k)
            work.integrand.store(k, {angular_acceleration_slope(law, work, k),
                                     linear_acceleration_slope(work, work.acceleration.angular, k)});
        const Twist<Space, double>& head = work.head_acceleration;
        swimmer_.to_station.integrate(work.integrand, 0, head.angular, work.acceleration.angular,
                                      here.angular_acceleration, begin);
        swimmer_.to_station.integrate(work.integrand, 3, head.linear, work.acceleration.linear,
                                      here.linear_acceleration, begin);
    }

    // In axes of the sections, turned as the head's.
    EEL_CORE_APART void show_sensors(const State& y, const Vector3<double>& current, const Workspace<Space>& work,
                                     const StationWork& here) const
    {
        const Quaternion<Lanes> head_turn{y[3], y[4], y[5], y[6]};
        const Vector3<double> nose{y[0], y[1], y[2]}, drift = work.head.local(current);
        for (std::size_t k = first_sensor_block(); k < blocks(); ++k) {
            const Frame3<Lanes> frame = here.frame[k];
            const auto show_two = [&](Profiles::Quantity quantity, Vector3<Lanes> angular, Vector3<Lanes> linear) {
                sense(quantity, k,
                      Spatial<Space, Lanes>{half_turn(frame.local(angular)), half_turn(frame.local(linear))});
            };
            const Vector3<Lanes> water = (work.flowing ? here.flow[k].u : Vector3<Lanes>{}) + drift;
            sense(Profiles::sensor_position, k, half_turn(nose + work.head.parent(here.position[k])));
            sense(Profiles::sensor_orientation, k, half_turn(head_turn * here.turn[k]));
            show_two(Profiles::sensor_twist, here.omega[k], here.velocity[k] + drift);
            show_two(Profiles::sensor_acceleration, here.angular_acceleration[k], here.linear_acceleration[k]);
            sense(Profiles::sensor_water, k, half_turn(frame.local(water)));
        }
    }
    void sense(Profiles::Quantity quantity, std::size_t block, const auto& value) const
    {
        put(value, block - first_sensor_block(), profiles_.sensors, at(quantity));
    }

    void show_internal_wrench(Workspace<Space>& work, StationWork& here) const
    {
        find_internal_wrench(swimmer_, work, here.resistance, here.integral);
        if (!swimmer_.missed.empty())
            here.missed.add(swimmer_, work, here.frame, here.omega, through_water(work, here), here.flow,
                            here.integral);
        for (std::size_t k = 0; k < blocks(); ++k) {
            const Frame3<Lanes> frame = here.frame[k];
            Wrench<Space, Lanes> integral = here.integral[k];
            if (!work.fins.empty())  // those ahead of a station, and at it, are no part of what lies behind
                integral = integral - fins_ahead(swimmer_, work, k, &Fin::station_behind);
            if (!work.appendages.empty()) integral = integral - appendages_ahead(swimmer_, work, k);
            if (work.has_external) integral = integral - external_ahead(work, k);
            const auto wrench =
                internal_wrench<Space>(swimmer_, work, integral, frame, here.position[k], swimmer_.at_station[k],
                                       frame.local(through_water(work, here)[k]), frame.local(here.omega[k]));
            show(Profiles::torque, k, wrench.angular);
            show(Profiles::force, k, wrench.linear);
        }
    }

    // Makes the velocity, its rate and slope, and Omega1 of a block of stations those through the water.
    static void move_with_flow(std::size_t k, const StationWork& here, const Vector3<Lanes>& omega,
                               const Vector3<Lanes>& curvature, Vector3<Lanes>& v, Vector3<Lanes>& v_rate,
                               Vector3<Lanes>& v_slope, Lanes& turning)
    {
        const FlowSample<Space, Lanes> water = here.flow[k];
        const Frame3<Lanes> frame = here.frame[k];
        const Vector3<Lanes> u = frame.local(water.u);
        v_rate = v_rate + cross(omega, u) - frame.local(water.u_t + water.g.times(here.velocity[k]));
        v = v - u;
        v_slope = v_slope + cross(curvature, u) - frame.local(water.g.times(frame.axis1));
        turning -= 0.5 * water.g.curl_along(frame.axis1);
    }

    // The water's force per length: the rate at which a strip's water gives up momentum p = M_f V, of which V1 p is
    // swept past the section, - (d/dt + Omega x) p + (d/dX + K x) V1 p; and the drag.
    template <bool Flowing>
    void show_loads(const Workspace<Space>& work, const StationWork& here) const
    {
        for (std::size_t k = 0; k < blocks(); ++k) {
            const Section<Lanes> section = swimmer_.at_station[k];
            const Frame3<Lanes> frame = here.frame[k];
            Vector3<Lanes> v = frame.local(here.velocity[k]);
            const Vector3<Lanes> omega = frame.local(here.omega[k]), e1{1.0, 0.0, 0.0};
            Vector3<Lanes> v_rate = frame.local(here.linear_acceleration[k]) - cross(omega, v);
            const Vector2<Lanes> bending = here.curvature[k];
            const Vector3<Lanes> curvature{0.0, bending.x, bending.y};
            Vector3<Lanes> v_slope = cross(omega, e1) - cross(curvature, v);  // V'
            Lanes turning = omega.x;
            if constexpr (Flowing) move_with_flow(k, here, omega, curvature, v, v_rate, v_slope, turning);
            const Section<Lanes> slope{0.0, swimmer_.added2_slope[k],    swimmer_.added3_slope[k], 0.0, 0.0,
                                       0.0, swimmer_.added_roll_slope[k]};
            const Vector3<Lanes> p = section.water_momentum(v);
            const Vector3<Lanes> p_slope = slope.water_momentum(v) + section.water_momentum(v_slope);
            Vector3<Lanes> force = -(section.water_momentum(v_rate) + cross(omega, p));
            if (swimmer_.inertia_of_water == 0.0) force = {};
            if constexpr (Flowing)
                force += frame.local(force_of_flow<Space>(swimmer_, swimmer_.at_station.displaced[k], here.flow[k],
                                                          frame.parent(swimmer_.inertia_of_water * p)));
            if (swimmer_.wake > 0.0)
                force += Lanes(swimmer_.wake) * (v_slope.x * p + v.x * (p_slope + cross(curvature, p)));
            if (swimmer_.distributed_pressure && swimmer_.wake > 0.0) {  // - d/dX (T_f t1)
                const Lanes roll_slope = -cross(curvature, omega).x;     // of Omega1
                const Lanes energy_slope =
                    slope.water_energy(v, omega) + dot(p, v_slope) + section.added_roll * omega.x * roll_slope;
                force += -energy_slope * e1 - section.water_energy(v, omega) * cross(curvature, e1);
            }
            Vector3<Lanes> resistive{};
            if (swimmer_.resistive) {
                const DragSection<Lanes> drag = swimmer_.at_station.drag(k);
                const AxialFriction friction = axial_drag(swimmer_, drag, v);
                const auto sign = local_signs<Space>(friction.turbulent_share, v, turning);
                resistive = resistive_load(drag, friction.laminar, friction.excess, sign, v, turning).linear;
            }
            show(Profiles::resistive_force, k, resistive);
            show(Profiles::fluid_force, k, force + resistive);
        }
        const auto tail = work.frame.node(swimmer_.grid.nodes - 1);
        at(Profiles::tail_force)[0] = swimmer_.distributed_pressure ? 0.0 : -work.tail_energy;
        for (std::size_t i = 0; i < swimmer_.appendages.size(); ++i)
            if (swimmer_.appendages[i].of_body) at(Profiles::tail_force)[0] += tail.local(work.appendages[i].force).x;
        at(Profiles::nose_force)[0] = work.nose_force;
        put(-tail.local(work.tail.linear), at(Profiles::wake_momentum_rate));
    }

    void show(Profiles::Quantity quantity, std::size_t block, const auto& value) const
    {
        put(value, block, swimmer_.shown, at(quantity));
    }

    const Swimmer& swimmer_;
    const Profiles& profiles_;
    double* whole_;
    std::size_t sample_;
};

}  // namespace eel_core
