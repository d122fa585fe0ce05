// SPDX-License-Identifier: Apache-2.0
// What all swimmers on their way share: state, work space, and the head's motion.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "eel_core/march/observe.hpp"
#include "eel_core/steppers/stepper.hpp"

namespace eel_core {

// By steppers of a kind, in space and in the plane, which have a `work` space and `counts`. `Own` derives from it, and
// has `law_on_grid()` and `water()`.
template <class Own, template <class> class StepperOf>
class Marching {
  public:
    using Steppers = std::variant<StepperOf<Space>, StepperOf<Plane>>;

    double time() const { return time_; }
    const State& state() const { return state_; }
    Counts counts() const
    {
        return std::visit([](const auto& stepper) { return stepper.counts(); }, stepper_);
    }
    const Swimmer& swimmer() const { return *swimmer_; }

    // Sets the nodes that are evaluated before a march comes back unfinished; returns what they were.
    std::int64_t set_slice(std::int64_t nodes) { return std::exchange(slice_, nodes); }

    // The head's twist relative to the water, in the present state. Throws where the inertia is not positive definite.
    Twist<Space, double> twist()
    {
        if (!find_head()) throw std::domain_error("inertia is not positive definite");
        return workspace().twist;
    }

    // Time [s] and place [m] in the world outside the grid of the flow, where the last evaluation was there.
    std::optional<std::array<double, 4>> outside() const
    {
        const auto found = std::visit([](const auto& stepper) { return stepper.work().flow.outside(); }, stepper_);
        if (found) return found;
        return observing_ && observing_->flow.outside() ? observing_->flow.outside() : here_.flow.outside();
    }

    // Marches to `time` [s]. Unless it gets there, the present is the end of the last step (unfinished), or unchanged.
    Status advance(double time)
    {
        Slice slice{slice_};
        return advance(time, slice);
    }

  protected:
    Marching(std::shared_ptr<const Swimmer> swimmer, Steppers stepper)  // NOLINT(bugprone-crtp*): `Own` alone
        : swimmer_(std::move(swimmer)), stepper_(std::move(stepper)), here_(*swimmer_)
    {
        state_[6] = 1.0;
    }

    // Goes on by another stepper.
    void change(std::shared_ptr<const Swimmer> swimmer, Steppers next)
    {
        std::visit([&](auto& stepper) { std::visit([&](const auto& last) { stepper.take_over(last); }, stepper_); },
                   next);
        stepper_ = std::move(next);
        swimmer_ = std::move(swimmer);
        here_ = StationWork(*swimmer_);
        observing_.reset();
    }

    // Of space, for what is observed: the stepper's own, unless that is for the plane.
    Workspace<Space>& workspace()
    {
        if (auto* const stepper = std::get_if<StepperOf<Space>>(&stepper_)) return stepper->work();
        if (!observing_) observing_.emplace(*swimmer_);
        return *observing_;
    }

    // Finds shape and head's twist of the present state. False where the inertia is not positive definite.
    bool find_head()
    {
        Workspace<Space>& work = workspace();
        return find_head_motion(*swimmer_, own().law_on_grid(work), own().water(), time_, state_, work);
    }

    // At time 0, with the fins' first angles.
    void stand_at_start()
    {
        time_ = 0.0, state_ = {};
        for (const FinServo& servo : swimmer_->servos)
            if (servo.time_constant > 0.0) state_[servo.slot] = servo.initial;
    }
    // Puts the head elsewhere; its momentum and the angles of the fins stay.
    void put_pose(const Vector3<double>& position, const Quaternion<double>& orientation)
    {
        State next{position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w};
        std::copy(state_.begin() + state_size, state_.end(), next.begin() + state_size);
        state_ = next;
    }
    // Gives the present state the momentum of the head's twist. Returns the kinetic and potential energy [J].
    double put_twist(const Twist<Space, double>& twist)
    {
        Workspace<Space>& work = workspace();
        const LawOnGrid& law = own().law_on_grid(work);
        const Water& water = own().water();
        configure(*swimmer_, law, time_, work);
        work.head = head_frame(state_, Space());
        set_flow(*swimmer_, water, time_, Vector3{state_[0], state_[1], state_[2]}, work);
        if (!work.fins.empty()) place_fins(*swimmer_, law, water, time_, state_, work);
        put_momentum(momentum_of(*swimmer_, twist, work), work.head, state_);
        set_velocities(*swimmer_, twist, work);
        if (work.flowing) set_flow_load(*swimmer_, work);
        if (swimmer_->weighs()) set_weight(*swimmer_, height_in(water, time_, state_), work);
        const auto [body, fluid, potential] = energies_of(*swimmer_, work);
        return body + fluid + potential;
    }

    Status advance(double time, Slice& slice)
    {
        try {
            return own().march_to(time, slice);
        } catch (...) {  // of a flow or a torque that is a function
            own().begin_later();
            throw;
        }
    }

    static constexpr double first_step = 0.02;  // of the longest

    std::shared_ptr<const Swimmer> swimmer_;
    Steppers stepper_;
    StationWork here_;
    std::optional<Workspace<Space>> observing_;
    std::int64_t slice_ = Slice{}.left;
    double time_ = 0.0;  // [s]
    State state_{};

  private:
    Own& own() { return static_cast<Own&>(*this); }
};

}  // namespace eel_core
