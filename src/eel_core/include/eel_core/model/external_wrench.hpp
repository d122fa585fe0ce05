// SPDX-License-Identifier: Apache-2.0
// Wrenches from outside on sections: tows, tethers, thrusters. What a run is given, and the numbers of one evaluation.
// Ours, not the paper's.
#pragma once

#include <functional>

#include "eel_core/model/appendage.hpp"

namespace eel_core {

struct ExternalWrench {
    std::size_t node = 0;                             // at its X, where a panel ends; `Appendage::nose` for X = 0
    std::size_t station_behind = 0;                   // the first station there or behind
    bool in_world = false;                            // in the axes of the world, not in those of the section
    std::function<Wrench<Space, double>(double)> at;  // [N m], [N], about the section's centre, of the time [s]
};

// Of one evaluation, in the axes of the head.
template <class M>
struct ExternalLoad {
    std::size_t node = 0, station_behind = 0;
    Vector<M, double> position;  // [m], of the section's centre about the head
    Wrench<M, double> wrench;    // about the section's centre
};

}  // namespace eel_core
