// SPDX-License-Identifier: Apache-2.0
// The steps of a march, in space or in the plane: of a body whose shape is imposed, or of one with modes.
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "eel_core/bending/rosenbrock.hpp"
#include "eel_core/steppers/stepper.hpp"

namespace eel_core {

class Steps {
  public:
    // modes: none for an imposed shape. With modes the steps have their own method.
    Steps(const Swimmer& swimmer, const Method& method, bool planar, const Modes* modes)
        : swimmer_(&swimmer), stepper_(made(swimmer, method, planar, modes))
    {
    }

    // Continues the march of `last`, which has another swimmer or another method.
    void take_over(Steps& last) { pace() = last.pace(); }

    // Archives the state that the next steps and the present depend on (`march/archive.hpp`).
    template <class Archive>
    void pass(Archive& archive)
    {
        archive.same(stepper_.index());
        std::visit([&](auto& stepper) { stepper.pass(archive); }, stepper_);
        archive(due_);
    }

    Counts counts() const
    {
        return std::visit([](const auto& stepper) { return stepper.pace.counts; }, stepper_);
    }
    // Time [s] and place [m] in the world outside the grid of the flow, where the last evaluation was there.
    std::optional<std::array<double, 4>> outside() const
    {
        const auto found = std::visit([](const auto& stepper) { return stepper.work().flow.outside(); }, stepper_);
        return found || !observing_ ? found : observing_->flow.outside();
    }
    // Work space for observations: the stepper's own, unless that is for the plane.
    Workspace<Space>& work()
    {
        if (auto* const imposed = std::get_if<Stepper<Space>>(&stepper_)) return imposed->work();
        if (auto* const bent = std::get_if<BentStepper<Space>>(&stepper_)) return bent->work();
        return observing_ ? *observing_ : observing_.emplace(*swimmer_);
    }
    // The result of `find` for the stepper of a body with modes; nothing without modes.
    template <class Result>
    Result of_modes(const auto& find)
    {
        return std::visit(
            [&](auto& stepper) -> Result {
                if constexpr (requires { stepper.body(); }) return find(stepper);
                return {};
            },
            stepper_);
    }

    // Clears the history: the first step begins at present.
    void forget(const StepBounds& bounds, const Present& now) { pace().forget(now.state, bounds); }
    // Lets the next step begin at present.
    void begin(const BentSettings& settings, const Present& now)
    {
        due_ = true;  // also if this fails
        std::visit([&](auto& stepper) { stepper.begin(settings, now); }, stepper_);
        due_ = false;
    }

    // Ends the last step of a body with modes at present, before something changes.
    void end(BentSettings& settings, Present& now)
    {
        if (std::exchange(due_, true)) return;
        of_modes<bool>([&](auto& stepper) {
            const bool ended = stepper.end_at(settings, now.time);
            if (ended) stepper.put_state(settings.ledger, now);
            return ended;
        });
    }

    // Marches to `time` [s]. Unless it gets there, the present is the end of the last step (unfinished), or unchanged.
    Status march(const BentSettings& settings, double time, Slice& slice, Present& now)
    {
        if (due_) begin(settings, now);
        due_ = true;  // also if a user's flow or torque function throws
        return std::visit(
            [&](auto& stepper) {
                const Status status = stepper.march(settings, time, slice);
                if (status != Status::marched && status != Status::unfinished) return status;
                now.time = status == Status::marched ? time : std::max(now.time, stepper.end_time());
                stepper.put_state(settings.ledger, now);
                due_ = false;
                return status;
            },
            stepper_);
    }

  private:
    using Steppers = std::variant<Stepper<Space>, Stepper<Plane>, BentStepper<Space>, BentStepper<Plane>>;

    Pace& pace()
    {
        return std::visit([](auto& stepper) -> Pace& { return stepper.pace; }, stepper_);
    }

    static Steppers made(const Swimmer& swimmer, const Method& method, bool planar, const Modes* modes)
    {
        if (modes && planar) return BentStepper<Plane>(swimmer, *modes);
        if (modes) return BentStepper<Space>(swimmer, *modes);
        if (planar) return Stepper<Plane>(swimmer, method);
        return Stepper<Space>(swimmer, method);
    }

    const Swimmer* swimmer_;
    Steppers stepper_;
    std::optional<Workspace<Space>> observing_;
    bool due_ = false;  // the next step is to begin at present
};

}  // namespace eel_core
