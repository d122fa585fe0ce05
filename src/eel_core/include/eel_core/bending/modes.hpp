// SPDX-License-Identifier: Apache-2.0
// Dynamic bending: modes of the curvature, and their drives. Our own, not in the paper.
//
//     K(t, X) = K_imposed(t, X) + sum_m q_m(t) B_m(X)
//
// Each B_m lies along axis 2 (pitch) or 3 (yaw), on a support of whole panels. The coordinates are the q_m and, behind
// series springs, the angles of motors. The generalised force on a coordinate, in the sense of Lagrange, is
// K (x - rest) + D xdot + stops - drives.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "eel_core/steppers/present.hpp"

namespace eel_core {

// A motor that follows a reference: kp (ref - x) + kd (refdot - xdot), within its limits of torque and speed.
struct Servo {
    std::size_t coordinate;
    double kp, kd;                     // [N m/rad], [N m s/rad]
    double torque_limit, speed_limit;  // [N m], [rad/s]; infinite: none
};

// The stop of a mode beyond its limits: stiffness depth + damping depth d(depth)/dt, as in Hunt and Crossley (J. Appl.
// Mech. 42 (1975)). It starts from zero at contact, so that no force jumps, and it never pulls.
struct Stop {
    std::size_t mode;
    double low, high;  // [rad], or rad/m
    double stiffness;  // [N m/rad]
    double damping;    // [N m s/rad^2]

    double beyond(double x) const { return x > high ? x - high : x < low ? x - low : 0.0; }  // < 0 below the lower one
    // Force by `beyond`: the spring's and the damper's, >= 0.
    double hardness(double beyond, double rate) const
    {
        return std::max(0.0, stiffness + damping * std::copysign(1.0, beyond) * rate);
    }
};

// A torque given over time.
struct GivenTorque {
    std::size_t coordinate;
    std::function<double(double)> at;
};

struct Modes {
    std::size_t modes = 0, coordinates = 0;
    std::vector<LawOnGrid::Axis> axis;       // of each mode, like the next five
    std::vector<std::size_t> first, last;    // first node of the support, and the node after its last
    std::vector<bool> continuous;            // whether it is one of several on its support, not a joint
    std::vector<double> span, moment;        // integral of |B| [1, or m]; torque for a unit of force [1, or 1/m]
    std::vector<double> armature, rest;      // of each coordinate: armature or rotor, and rest position of its springs
    std::vector<double> stiffness, damping;  // (coordinates, coordinates)
    std::vector<Servo> servos;
    std::vector<Stop> stops;
    std::vector<GivenTorque> torques;
    // Muscles' forces on the coordinates: from the factors of a law of their own; empty: no muscles.
    std::shared_ptr<const LawOnGrid> drive;
    std::vector<double> push;  // (coordinates, rows of `drive`)
};

// A command to a servo, which replaces the law. A velocity moves the reference of the position. With position and
// velocity the torque is added; an effort is only the torque.
struct Command {
    enum Kind : std::uint8_t { law, position, velocity, effort };  // law: none
    Kind kind = law;
    double angle = 0.0, rate = 0.0, torque = 0.0;  // [rad], [rad/s], [N m], as a bend
    // [rad]: most that a velocity moves the reference.
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    double since = 0.0;  // [s]: time at which the reference is `angle`
};

// The target of a servo at an instant.
struct Target {
    Jet reference{};      // [rad]
    double torque = 0.0;  // [N m], added to its feedback, or replacing it
    bool by_torque = false;
};

// `MarchSettings` of a body with modes. The rows of the modes are the last ones of the law's tables.
struct BentSettings : MarchSettings {
    std::size_t first_mode = 0;     // row of the first mode
    std::vector<double> reference;  // (servos, first_mode): reference of a servo, from the factors of the law
    std::vector<Command> commands;  // (servos), or none
};

// Sets the modes' factors to their coordinates, rates, and these accelerations; none: zero.
inline void set_factors(const Modes& modes, const BentSettings& settings, const Present& now,
                        const double* acceleration, std::vector<Jet>& factor)
{
    factor.resize(settings.law.tables->rows());
    for (std::size_t m = 0; m < modes.modes; ++m)
        factor[settings.first_mode + m] = {now.x[m], now.rate[m], acceleration ? acceleration[m] : 0.0};
}

// Forces at an instant, and their data for the ledger.
struct Forces {
    std::vector<double> total;    // (coordinates) [N m, or N m^2], as defined above
    std::vector<double> torque;   // (servos) [N m]
    std::vector<double> pushing;  // (coordinates), of muscles and given torques: functions of time alone
    double elastic = 0.0;         // [J], in springs and stops
    double motor_power = 0.0;     // [W], of servos, muscles and given torques
    double damping_power = 0.0;   // [W], <= 0
};

// The target of a commanded servo at `time` [s].
inline Target target_of(const Command& command, double time)
{
    if (command.kind != Command::velocity)
        return {{command.angle, command.rate, 0.0}, command.torque, command.kind == Command::effort};
    const double moved = command.angle + command.rate * (time - command.since);
    const double within = std::clamp(moved, command.low, command.high);
    return {{within, within == moved ? command.rate : 0.0, 0.0}, command.torque};
}

// The targets of the servos at `time` [s].
inline void set_targets(const BentSettings& settings, const std::vector<Jet>& factor, double time,
                        std::vector<Target>& target)
{
    for (std::size_t s = 0; s < target.size(); ++s) {
        if (!settings.commands.empty() && settings.commands[s].kind != Command::law) {
            target[s] = target_of(settings.commands[s], time);
            continue;
        }
        target[s] = {};
        for (std::size_t row = 0; row < settings.first_mode; ++row)
            for (std::size_t d = 0; d < 3; ++d)
                target[s].reference[d] += settings.reference[s * settings.first_mode + row] * factor[row][d];
    }
}

// Forces of muscles and given torques on the coordinates at `time` [s]. factor: work space.
inline void set_pushing(const Modes& modes, double time, std::vector<Jet>& factor, std::vector<double>& pushing)
{
    std::fill(pushing.begin(), pushing.end(), 0.0);
    if (modes.drive) {
        factor.resize(modes.drive->tables->rows());
        modes.drive->set_factors(time, factor);
        for (std::size_t i = 0; i < pushing.size(); ++i)
            for (std::size_t row = 0; row < factor.size(); ++row)
                pushing[i] += modes.push[i * factor.size() + row] * factor[row][0];
    }
    for (const GivenTorque& torque : modes.torques) pushing[torque.coordinate] += torque.at(time);
}

struct TorqueRange {
    double low, high;
};
// Available torque of a servo at a speed: it falls linearly to zero at the speed limit.
inline TorqueRange torque_range(const Servo& servo, double rate)
{
    if (!std::isfinite(servo.torque_limit)) return {-servo.torque_limit, servo.torque_limit};
    const double by = rate / servo.speed_limit;
    return {-servo.torque_limit * std::clamp(1.0 + by, 0.0, 1.0), servo.torque_limit * std::clamp(1.0 - by, 0.0, 1.0)};
}
inline double wanted_torque(const Servo& servo, const Target& target, double x, double rate)
{
    if (target.by_torque) return target.torque;
    return servo.kp * (target.reference[0] - x) + servo.kd * (target.reference[1] - rate) + target.torque;
}

// Forces for the coordinates x and their rates. `forces.pushing` and the targets must be those of the instant.
inline void set_forces(const Modes& modes, const std::vector<Target>& target, const double* x, const double* rate,
                       Forces& forces)
{
    const std::size_t n = modes.coordinates;
    forces.elastic = forces.motor_power = forces.damping_power = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        double spring = 0.0, damper = 0.0;
        for (std::size_t j = 0; j < n; ++j) {
            spring += modes.stiffness[i * n + j] * (x[j] - modes.rest[j]);
            damper += modes.damping[i * n + j] * rate[j];
        }
        forces.elastic += 0.5 * spring * (x[i] - modes.rest[i]);
        forces.damping_power -= damper * rate[i];
        forces.motor_power += forces.pushing[i] * rate[i];
        forces.total[i] = spring + damper - forces.pushing[i];
    }
    for (const Stop& stop : modes.stops) {
        const std::size_t m = stop.mode;
        const double beyond = stop.beyond(x[m]), force = stop.hardness(beyond, rate[m]) * beyond;
        forces.total[m] += force;
        forces.elastic += 0.5 * stop.stiffness * beyond * beyond;
        forces.damping_power -= (force - stop.stiffness * beyond) * rate[m];
    }
    for (std::size_t s = 0; s < modes.servos.size(); ++s) {
        const Servo& servo = modes.servos[s];
        const std::size_t i = servo.coordinate;
        const auto [low, high] = torque_range(servo, rate[i]);
        forces.torque[s] = std::clamp(wanted_torque(servo, target[s], x[i], rate[i]), low, high);
        forces.total[i] -= forces.torque[s];
        forces.motor_power += forces.torque[s] * rate[i];
    }
}

