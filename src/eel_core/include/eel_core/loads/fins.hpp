// SPDX-License-Identifier: Apache-2.0
// Fins in the balance: lift, drag and added mass of each, a point wrench on the section at its station.
//
//     e_c = sin(d) n0 - cos(d) E1,  e_n = cos(d) n0 + sin(d) E1        W = V - u = w_c e_c + w_n e_n,  S = -w_n/q, C =
//     w_c/q F = 1/2 rho_f A q^2 (C_L (C e_n + S e_c) - C_D (C e_c - S e_n))  F_a = - m_a e_n (e_n . (a - a_u))
//
// With the attached lift L = c_L S C and the share k of stall: C_L = (1 - k) L + k c_n S C, C_D = C_0 + (1 - k) L^2 /
// (pi e AR) + k c_n S^2. The momentum m_a (e_n . V) e_n is part of that of the body.
#pragma once

#include "eel_core/loads/moving_water.hpp"
#include "eel_core/loads/point_wrenches.hpp"

namespace eel_core {

// sin of the incidence, rad: at which the flow begins to separate from the plate, and has fully separated.
inline constexpr double stall_begins = 0.29552020666133957, stall_ends = 0.56464247339503537;

// f_r of eq. (64) in the sine of the incidence.
inline double share_of_stall(double sine)
{
    return smooth_ramp(std::clamp((std::abs(sine) - stall_begins) / (stall_ends - stall_begins), 0.0, 1.0));
}

// Lift and drag [N] for the velocity w through the water, in the axes of the vectors.
inline Vector3<double> steady_force(const Fin& fin, const Vector3<double>& normal, const Vector3<double>& chord,
                                    const Vector3<double>& w)
{
    const double along = dot(w, chord), across = dot(w, normal), speed = std::sqrt(along * along + across * across);
    if (speed == 0.0) return {};
    const double s = -across / speed, c = along / speed, k = share_of_stall(s), attached = fin.lift_slope * s * c;
    const double lift = (1.0 - k) * attached + k * fin.normal_drag * s * c;
    const double drag = fin.friction_drag + (1.0 - k) * attached * attached * fin.induced + k * fin.normal_drag * s * s;
    return fin.pressure * speed * speed * (lift * (c * normal + s * chord) - drag * (c * chord - s * normal));
}

inline Wrench<Space, double> at_fin(const FinMotion& fin, const Vector3<double>& force)
{
    return force_at<Space>(fin.position, force);
}

// Places and angles of the fins in a configured body, in state y; with the flow there.
EEL_CORE_APART inline void place_fins(const Swimmer& swimmer, const LawOnGrid& law, const Water& water, double time,
                                      const std::array<double, state_space>& y, Workspace<Space>& work)
{
    const Vector3<double> nose{y[0], y[1], y[2]};
    for (std::size_t i = 0; i < swimmer.fins.size(); ++i) {
        const Fin& fin = swimmer.fins[i];
        const FinServo& servo = swimmer.servos[fin.servo];
        FinMotion& now = work.fins[i];
        const auto [command, rate] = fin.servo < law.fins.size() ? law.fins[fin.servo].at(time) : AngleLaw{}.at(time);
        now.angle = fin.sign * (servo.time_constant > 0.0 ? y[servo.slot] : command);
        now.rate = fin.sign * rate;  // of a servo: `find_fin_loads`
        const Frame3<double> frame = work.frame.node(fin.node);
        const auto [s, c] = std::array{std::sin(now.angle), std::cos(now.angle)};
        const Vector3<double> rest = frame.parent(fin.normal);
        now.arm = frame.parent(fin.centre), now.position = work.position.node(fin.node) + now.arm;
        now.normal = c * rest + s * frame.axis1, now.chord = s * rest - c * frame.axis1;
        Components<Vector3<double>>::each(now.position,
                                          [&](std::size_t row, double value) { work.fin_places.row(row)[i] = value; });
    }
    if (work.flowing) work.fin_flow.set(water, time, nose, work.head, work.fin_places, swimmer.fins.size());
}

// Adds the added masses m_a y y^T, y = (r x e_n; e_n), to the inertia; returns their momentum of the change of
// shape.
EEL_CORE_APART inline Momentum<Space, double> add_fin_inertia(const Swimmer& swimmer, Workspace<Space>& work)
{
    Momentum<Space, double> sum{};
    for (std::size_t i = 0; i < swimmer.fins.size(); ++i) {
        const Fin& fin = swimmer.fins[i];
        const FinMotion& now = work.fins[i];
        const auto row = components_of(at_fin(now, now.normal));
        for (std::size_t a = 0; a < row.size(); ++a)
            for (std::size_t b = 0; b <= a; ++b)
                work.inertia.lower[Factored<6>::at(a, b)] += fin.added_mass * row[a] * row[b];
        const Vector3<double> shape =
            work.shape_velocity.node(fin.node) + cross(work.shape_omega.node(fin.node), now.arm);
        sum += at_fin(now, fin.added_mass * dot(now.normal, shape) * now.normal);
    }
    return sum;
}

// - k_p roll - k_d Omega1 at the servo's node.
inline double held_roll(const FinServo& servo, const Workspace<Space>& work)
{
    if (servo.roll_gain == 0.0 && servo.rate_gain == 0.0) return 0.0;
    const Frame3<double> frame = work.frame.node(servo.node);
    const Vector3<double> up = work.head.local(Vector3{0.0, 0.0, 1.0});
    const double roll = std::atan2(dot(frame.axis2, up), dot(frame.axis3, up));
    return -servo.roll_gain * roll - servo.rate_gain * dot(frame.axis1, work.omega.node(servo.node));
}

// Rates of the servos' angles [rad/s] into those of the state; 0 where the angle is given.
inline void put_servo_rates(const Swimmer& swimmer, const LawOnGrid& law, double time,
                            const std::array<double, state_space>& y, Workspace<Space>& work)
{
    for (std::size_t i = 0; i < swimmer.servos.size(); ++i) {
        const FinServo& servo = swimmer.servos[i];
        if (servo.time_constant == 0.0) continue;
        const double given = i < law.fins.size() ? law.fins[i].at(time)[0] : 0.0;
        const double wanted = servo.limit * std::tanh((given + held_roll(servo, work)) / servo.limit);
        work.servo_rate[servo.slot] = (wanted - y[servo.slot]) / servo.time_constant;
    }
}

// Forces of the fins, and their part `fin_load` of the rate of the momentum, from the true velocities:
//
//     F + x,  x = m_a ((q . V) e_n + (e_n . V) q + (e_n . a_u) e_n),  q = Omega x e_n - (rate of d) e_c;  V x momentum
EEL_CORE_APART inline void find_fin_loads(const Swimmer& swimmer, const LawOnGrid& law, double time,
                                          const std::array<double, state_space>& y, Workspace<Space>& work)
{
    put_servo_rates(swimmer, law, time, y, work);
    work.fin_load = {};
    for (std::size_t i = 0; i < swimmer.fins.size(); ++i) {
        const Fin& fin = swimmer.fins[i];
        const FinServo& servo = swimmer.servos[fin.servo];
        FinMotion& now = work.fins[i];
        if (servo.time_constant > 0.0) now.rate = fin.sign * work.servo_rate[servo.slot];
        const Vector3<double> omega = work.omega.node(fin.node);
        now.velocity = work.velocity.node(fin.node) + cross(omega, now.arm);
        Vector3<double> w = now.velocity;
        now.water_rate = {};
        if (work.flowing) {
            const FlowSample<Space, double> water = work.fin_flow.node(i);
            w = w - water.u, now.water_rate = water.acceleration();
        }
        now.force = steady_force(fin, now.normal, now.chord, w);
        const Vector3<double> q = cross(omega, now.normal) - now.rate * now.chord;
        const double through = dot(now.normal, now.velocity);
        const Vector3<double> x =
            fin.added_mass * ((dot(q, now.velocity) + dot(now.normal, now.water_rate)) * now.normal + through * q);
        now.momentum = fin.added_mass * through * now.normal;
        const Vector3<double> force = now.force + x, torque = cross(now.velocity, now.momentum);
        now.load = {cross(now.arm, force) + torque, force};
        work.fin_load += at_fin(now, force);
        work.fin_load.angular += torque;
    }
}

// The wrench of all fins about the head, with these accelerations of the sections; keeps the force of each.
EEL_CORE_APART inline Wrench<Space, double> wrench_of_fins(const Swimmer& swimmer, const Accelerations<Space>& sections,
                                                           Workspace<Space>& work)
{
    Wrench<Space, double> sum{};
    for (std::size_t i = 0; i < swimmer.fins.size(); ++i) {
        const Fin& fin = swimmer.fins[i];
        FinMotion& now = work.fins[i];
        const Vector3<double> omega = work.omega.node(fin.node);
        const Vector3<double> acceleration = sections.linear.node(fin.node) +
                                             cross(sections.angular.node(fin.node), now.arm) +
                                             cross(omega, cross(omega, now.arm));
        const double relative = dot(now.normal, acceleration - now.water_rate);
        now.whole = now.force - fin.added_mass * relative * now.normal;
        sum += at_fin(now, now.whole);
    }
    return sum;
}

// The wrench of the fins that lie ahead of the points of a block, or at them, about the head, or their momentum;
// `behind`: for each fin, whether the points lie behind it.
inline Wrench<Space, Lanes> fins_ahead(const Swimmer& swimmer, const Workspace<Space>& work, std::size_t block,
                                       std::size_t Fin::* behind,
                                       Vector3<double> FinMotion::* vector = &FinMotion::whole)
{
    return sum_ahead(
        swimmer.fins.size(), block, [&](std::size_t i) { return swimmer.fins[i].*behind; },
        [&](std::size_t i) { return at_fin(work.fins[i], work.fins[i].*vector); });
}

// Adds the forces due to the head's acceleration to the forces without it.
inline void accelerate_fins(const Swimmer& swimmer, const Twist<Space, double>& head, Workspace<Space>& work)
{
    for (std::size_t i = 0; i < swimmer.fins.size(); ++i) {
        FinMotion& now = work.fins[i];
        const double gained = dot(now.normal, head.linear + cross(head.angular, now.position));
        now.whole = now.whole - swimmer.fins[i].added_mass * gained * now.normal;
    }
}

// Sum of the powers [W], with the accelerations.
inline double fin_power(const Swimmer& swimmer, const Workspace<Space>& work)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < swimmer.fins.size(); ++i) sum += dot(work.fins[i].whole, work.fins[i].velocity);
    return sum;
}

}  // namespace eel_core
