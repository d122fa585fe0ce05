// SPDX-License-Identifier: Apache-2.0
// A swimmer on its way: its state, what drives it, the steps it takes, and what is seen of it.
#pragma once

#include "eel_core/march/marching.hpp"

namespace eel_core {

using HeadMotion = std::array<double, 13>;  // see `March::head`

// A copy goes on by itself: state, steps and work space are its own; swimmer and law, which never change, are shared.
class March : public Marching<March, Stepper> {
  public:
    March(const std::shared_ptr<const Swimmer>& swimmer, const Method& method, bool planar)
        : Marching(swimmer, made(*swimmer, method, planar))
    {
    }

    const WorkDone& works() const { return works_; }
    // Bytes that an evaluation reads and writes: work space, weights of the integral, rows of the law.
    std::size_t memory() const
    {
        const std::size_t work = std::visit([](const auto& stepper) { return stepper.work().bytes(); }, stepper_);
        const LawTables& law = *settings_.law.tables;
        return work + swimmer_->grid.from_nose.bytes() +
               (law.node.lanes.size() + law.angle.lanes.size() + 3 * law.moments.lanes.size()) * sizeof(Lanes);
    }

    // Goes on in another grid or by another method; the next step begins anew. The state keeps its momentum.
    void change(const std::shared_ptr<const Swimmer>& swimmer, const Method& method, bool planar)
    {
        Marching::change(swimmer, made(*swimmer, method, planar));
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
        stand_at_start(), works_ = {};
        const double energy = set_state(position, orientation, twist);
        std::visit([&](auto& stepper) { stepper.forget(state_, settings_.bounds.spare_steps); }, stepper_);
        begin();
        return energy;
    }

    // Position [m], orientation x y z w and twist over ground [rad/s, m/s] of the head in the present state; none where
    // the inertia is not positive definite.
    std::optional<HeadMotion> head()
    {
        std::optional<Twist<Space, double>> twist = std::visit(
            [&](const auto& stepper) -> std::optional<Twist<Space, double>> {
                const auto found = stepper.twist_at_end(time_);
                if (!found) return {};
                return in_space(*found);
            },
            stepper_);
        if (!twist) {
            if (!find_head()) return {};
            twist = workspace().twist;
        }
        HeadMotion head;
        std::copy_n(state_.begin(), 7, head.begin());
        put(twist->angular, head.data() + 7);
        put(twist->linear + head_frame(state_, Space()).local(settings_.water.current), head.data() + 10);
        return head;
    }

    // Puts the head of the present shape elsewhere, with the momentum of its twist relative to the water. Returns the
    // kinetic and potential energy [J].
    double set_state(const Vector3<double>& position, const Quaternion<double>& orientation,
                     const Twist<Space, double>& twist)
    {
        put_pose(position, orientation);
        return set_twist(twist);
    }

    // Gives the present state the momentum of the head's twist. Returns the kinetic and potential
    // energy [J].
    double set_twist(const Twist<Space, double>& twist)
    {
        const double energy = put_twist(twist);
        begin();
        return energy;
    }

    using Marching::advance;

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
    friend Marching;

    const LawOnGrid& law_on_grid(Workspace<Space>&) const { return settings_.law; }
    const Water& water() const { return settings_.water; }

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

    void begin_later() { begin(); }

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

    MarchSettings settings_;
    WorkDone works_{};
};

}  // namespace eel_core
