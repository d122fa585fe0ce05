// SPDX-License-Identifier: Apache-2.0
// Steps of the head in time, in the momentum form, with dense output.
//
// Steps end at the breakpoints of the shape, where its derivatives jump. The state between steps comes from the
// method's dense output, so that the steps do not depend on when the run is sampled.
#pragma once

#include "eel_core/algorithm.hpp"
#include "eel_core/steppers/adams.hpp"
#include "eel_core/steppers/method.hpp"
#include "eel_core/steppers/pace.hpp"

namespace eel_core {

// The step that contains the present, and the data for the next ones.
template <class M>
class Stepper {
  public:
    Stepper(const Swimmer& swimmer, const Method& method)
        : swimmer_(&swimmer), method_(method), adams_(std::max<std::size_t>(method.adams, 1)), work_(swimmer)
    {
    }

    Pace pace;

    Workspace<M>& work() { return work_; }
    const Workspace<M>& work() const { return work_; }
    double end_time() const { return start_ + length_; }

    // Makes the next step begin at the present.
    void begin(const MarchSettings&, const Present& now)
    {
        end_ = now.state, works_ = now.works;
        start_ = now.time, length_ = 0.0, anew_ = true;
    }

    // Marches until the step contains the time `until` [s].
    Status march(const MarchSettings& settings, double until, Slice& slice)
    {
        return pace.march(
            until, swimmer_->grid.nodes, settings.ledger ? evaluations_of_powers : 0, slice,
            [this] { return end_time(); }, [&](double tiny) { return take_step(settings, tiny); });
    }

    // Archives all data that determine the next steps and the present (`march/archive.hpp`).
    template <class Archive>
    void pass(Archive& archive)
    {
        archive.same(method_.stages), archive.same(method_.adams);
        archive(pace, adams_, start_, length_, begin_, end_, rate_, works_, powers_, anew_);
    }

    // Sets state and works to the present time, which lies within the step.
    void put_state(bool ledger, Present& now) const
    {
        double theta = 1.0;
        if (ends_at(now.time)) {
            now.state = end_;
        } else {
            theta = std::clamp((now.time - start_) / length_, 0.0, 1.0);
            now.state = interpolated(theta);
        }
        if (ledger) now.works = powers_.works_until(works_, length_, theta);
    }

  private:
    bool ends_at(double time) const { return std::abs(end_time() - time) <= 1e-12 * std::max(1.0, std::abs(time)); }

    std::span<const State> rates(std::size_t count) const { return std::span(rate_).first(count); }

    State interpolated(double theta) const
    {
        Method::Weights weight;
        for (std::size_t i = 0; i < method_.stages; ++i) {
            const auto& d = method_.dense[i];
            weight[i] = theta * (d[0] + theta * (d[1] + theta * (d[2] + theta * d[3])));
        }
        State result = stepped(begin_, length_, weight, rates(method_.stages));
        normalise(result);
        return result;
    }

    bool evaluate(const MarchSettings& settings, double time, const State& y, State& rate)
    {
        ++pace.counts.evaluations;
        return rate_of_state(*swimmer_, settings.law, settings.water, time, y, work_, rate);
    }

    // Tries a step of `length` [s] into `trial_`. error: relative to the tolerance.
    Status attempt(const MarchSettings& settings, double start, double length, double& error)
    {
        const std::size_t last = method_.stages - 1;
        error = std::numeric_limits<double>::infinity();
        if (begin_anew_) {
            if (!evaluate(settings, start, end_, rate_[0])) return Status::singular;
            adams_.begin(rate_[0]);
            begin_anew_ = false;
        }
        for (std::size_t stage = method_.adams > 0 ? last : 1; stage <= last; ++stage) {
            trial_ =
                method_.adams > 0 ? adams_.step(length, end_) : stepped(end_, length, method_.a[stage], rates(stage));
            if (stage == last) normalise(trial_);
            if (!evaluate(settings, start + method_.c[stage] * length, trial_, rate_[stage])) return Status::singular;
        }
        State defect{};
        if (method_.adams > 0) {
            for (std::size_t k = 0; k < state_space; ++k) rate_[1][k] = (trial_[k] - end_[k]) / length;
            defect = adams_.defect(adams_.terms(), rate_[last]);
        } else {
            defect = weighted_sum(method_.error, rates(method_.stages));
        }
        double sum = 0.0;
        for (std::size_t k = 0; k < state_space; ++k) sum += std::abs(trial_[k]) + std::abs(rate_[last][k]);
        if (!(sum < 1e300)) return Status::not_finite;  // NaN too
        error = method_.adaptive ? error_by_tolerance(settings.bounds, pace.scale, trial_, defect, length) : 0.0;
        return Status::marched;
    }

