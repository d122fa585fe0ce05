// SPDX-License-Identifier: Apache-2.0
// A marching swimmer: its state, its law and commands, its steps and its observations.
#pragma once

#include <memory>

#include "eel_core/bending/coordinate_row.hpp"
#include "eel_core/march/archive.hpp"
#include "eel_core/march/observe.hpp"
#include "eel_core/march/steps.hpp"

namespace eel_core {

using HeadMotion = std::array<double, 13>;  // see `March::head`

// A copy is independent: it has its own state, steps and work space; swimmer, modes and law, which never change, are
// shared.
class March {
  public:
    // `modes`: of a body with dynamic bending, whose steps have their own method; none: the shape is imposed.
    March(std::shared_ptr<const Swimmer> swimmer, const Method& method, bool planar,
          std::shared_ptr<const Modes> modes = {})
        : swimmer_(std::move(swimmer)),
          modes_(std::move(modes)),
          steps_(*swimmer_, method, planar, modes_.get()),
          here_(*swimmer_)
    {
        now_.state[6] = 1.0;
        if (modes_) now_.x.resize(modes_->coordinates), now_.rate.resize(modes_->coordinates);
    }

    const Present& now() const { return now_; }
    const Swimmer& swimmer() const { return *swimmer_; }
    const Modes* modes() const { return modes_.get(); }
    CoordinateRow row() const { return modes_ ? CoordinateRow(*modes_) : CoordinateRow(); }
    Counts counts() const { return steps_.counts(); }

    // Sets the number of nodes evaluated before a march returns unfinished; returns the old number.
    std::int64_t set_slice(std::int64_t nodes) { return std::exchange(slice_, nodes); }

    // Continues on another grid or by another method, with the same momentum of the head, and the same coordinates at
    // the same rates. Call `follow` next.
    void change(std::shared_ptr<const Swimmer> swimmer, const Method& method, bool planar,
                std::shared_ptr<const Modes> modes)
    {
        Steps next(*swimmer, method, planar, modes.get());
        next.take_over(steps_);
        steps_ = std::move(next), swimmer_ = std::move(swimmer), modes_ = std::move(modes);
        here_ = StationWork(*swimmer_);
    }

    const MarchSettings& settings() const { return settings_; }

    // Archives the state and the commands. Before reading, call `follow` (`march/archive.hpp`).
    template <class Archive>
    void pass(Archive& archive)
    {
        archive.same(sizeof(State)), archive.same(swimmer_->grid.nodes), archive.same(swimmer_->stations);
        archive.same(modes_ ? modes_->coordinates : 0), archive.same(modes_ ? modes_->servos.size() : 0);
        archive(now_.time, now_.state, now_.x, now_.rate, now_.works, now_.damping_work, settings_.commands);
        steps_.pass(archive);
    }

    // Sets law and actuators from now on; commands hold. The next step begins anew, unless the motion goes on as before
    // (`smoothly`).
    void follow(BentSettings settings, bool smoothly)
    {
        if (!smoothly) steps_.end(settings_, now_);
        settings.commands = std::move(settings_.commands);
        settings_ = std::move(settings);
        if (!smoothly) steps_.begin(settings_, now_);
    }

    // Commands a servo of a robot from now on, whatever the law; the next step begins anew.
    // A velocity moves the reference from where it is, or from the joint's angle where there is none.
    void command(std::size_t servo, Command command)
    {
        steps_.end(settings_, now_);
        std::vector<Command>& commands = settings_.commands;
        commands.resize(modes_->servos.size());
        if (command.kind == Command::velocity) {
            const Command& last = commands[servo];
            const bool by_angle = last.kind == Command::position || last.kind == Command::velocity;
            command.angle = std::clamp(
                by_angle ? target_of(last, now_.time).reference[0] : now_.x[modes_->servos[servo].coordinate],
                command.low, command.high);
        }
        command.since = now_.time;
        commands[servo] = command;
    }

    // Resets to time 0, with these coordinates and rates, the momenta of the head's twist relative to the
    // water, and the fins' first angles. Returns all energy [J].
    double start(const Vector3<double>& position, const Quaternion<double>& orientation,
                 const Twist<Space, double>& twist, std::vector<double> x = {}, std::vector<double> rate = {})
    {
        now_ = {0.0, {}, std::move(x), std::move(rate), {}, 0.0};
        for (const FinServo& servo : swimmer_->servos)
            if (servo.time_constant > 0.0) now_.state[servo.slot] = servo.initial;
        const double energy = set_state(position, orientation, twist);
        steps_.forget(settings_.bounds, now_);
        steps_.begin(settings_, now_);
        return energy;
    }

    // Puts the head elsewhere, with the momenta of its twist relative to the water; the shape, its rates and the angles
    // of the fins stay. Returns all energy [J].
    double set_state(const Vector3<double>& position, const Quaternion<double>& orientation,
                     const Twist<Space, double>& twist)
    {
        std::ranges::copy(
            std::array{position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w},
            now_.state.begin());
        return set_twist(twist);
    }

