// SPDX-License-Identifier: Apache-2.0
// A bent body of equal sections, 1 m long, by the reference in Python.
// Written by src/eel_dynamics/test/make_core_table.py.
#pragma once

#include <array>

namespace eel_core::reference {

// kg/m and kg m: mass, added2, added3, inertia1, inertia2, inertia3, added_roll
inline constexpr std::array<double, 7> section{7.539822369,    11.30973355,    5.026548246,   0.01137256541,
                                               0.006785840132, 0.003015928947, 0.001570796327};
// kg/m^2 and kg: drag2, drag3, drag_roll
inline constexpr std::array<double, 3> drag{118.8, 40, 0.006283185307};
// (K2, K3) rad/m, and two time derivatives
inline constexpr std::array<std::array<double, 2>, 3> bend{{{0.4, 0.7}, {-1.1, 1.6}, {2, -5}}};
// Omega rad/s, V m/s
inline constexpr std::array<double, 6> twist{1.9, -0.2, 0.5, -0.6, 0.9, -1.8};
// rad/s^2, m/s^2: true acceleration of the head, in its axes
inline constexpr std::array<double, 6> acceleration{-479.0306865, -163.9299686, 78.97719603,
                                                    4.74083585,   -18.20951911, -19.52703436};
// W, of the actuators
inline constexpr double actuator_power{-13.49276883};
// N m, N: internal wrench at the nodes, section axes
inline constexpr std::array<std::array<double, 6>, 8> wrench{
    {{0.05401313567, -0.09196655754, -0.04809734976, 0.3495630488, 3.222260525, -9.143190448},
     {0.4417053264, -1.935058242, 0.4707838232, 2.71318307, -13.20160183, -29.8387591},
     {0.7832601514, -7.719975956, 3.506303468, 5.447253329, -21.25981789, -36.99062459},
     {0.361940466, -12.90651831, 6.60375542, 5.341513076, -6.562402482, -9.572940135},
     {-0.3307559647, -10.73278741, 5.609560105, -0.9633748428, 14.93340928, 28.43415917},
     {-0.3542717938, -4.060973727, 2.096837352, -13.69506439, 19.79670975, 37.40915555},
     {-0.07676904893, -0.4005876255, 0.1971891581, -27.10077014, 8.00131592, 15.33076434},
     {7.178146966e-13, 1.33226763e-12, -1.350031198e-12, -32.86015936, 2.138733635e-12, 9.73443548e-13}}};

}  // namespace eel_core::reference
