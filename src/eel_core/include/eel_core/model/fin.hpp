// SPDX-License-Identifier: Apache-2.0
// Fins: stiff plates on the body that turn about their span, and their servos. Constants of a run, and the numbers of
// one evaluation. Our own, not in the paper.
#pragma once

#include "eel_core/algebra/cubics.hpp"

namespace eel_core {

using AngleLaw = Cubics<double>;  // [rad]

// The servo of one fin, or of two equal ones. Its angle is a state with the rate (limit tanh(command / limit) - angle)
// / tau.
struct FinServo {
    double time_constant = 0.0;               // [s], tau; 0: the angle is the command, not a state
    double limit = 1.0;                       // [rad]
    double roll_gain = 0.0, rate_gain = 0.0;  // [1], [s]: - k_p roll - k_d Omega1 at its node are added to the command
    std::size_t node = 0, slot = 0;           // slot: of the state
    double initial = 0.0;                     // [rad], its angle at the start
};

struct Fin {
    std::size_t node = 0;  // at its station, where a panel ends
    Vector3<double> normal{},
        centre{};             // section axes: of the plate at rest; centre of pressure, about the section [m]
    double pressure = 0.0;    // [kg/m], 1/2 rho_f times its area
    double lift_slope = 0.0;  // [1], per sine times cosine of the incidence
    double induced = 0.0;     // [1], 1 / (pi e AR)
    double normal_drag = 0.0, friction_drag = 0.0;  // [1], of a plate across the stream, and along it
    double added_mass = 0.0;                        // [kg], along the normal
    std::size_t servo = 0;
    std::size_t node_behind = 0, station_behind = 0;  // the first node behind the station; the first there or behind
    double sign = 1.0;                                // of its angle relative to the servo's
};

// One evaluation, in the axes of the head.
struct FinMotion {
    double angle = 0.0, rate = 0.0;            // [rad], [rad/s]
    Vector3<double> arm{}, position{};         // [m], of the centre of pressure, about the section and about the head
    Vector3<double> normal{}, chord{};         // e_n; e_c, from the trailing to the leading edge
    Vector3<double> velocity{}, water_rate{};  // [m/s], [m/s^2]
    Vector3<double> force{}, whole{};          // [N], lift and drag; the same with the added mass
    Vector3<double> momentum{};                // [kg m/s], of the added mass
    Wrench<Space, double> load{};              // about the section: part of the rate of the momentum
};

}  // namespace eel_core
