// SPDX-License-Identifier: Apache-2.0
// A swimmer on its way: its state, what drives it, the steps it takes, and what is seen of it.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "eel_core/march/observe.hpp"
#include "eel_core/steppers/stepper.hpp"

namespace eel_core {

using HeadMotion = std::array<double, 13>;  // see `March::head`

// A copy goes on by itself: state, steps and work space are its own; swimmer and law, which never change, are shared.
class March {
  public:
    March(std::shared_ptr<const Swimmer> swimmer, const Method& method, bool planar)
        : swimmer_(std::move(swimmer)), stepper_(made(*swimmer_, method, planar)), here_(*swimmer_)
    {
        state_[6] = 1.0;
    }

    double time() const { return time_; }
    const State& state() const { return state_; }
    const WorkDone& works() const { return works_; }
    Counts counts() const
    {
        return std::visit([](const auto& stepper) { return stepper.counts(); }, stepper_);
    }
    const Swimmer& swimmer() const { return *swimmer_; }
    // Bytes that an evaluation reads and writes: work space, weights of the integral, rows of the law.
    std::size_t memory() const
    {
        const std::size_t work = std::visit([](const auto& stepper) { return stepper.work().bytes(); }, stepper_);
        const LawTables& law = *settings_.law.tables;
        return work + swimmer_->grid.from_nose.bytes() +
               (law.node.lanes.size() + law.angle.lanes.size() + 3 * law.moments.lanes.size()) * sizeof(Lanes);
    }

    // Goes on in another grid or by another method; the next step begins anew. The state keeps its momentum.
    void change(std::shared_ptr<const Swimmer> swimmer, const Method& method, bool planar)
    {
        Steppers next = made(*swimmer, method, planar);
        std::visit([&](auto& stepper) { std::visit([&](const auto& last) { stepper.take_over(last); }, stepper_); },
                   next);
        stepper_ = std::move(next);
        swimmer_ = std::move(swimmer);
        here_ = StationWork(*swimmer_);
        observing_.reset();
        begin();
    }

    // What drives the body from now on. The next step begins anew, unless the motion goes on as before (`smoothly`).
    void follow(MarchSettings settings, bool smoothly)
    {
        settings_ = std::move(settings);
        if (!smoothly) begin();
    }

    // Stands at the start, at time 0, with the momentum of the head's twist relative to the water. Returns the
    // kinetic and potential energy [J].
    double start(const Vector3<double>& position, const Quaternion<double>& orientation,
                 const Twist<Space, double>& twist)
    {
        time_ = 0.0, works_ = {}, state_ = {};
        for (const FinServo& servo : swimmer_->servos)
            if (servo.time_constant > 0.0) state_[servo.slot] = servo.initial;
        const double energy = set_state(position, orientation, twist);
        std::visit([&](auto& stepper) { stepper.forget(state_, settings_.bounds.spare_steps); }, stepper_);
        begin();
        return energy;
    }

    // The head's twist relative to the water, in the present state. Throws where the inertia is not positive definite.
    Twist<Space, double> twist()
    {
        Workspace<Space>& work = workspace();
        if (!find_head_motion(*swimmer_, settings_.law, settings_.water, time_, state_, work))
            throw std::domain_error("inertia is not positive definite");
        return work.twist;
    }

    // Time [s] and place [m] in the world outside the grid of the flow, where the last evaluation was there.
    std::optional<std::array<double, 4>> outside() const
    {
        const auto found = std::visit([](const auto& stepper) { return stepper.work().flow.outside(); }, stepper_);
        if (found) return found;
        return observing_ && observing_->flow.outside() ? observing_->flow.outside() : here_.flow.outside();
    }

    // Position [m], orientation x y z w and twist over ground [rad/s, m/s] of the head in the present state; none where
    // the inertia is not positive definite.
    std::optional<HeadMotion> head()
    {
        Workspace<Space>& work = workspace();
        if (!find_head_motion(*swimmer_, settings_.law, settings_.water, time_, state_, work)) return {};
        HeadMotion head;
        std::copy_n(state_.begin(), 7, head.begin());
        put(work.twist.angular, head.data() + 7);
        put(work.twist.linear + work.head.local(settings_.water.current), head.data() + 10);
        return head;
    }

