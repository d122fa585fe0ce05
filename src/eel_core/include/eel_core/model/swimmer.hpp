// SPDX-License-Identifier: Apache-2.0
// What a run never writes: body and water at the nodes and stations, and which physics is on.
#pragma once

#include "eel_core/model/appendage.hpp"
#include "eel_core/model/fin.hpp"
#include "eel_core/model/friction.hpp"
#include "eel_core/model/grid.hpp"

namespace eel_core {

// Speeds of a section on which its drag depends: V1, V2, V3, Omega1 and Re / 8e4 - 1; `speeds` is their number. From
// `lateral` on, the drag has a kink or a jump where the speed changes its sign.
enum Speed : std::size_t { axial = 0, lateral = 1, vertical = 2, roll = 3, above_critical = 4, speeds = 5 };

// Numbers of a section in which its inertial wrench, its weight, the undisturbed pressure of a flow and, from `drag2`
// on, its drag are linear.
struct SectionPart {
    // clang-format off
    enum : std::size_t {
        mass, added2, added3, lever, net, inertia1, inertia2, inertia3, displaced,
        drag2, drag3, drag_roll, laminar, turbulent, segment, count
    };
    // clang-format on
};

struct Swimmer {
    Grid grid;
    Sections sections;
    Friction friction = Friction::printed;
    bool resistive = true;                // drag along the body
    bool segmented = false;               // the links have a drag of their own, `DragSection::segment`
    std::size_t first_watched = lateral;  // from this `Speed` on, changes of sign are integrated exactly
    double wake = 1.0;                    // 0 where no water is swept past the sections
    double inertia_of_water = 1.0;        // 0 where the sections of the nodes have no water
    bool flow_gradient = true;            // forces by the gradient of a flow
    Section<double> tail{};               // what is swept off there, whatever the nodes have
    double nose_mass = 0.0;               // [kg], m_o
    double nose_drag = 0.0;               // [kg/m], 1/2 rho_f k_o
    bool distributed_pressure = false;    // -d/dX(T_f t1) along the body in place of -T_f t1 at the tail
    bool offset = false;                  // the centre of mass is off the axis: `lever` is part of the inertia
    double righting = 0.0;                // [m/s^2], g, by which `lever` gives a moment of weight; 0: none
    double gravity = 0.0;                 // [m/s^2], g, by which `net` gives a force; 0: no section has any

    std::vector<Fin> fins;         // in space alone
    std::vector<FinServo> servos;  // of the fins

    std::vector<Appendage> appendages;  // and the base of a blunt tail

    bool weighs() const { return righting != 0.0 || gravity != 0.0; }

    // For some speeds: parts of the nodes that the integral of the drag from a panel's start misses, by the drag at the
    // node [m]; at fractions (1 - cos(pi k / last)) / 2 of the panel, k = 0 ... last. None where the sections are
    // smooth.
    std::array<std::vector<Row>, speeds> missed_drag;

    // Where profiles are given:
    std::size_t stations = 0;
    std::size_t shown =
        0;  // the first so many, of which profiles are given; then, from `first_sensor` on, the sensors'
    Sections at_station;
    Row added2_slope, added3_slope, added_roll_slope;  // derivatives by X
    std::vector<std::size_t> nodes_before;             // how many nodes lie at or before the station
    FromNose to_station;
    // For each `SectionPart`: what the sum of `to_station` over a station's own panel misses of its integral. Empty
    // where the sections are as smooth as the motion.
    std::vector<FromNose> missed;

    // A stretch of `to_station` holds stations that rise: the sensors begin one.
    std::size_t first_sensor() const { return blocks_of(shown) * width; }
    std::size_t sensors() const { return stations > shown ? stations - first_sensor() : 0; }
};

}  // namespace eel_core
