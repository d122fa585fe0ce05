// SPDX-License-Identifier: Apache-2.0
// The pace of a march: data from its past steps for the choice of the next ones, for any method.
#pragma once

#include "eel_core/steppers/present.hpp"

namespace eel_core {

struct Pace {
    Counts counts;
    MomentumScale scale;
    double torque_scale = 0.0;  // [N m], greatest torque so far of a body with modes
    double proposed = 0.0;      // [s], length of the next step
    double budget = 0.0;        // steps that may be tried before motion earns further ones

    // Resets the pace for the very first step, which begins in the state y.
    void forget(const State& y, const StepBounds& bounds)
    {
        *this = {};
        proposed = first_step * bounds.longest, budget = bounds.spare_steps;
        scale.include(y);
    }

    // Calls `take_step` until the last step, which ends at `end_time()` [s], contains the time `until`
    // [s]. nodes: cost of an evaluation. besides: further cost of a step, in evaluations.
    Status march(double until, std::size_t nodes, std::int64_t besides, Slice& slice, const auto& end_time,
                 const auto& take_step)
    {
        const double tiny = 1e-12 * std::max(1.0, std::abs(until));
        while (end_time() < until - tiny) {
            if (budget < 0.0) return Status::too_many_steps;
            if (slice.used_up()) return Status::unfinished;
            const std::int64_t before = counts.evaluations - besides;
            const Status status = take_step(tiny);
            if (status != Status::marched) return status;
            slice.spend(static_cast<std::size_t>(counts.evaluations - before) * nodes);
        }
        return Status::marched;
    }

    // Shortens a step of `length` [s] that ended with this `status`, or with an `error` above the tolerance.
    void shorten(Status status, double error, double order, double& length)
    {
        ++counts.rejected, budget -= 1.0;
        length *= status != Status::marched ? shrinking_of_lost : shrink_factor(error, order);
    }
    // Proposes the next step after one of `length` [s] that may grow by a factor. asked: the requested length.
    void propose(const StepBounds& bounds, double length, double asked, double growth)
    {
        const double grown = length * rounded_down(growth);
        proposed = std::min(bounds.longest, length >= asked ? grown : std::max(asked, grown));
    }
    // Counts a step of `length` [s] to the state y.
    void accept(const StepBounds& bounds, double length, const State& y)
    {
        ++counts.steps;
        budget = std::min(bounds.spare_steps, budget + bounds.most_steps * length) - 1.0;
        scale.include(y);
    }
};

}  // namespace eel_core