    // Puts the head of the present shape elsewhere, with the momentum of its twist relative to the water. Returns the
    // kinetic and potential energy [J].
    double set_state(const Vector3<double>& position, const Quaternion<double>& orientation,
                     const Twist<Space, double>& twist)
    {
        State next{position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w};
        std::copy(state_.begin() + state_size, state_.end(), next.begin() + state_size);  // of the fins
        state_ = next;
        return set_twist(twist);
    }

    // Gives the present state the momentum of the head's twist. Returns the kinetic and potential
    // energy [J].
    double set_twist(const Twist<Space, double>& twist)
    {
        Workspace<Space>& work = workspace();
        configure(*swimmer_, settings_.law, time_, work);
        work.head = head_frame(state_, Space());
        set_flow(*swimmer_, settings_.water, time_, Vector3{state_[0], state_[1], state_[2]}, work);
        if (!work.fins.empty()) place_fins(*swimmer_, settings_.law, settings_.water, time_, state_, work);
        put_momentum(momentum_of(*swimmer_, twist, work), work.head, state_);
        set_velocities(*swimmer_, twist, work);
        if (work.flowing) set_flow_load(*swimmer_, work);
        if (swimmer_->weighs()) set_weight(*swimmer_, height_in(settings_.water, time_, state_), work);
        begin();
        const auto [body, water, potential] = energies_of(*swimmer_, work);
        return body + water + potential;
    }

    // Nodes that are evaluated before a march comes back unfinished.
    void set_slice(std::int64_t nodes) { slice_ = nodes; }

    // Marches to `time` [s]. Unless it gets there, the present is the end of the last step (unfinished), or unchanged.
    Status advance(double time)
    {
        Slice slice{slice_};
        return advance(time, slice);
    }

    // Marches through the instants [s], from number `first` on and up to `until` [s], and observes each. `done`: how
    // many are complete.
    Status record(std::span<const double> times, std::size_t first, double until, const Profiles& profiles,
                  double* whole, double* works, std::size_t& done)
    {
        Slice slice{slice_};
        const Observer observer(*swimmer_, profiles, whole);
        for (done = first; done < times.size() && times[done] <= until; ++done) {
            const Status status = slice.used_up() ? Status::unfinished : advance(times[done], slice);
            if (status != Status::marched) return status;
            if (!observe(observer, done)) return Status::singular;
            std::copy(works_.begin(), works_.end(), works + works_.size() * done);
            slice.spend(4 * (swimmer_->grid.nodes + swimmer_->stations));
        }
        return Status::marched;
    }

    // Fills the `sample` with what the present shows. False where the inertia is not positive definite.
    bool observe(const Observer& observer, std::size_t sample)
    {
        return observer.observe(settings_.law, settings_.water, time_, state_, sample, workspace(), here_);
    }

  private:
    using Steppers = std::variant<Stepper<Space>, Stepper<Plane>>;

    static Steppers made(const Swimmer& swimmer, const Method& method, bool planar)
    {
        if (planar) return Stepper<Plane>(swimmer, method);
        return Stepper<Space>(swimmer, method);
    }

    void begin()
    {
        const double first_length = first_step * settings_.bounds.longest;
        std::visit([&](auto& stepper) { stepper.begin(time_, state_, works_, first_length); }, stepper_);
    }

    Status advance(double time, Slice& slice)
    {
        try {
            return march_to(time, slice);
        } catch (...) {  // of a flow that is a function
            begin();
            throw;
        }
    }

    Status march_to(double time, Slice& slice)
    {
        return std::visit(
            [&](auto& stepper) {
                const Status status = stepper.march(settings_, time, slice);
                if (status != Status::marched && status != Status::unfinished) {
                    begin();
                    return status;
                }
                time_ = status == Status::marched ? time : std::max(time_, stepper.end_time());
                stepper.state_at(time_, settings_.ledger, state_, works_);
                return status;
            },
            stepper_);
    }

    // Of space, for what is observed: the stepper's own, unless that is for the plane.
    Workspace<Space>& workspace()
    {
        if (auto* const stepper = std::get_if<Stepper<Space>>(&stepper_)) return stepper->work();
        if (!observing_) observing_.emplace(*swimmer_);
        return *observing_;
    }

    static constexpr double first_step = 0.02;  // of the longest

    std::shared_ptr<const Swimmer> swimmer_;
    MarchSettings settings_;
    Steppers stepper_;
    StationWork here_;
    std::optional<Workspace<Space>> observing_;
    std::int64_t slice_ = Slice{}.left;
    double time_ = 0.0;  // [s]
    State state_{};
    WorkDone works_{};
};

}  // namespace eel_core