    // Gives the present state the momenta of the head's twist. Returns all energy [J].
    double set_twist(const Twist<Space, double>& twist)
    {
        Workspace<Space>& work = shaped();
        place_body(*swimmer_, settings_.law, settings_.water, now_.time, now_.state, work);
        put_momentum(momentum_of(*swimmer_, twist, work), work.head, now_.state);
        set_velocities(*swimmer_, twist, work);
        if (work.flowing) set_flow_load(*swimmer_, work);
        if (swimmer_->weighs()) set_weight(*swimmer_, height_in(settings_.water, now_.time, now_.state), work);
        const auto [body, fluid, potential] = energies_of(*swimmer_, work);
        const double energy = body + fluid + potential;
        steps_.begin(settings_, now_);
        if (!modes_) return energy;
        return steps_.of_modes<double>(
            [energy](auto& stepper) { return energy + stepper.body().forces.elastic + stepper.body().rotor_energy(); });
    }

    // The head's twist relative to the water, in the present state. Throws where the inertia is not positive definite.
    Twist<Space, double> twist()
    {
        if (!find_head()) throw std::domain_error("inertia is not positive definite");
        return steps_.work().twist;
    }

    // Position [m], orientation x y z w and twist over ground [rad/s, m/s] of the head in the present state; none where
    // the inertia is not positive definite.
    std::optional<HeadMotion> head()
    {
        if (!find_head()) return {};
        const Twist<Space, double>& twist = steps_.work().twist;
        HeadMotion head;
        std::copy_n(now_.state.begin(), 7, head.begin());
        put(twist.angular, head.data() + 7);
        put(twist.linear + head_frame(now_.state, Space()).local(settings_.water.current), head.data() + 10);
        return head;
    }

    // Time [s] and place [m] in the world outside the grid of the flow, where the last evaluation was there.
    std::optional<std::array<double, 4>> outside() const
    {
        const auto found = steps_.outside();
        return found ? found : here_.flow.outside();
    }

    // Marches to `time` [s]. Unless it gets there, the present is the end of the last step (unfinished), or unchanged.
    Status advance(double time)
    {
        Slice slice{slice_};
        return steps_.march(settings_, time, slice, now_);
    }

    // Marches through the instants [s], from number `first` on and up to `until` [s], and observes each. `done`: how
    // many are complete; `rows`: of the coordinates, one behind the other.
    Status record(std::span<const double> times, std::size_t first, double until, const Profiles& profiles,
                  double* whole, double* works, double* rows, std::size_t& done)
    {
        Slice slice{slice_};
        for (done = first; done < times.size() && times[done] <= until; ++done) {
            const Status status =
                slice.used_up() ? Status::unfinished : steps_.march(settings_, times[done], slice, now_);
            if (status != Status::marched) return status;
            if (!observe(profiles, whole, done, rows + done * row().size())) return Status::singular;
            std::ranges::copy(now_.works, works + now_.works.size() * done);
            slice.spend(4 * (swimmer_->grid.nodes + swimmer_->stations));
        }
        return Status::marched;
    }

    // Fills the `sample` of `whole` and the `row` of the coordinates with what the present shows. The kinetic energy of
    // a body with modes has the rotors', and its actuators are the motors and what imposes a change of shape. False
    // where the inertia is not positive definite.
    bool observe(const Profiles& profiles, double* whole, std::size_t sample, double* row)
    {
        const CoordinateRow places = this->row();
        double actuators = 0.0;
        const auto show = [&](auto& stepper) {
            if (!places.put(settings_, *modes_, now_, stepper.body(), row)) return false;
            actuators = stepper.body().powers()[0];
            return true;
        };
        if (modes_ && !steps_.of_modes<bool>(show)) return false;
        Workspace<Space>& work = shaped(row + places.begin[CoordinateRow::acceleration]);
        const Observer observer(*swimmer_, profiles, whole, sample);
        if (!observer.observe(settings_.law, settings_.water, now_.time, now_.state, work, here_)) return false;
        if (!modes_) return true;
        profiles.at(whole, Profiles::energies, sample)[0] += row[places.begin[CoordinateRow::rotors]];
        profiles.at(whole, Profiles::powers, sample)[0] = actuators;
        return true;
    }

    // Of a body with modes, the coordinate that has asked for the last step's length or, where the inertia is
    // `singular` in the present state, the first mode that makes it so.
    std::size_t to_blame(bool singular)
    {
        return steps_.of_modes<std::size_t>([&](auto& stepper) {
            const auto mode = singular ? stepper.body().singular_mode(settings_, now_) : std::nullopt;
            return mode.value_or(stepper.hardest());
        });
    }

  private:
    // Work space with the factors of the modes, for these accelerations; none: zero.
    Workspace<Space>& shaped(const double* acceleration = nullptr)
    {
        Workspace<Space>& work = steps_.work();
        if (modes_) set_factors(*modes_, settings_, now_, acceleration, work.factor);
        return work;
    }

    // Finds shape and head's twist of the present state. False where the inertia is not positive definite.
    bool find_head()
    {
        return find_head_motion(*swimmer_, settings_.law, settings_.water, now_.time, now_.state, shaped());
    }

    std::shared_ptr<const Swimmer> swimmer_;
    std::shared_ptr<const Modes> modes_;
    Steps steps_;
    StationWork here_;
    std::int64_t slice_ = Slice{}.left;
    Present now_;
    BentSettings settings_;
};

}  // namespace eel_core
