// SPDX-License-Identifier: Apache-2.0
// Constants of a run: body and water at the nodes and stations, and the active physics.
#pragma once

#include "eel_core/model/appendage.hpp"
#include "eel_core/model/fin.hpp"
#include "eel_core/model/friction.hpp"
#include "eel_core/model/grid.hpp"

namespace eel_core {

// Speeds of a section on which its drag depends: V1, V2, V3, Omega1 and Re / 8e4 - 1; `speeds` is their number. From
// `lateral` on, the drag has a kink or a jump when the speed changes sign.
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
    bool segmented = false;               // whether links have drag, `DragSection::segment`
    std::size_t first_watched = lateral;  // from this `Speed` on, changes of sign are integrated exactly
    double wake = 1.0;                    // 0 if no water is swept past the sections
    double inertia_of_water = 1.0;        // 0 if the sections at the nodes have no water
    bool flow_gradient = true;            // forces by the gradient of a flow
    Section<double> tail{};               // the water swept off there, independent of the nodes
    double nose_mass = 0.0;               // [kg], m_o
    double nose_drag = 0.0;               // [kg/m], 1/2 rho_f k_o
    bool distributed_pressure = false;    // -d/dX(T_f t1) along the body instead of -T_f t1 at the tail
    bool offset = false;                  // the centre of mass is off the axis: `lever` is part of the inertia
    double righting = 0.0;                // [m/s^2], g, for the moment of weight of `lever`; 0: none
    double gravity = 0.0;                 // [m/s^2], g, for the force of `net`; 0: no net weight

    std::vector<Fin> fins;         // only in space
    std::vector<FinServo> servos;  // of the fins

    std::vector<Appendage> appendages;  // and the base of a blunt tail

    bool weighs() const { return righting != 0.0 || gravity != 0.0; }

    // For some speeds: corrections of the nodes' parts in the integral of the drag from a panel's start, per drag at
    // the node [m]; at fractions (1 - cos(pi k / last)) / 2 of the panel, k = 0 ... last. Empty if the sections are
    // smooth.
    std::array<std::vector<Row>, speeds> missed_drag;

    // Where profiles are given:
    std::size_t stations = 0;
    std::size_t shown =
        0;  // the first so many, of which profiles are given; then, from `first_sensor` on, the sensors'
    Sections at_station;
    Row added2_slope, added3_slope, added_roll_slope;  // derivatives by X
    std::vector<std::size_t> nodes_before;             // number of nodes at or before the station
    FromNose to_station;
    // For each `SectionPart`: correction of the sum of `to_station` over a station's own panel. Empty
    // if the sections are as smooth as the motion.
    std::vector<FromNose> missed;

    // A stretch of `to_station` holds stations that rise: the sensors begin one.
    std::size_t first_sensor() const { return blocks_of(shown) * width; }
    std::size_t sensors() const { return stations > shown ? stations - first_sensor() : 0; }
};

}  // namespace eel_core
