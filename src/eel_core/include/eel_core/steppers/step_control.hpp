// SPDX-License-Identifier: Apache-2.0
// The control of the time step. `error_by_tolerance` judges the error of the last step. From it `growth_factor` or
// `shrink_factor` propose the next one (called by `Stepper`, for robots by `BentStepper`, and by `Pace`, which both
// have). `time_step_size` fits the proposal to `StepBounds` and to breakpoints ahead. The bounds come from the accuracy
// and the law: `step_bounds_of` in eel_dynamics/accuracy/step_bounds.py.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "eel_core/momentum_balance.hpp"

namespace eel_core {

// Bounds of the steps of a march.
struct StepBounds {
    double tolerance;           // relative error per step
    double longest;             // [s], longest step; a fixed method takes steps of this length, or slightly shorter
    double smallest;            // [s]
    double length;              // [m], scale of positions
    double momentum_floor;      // [kg m/s], smaller momentum counts as none
    double part_of_span;        // of the time between two breakpoints: greatest step
    double most_steps;          // per second of motion
    double spare_steps;         // further steps, available at any time
    double torque_floor = 0.0;  // [N m], of a body with modes: below it torques count as none
};

// Sum of the squares of some entries.
inline double square_of(const State& values, std::size_t first, std::size_t last)
{
    double square = 0.0;
    for (std::size_t k = first; k < last; ++k) square += values[k] * values[k];
    return square;
}

// Makes the orientation a unit quaternion again.
inline void normalise(State& y)
{
    const double length = std::sqrt(square_of(y, 3, 7));
    for (std::size_t k = 3; k < 7; ++k) y[k] /= length;
}

// Squares of the greatest angular and linear momentum of a march so far.
struct MomentumScale {
    double angular = 0.0, linear = 0.0;

    void include(const State& y)
    {
        angular = std::max(angular, square_of(y, 7, 10));
        linear = std::max(linear, square_of(y, 10, 13));
    }
};

// Error of a step relative to the tolerance: the worst of position / body length, orientation and fins / 1, and momenta
// / their greatest magnitude. defect: error / the step's length. end: state at the step's end.
inline double error_by_tolerance(const StepBounds& bounds, MomentumScale scale, const State& end, const State& defect,
                                 double length)
{
    const double body = bounds.length * bounds.length;
    scale.include(end);
    const double linear = std::max(scale.linear, bounds.momentum_floor * bounds.momentum_floor);
    const double angular = std::max(scale.angular, linear * body);
    const double worst =
        std::max({square_of(defect, 0, 3) / body, square_of(defect, 3, 7), square_of(defect, 7, 10) / angular,
                  square_of(defect, 10, 13) / linear, square_of(defect, state_size, state_space)});
    return std::sqrt(worst) * length / bounds.tolerance;
}

// A growth of the step rounded down to a multiple of 1/32. It comes from an error estimate whose last digits differ
// between processors, and these must not affect all later steps.
inline double rounded_down(double growth) { return std::floor(32.0 * growth) / 32.0; }

// From Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, section II.4, eq. 4.13: the step is
// slightly shorter than its error allows, and changes by at most these factors at a time.
inline constexpr double safety = 0.9, greatest_growth = 5.0, greatest_shrinking = 0.2;
inline constexpr double no_error = 1e-4;  // of the tolerance: the step grows by the greatest factor at any order

// Our own:
inline constexpr double shrinking_of_lost = 0.1;  // for a step without a valid motion at its end
inline constexpr double accepted_of_adams =
    4.0;  // error / tolerance: up to this the step is not repeated, but the next one is shorter
inline constexpr double first_step = 0.02;  // of the longest: the first of all steps
inline constexpr double equal_steps = 8.0;  // up to so many steps of Adams' method before a breakpoint are made equal

// Growth of a step whose error is proportional to its length to the power `order`.
inline double growth_factor(double error, double order)
{
    return error < no_error ? greatest_growth : std::min(greatest_growth, safety * std::pow(error, -1.0 / order));
}
inline double shrink_factor(double error, double order)
{
    return rounded_down(std::max(greatest_shrinking, safety * std::pow(error, -1.0 / order)));
}

// Times at which a derivative of the shape jumps, ascending: the last one up to a time, and the next one.
struct Span {
    double before = -std::numeric_limits<double>::infinity(), next = std::numeric_limits<double>::infinity();

    Span(const std::vector<double>& breakpoints, double time)
    {
        const auto behind = std::upper_bound(breakpoints.begin(), breakpoints.end(), time);
        if (behind != breakpoints.end()) next = *behind;
        if (behind != breakpoints.begin()) before = *(behind - 1);
    }
};

// Length [s] of the next step from `start`: as proposed, or adjusted so that steps end on the next breakpoint without a
// tiny last step; at most a part of the span, as the works are integrals over it.
inline double time_step_size(bool adaptive, bool adams, const StepBounds& bounds, double proposed, double start,
                             const Span& span, double tiny)
{
    const double left = span.next - start;
    if (!adaptive) return left < 1e100 ? left / std::ceil(left / bounds.longest - 1e-9) : bounds.longest;
    const double length = std::min({bounds.longest, proposed, bounds.part_of_span * (span.next - span.before)});
    if (adams && left < equal_steps * length) return left / std::ceil(left / length - 1e-9);
    if (length > left - tiny) return left;
    return length > 0.5 * left ? std::min(length, 0.5 * left) : length;
}

}  // namespace eel_core
