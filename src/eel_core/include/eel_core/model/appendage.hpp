// SPDX-License-Identifier: Apache-2.0
// Appendages: bars, boxes, plates and cables fixed to a section, and the base of a blunt tail, as drag areas. Constants
// of a run, and the numbers of one evaluation. Our own, not in the paper.
#pragma once

#include "eel_core/algebra/motion.hpp"

namespace eel_core {

struct Appendage {
    static constexpr std::size_t nose = static_cast<std::size_t>(-1);  // a `node` for X = 0, where no node lies

    std::size_t node = 0;            // at its X, where a panel ends
    Vector3<double> arm{};           // [m], (0, y, z) from the section's centre, section axes
    Vector3<double> drag{};          // [kg/m], 1/2 rho_f times its drag areas, section axes
    bool by_speed = false;           // the law |w| w_i instead of |w_i| w_i
    bool of_body = false;            // the base of the body's tail: its power is part of the drag's
    std::size_t station_behind = 0;  // the first station there or behind; none for an appendage at the tail's end
};

// One evaluation, in the axes of the head.
template <class M>
struct AppendageMotion {
    Vector<M, double> arm, position;  // [m], of the appendage, about the section and about the head
    Vector<M, double> velocity;       // [m/s]
    Vector<M, double> force;          // [N], of the water on it
};

}  // namespace eel_core