// Derivatives of the forces, without stops, with respect to coordinates and rates, and the part of a moving reference
// in their rate.
inline void linearise(const Modes& modes, const std::vector<Target>& target, const double* x, const double* rate,
                      std::vector<double>& stiffness, std::vector<double>& damping, std::vector<double>& in_time)
{
    const std::size_t n = modes.coordinates;
    stiffness = modes.stiffness, damping = modes.damping;
    std::fill(in_time.begin(), in_time.end(), 0.0);
    for (std::size_t s = 0; s < modes.servos.size(); ++s) {
        const Servo& servo = modes.servos[s];
        const std::size_t i = servo.coordinate;
        const double wanted = wanted_torque(servo, target[s], x[i], rate[i]), by = rate[i] / servo.speed_limit;
        const auto [low, high] = torque_range(servo, rate[i]);
        if (low < wanted && wanted < high) {
            if (target[s].by_torque) continue;
            const Jet& reference = target[s].reference;
            stiffness[i * n + i] += servo.kp, damping[i * n + i] += servo.kd;
            in_time[i] += servo.kp * reference[1] + servo.kd * reference[2];
        } else if (const double slope = wanted >= high ? by : -by; 0.0 < slope && slope < 1.0) {
            damping[i * n + i] += servo.torque_limit / servo.speed_limit;
        }
    }
}

// Adds the stops to the result of `linearise`.
inline void linearise_stops(const Modes& modes, const double* x, const double* rate, std::vector<double>& stiffness,
                            std::vector<double>& damping)
{
    for (const Stop& stop : modes.stops) {
        const std::size_t m = stop.mode, place = m * modes.coordinates + m;
        const double beyond = stop.beyond(x[m]), hardness = stop.hardness(beyond, rate[m]);
        if (beyond == 0.0 || hardness == 0.0) continue;
        stiffness[place] += hardness, damping[place] += stop.damping * std::abs(beyond);
    }
}

}  // namespace eel_core
