// SPDX-License-Identifier: Apache-2.0
// State, settings and status of a march.
#pragma once

#include <cstdint>

#include "eel_core/steppers/ledger.hpp"
#include "eel_core/steppers/step_control.hpp"

namespace eel_core {

enum class Status { marched, not_finite, step_too_small, singular, too_many_steps, unfinished };

// Nodes that may be evaluated before a march returns unfinished, to be called again: some milliseconds.
struct Slice {
    std::int64_t left = 40'000;

    bool used_up() const { return left <= 0; }
    void spend(std::size_t nodes) { left -= static_cast<std::int64_t>(nodes); }
};

// Settings that are fixed while a march is not disturbed.
struct MarchSettings {
    LawOnGrid law;
    std::vector<double> breakpoints;  // [s], ascending
    StepBounds bounds;
    bool ledger = true;  // integrate the works
    Water water{};
};

struct Counts {
    std::int64_t steps = 0, rejected = 0, evaluations = 0;
};

// A swimmer at an instant.
struct Present {
    double time = 0.0;  // [s]
    State state{};
    std::vector<double> x, rate;  // of the coordinates of a body with modes
    WorkDone works{};
    double damping_work = 0.0;  // [J], of its dampers since the start
};

}  // namespace eel_core