    Status take_step(const MarchSettings& settings, double tiny)
    {
        const StepBounds& bounds = settings.bounds;
        const double start = end_time();
        const Span span(settings.breakpoints, start + tiny);
        const bool first_of_span = anew_;
        begin_anew_ = anew_;
        if (!anew_) rate_[0] = rate_[method_.stages - 1];  // the last rate of a step is the first of the next
        const bool adams = method_.adams > 0;
        double asked = pace.proposed, error = 0.0;
        double length = time_step_size(method_.adaptive, adams, bounds, asked, start, span, tiny);
        const double accepted = adams ? accepted_of_adams : 1.0;
        for (;;) {
            const Status status = attempt(settings, start, length, error);
            if (status == Status::marched && error <= accepted) break;
            pace.shorten(status, error, method_.order, length);
            asked = length;
            if (!method_.adaptive || length < bounds.smallest) {
                anew_ = true;
                return status == Status::marched ? Status::step_too_small : status;
            }
        }
        pace.propose(bounds, length, asked, growth(bounds, length, error));
        if (adams) adams_.accept(length, rate_[method_.stages - 1]);
        if (std::abs(start + length - span.next) <= tiny) length = span.next - start;
        accept(settings, start, length);
        return settings.ledger ? find_step_powers(settings, first_of_span) : Status::marched;
    }

    // Allowed growth of the next step.
    double growth(const StepBounds& bounds, double length, double error)
    {
        if (method_.adams == 0) return growth_factor(error, method_.order);
        const bool steps_are_short = length <= Adams::is_short * bounds.longest;
        const auto promised = [&](std::size_t terms) {
            const State defect = adams_.defect(terms, rate_[method_.stages - 1]);
            return growth_factor(error_by_tolerance(bounds, pace.scale, trial_, defect, length),
                                 static_cast<double>(terms + 1));
        };
        const double here = growth_factor(error, static_cast<double>(adams_.order() + 1));
        const double below = steps_are_short && adams_.may_fall() ? promised(adams_.terms() - 1) : 0.0;
        const double above = steps_are_short && adams_.may_rise() ? promised(adams_.terms() + 1) : 0.0;
        return adams_.choose_order(steps_are_short, here, below, above);
    }

    void accept(const MarchSettings& settings, double start, double length)
    {
        if (settings.ledger) {
            works_ = powers_.works_until(works_, length_, 1.0);
            powers_.at[0] = powers_.at[3];
        }
        begin_ = end_, end_ = trial_;
        start_ = start, length_ = length, anew_ = false;
        pace.accept(settings.bounds, length, end_);
    }

    Status find_step_powers(const MarchSettings& settings, bool at_start_too)
    {
        for (std::size_t j = 4; j-- > (at_start_too ? 0u : 1u);) {
            if (j < 3) {  // the step's end was evaluated last
                const double time = start_ + lobatto[j] * length_;
                if (!find_motion(*swimmer_, settings.law, settings.water, time, interpolated(lobatto[j]), work_))
                    return Status::singular;
            }
            powers_.at[j] = find_powers(*swimmer_, settings.law, work_);
        }
        return Status::marched;
    }

    static constexpr std::int64_t evaluations_of_powers = 4;  // cost of the powers of a step, in evaluations

    const Swimmer* swimmer_;
    Method method_;
    Adams adams_;
    Workspace<M> work_;
    double start_ = 0.0, length_ = 0.0;  // [s]
    State begin_{}, end_{}, trial_{};
    std::array<State, Method::most_stages> rate_{};
    WorkDone works_{};  // at the start of the step
    StepPowers powers_;
    bool anew_ = true;  // rate and powers at the start of the next step are unknown
    bool begin_anew_ = true;
};

}  // namespace eel_core
