// SPDX-License-Identifier: Apache-2.0
// A swimmer with modes on its way: as `March`, with the coordinates, their rates, and what drives them besides.
#pragma once

#include <numeric>

#include "eel_core/bending/rosenbrock.hpp"
#include "eel_core/march/marching.hpp"

namespace eel_core {

// Where the numbers of an instant's coordinates lie: in one row of doubles. Energies and works are in J, powers in W;
// the moment of a mode is the integral of B . C.
struct CoordinateRow {
    // clang-format off
    enum Quantity : std::size_t {
        x, rate, acceleration, moment, torque, pushing, elastic, rotors, motor_power, damping_power, damping_work, quantities
    };
    static constexpr std::array<const char*, quantities> names{
        "x", "rate", "acceleration", "moment", "torque", "pushing", "elastic", "rotors", "motor_power", "damping_power",
        "damping_work"};
    // clang-format on
    std::array<std::size_t, quantities + 1> begin{};  // of each quantity; the last: the size of the row

    explicit CoordinateRow(const Modes& modes)
    {
        const std::size_t c = modes.coordinates;
        const std::array<std::size_t, quantities> count{c, c, c, modes.modes, modes.servos.size(), c, 1, 1, 1, 1, 1};
        std::partial_sum(count.begin(), count.end(), begin.begin() + 1);
    }
    std::size_t size() const { return begin.back(); }
};

class BentMarch : public Marching<BentMarch, BentStepper> {
  public:
    BentMarch(const std::shared_ptr<const Swimmer>& swimmer, std::shared_ptr<const Modes> modes, bool planar)
        : Marching(swimmer, made(*swimmer, *modes, planar)),
          modes_(std::move(modes)),
          x_(modes_->coordinates),
          rate_(modes_->coordinates)
    {
    }

    const std::vector<double>& coordinates() const { return x_; }
    const std::vector<double>& rates() const { return rate_; }
    const BentPowers& works() const { return works_; }
    const Modes& modes() const { return *modes_; }
    // As `March::memory`, without the law.
    std::size_t memory() const
    {
        const std::size_t work = std::visit([](const auto& stepper) { return stepper.body().bytes(); }, stepper_);
        return work + swimmer_->grid.from_nose.bytes();
    }
    CoordinateRow row() const { return CoordinateRow(*modes_); }

    // Goes on in another grid, with the same coordinates at the same rates; the next step begins anew.
    void change(const std::shared_ptr<const Swimmer>& swimmer, std::shared_ptr<const Modes> modes, bool planar)
    {
        Marching::change(swimmer, made(*swimmer, *modes, planar));
        modes_ = std::move(modes);
    }

    // As `March::follow`. Commands hold.
    void follow(BentSettings settings, bool smoothly)
    {
        if (!smoothly) end_step();
        settings.law.commands = std::move(settings_.law.commands);
        settings_ = std::move(settings);
        if (!smoothly) begin();
    }

    // Has a servo do so from now on, whatever the law; the next step begins anew.
    void command(std::size_t servo, Command::Kind kind, double value)
    {
        end_step();
        std::vector<Command>& commands = settings_.law.commands;
        commands.resize(modes_->servos.size());
        const Command& last = commands[servo];
        const bool by_angle = last.kind == Command::angle || last.kind == Command::rate;
        const double from = by_angle ? target_of(last, time_).reference[0] : x_[modes_->servos[servo].coordinate];
        commands[servo] = {kind, value, time_, from};
        begin_ = true;
    }

    // Stands at the start, at time 0, with these coordinates and rates and the momenta of the head's twist relative to
    // the water. Returns all energy [J].
    double start(const Vector3<double>& position, const Quaternion<double>& orientation,
                 const Twist<Space, double>& twist, std::vector<double> x, std::vector<double> rate)
    {
        stand_at_start(), works_ = {}, x_ = std::move(x), rate_ = std::move(rate);
        const double energy = set_state(position, orientation, twist);
        std::visit([&](auto& stepper) { stepper.forget(state_, settings_.bounds.spare_steps); }, stepper_);
        begin();
        return energy;
    }

    // Puts the head elsewhere, with the momenta of its twist relative to the water and the present rates of the
    // coordinates. Returns all energy [J].
    double set_state(const Vector3<double>& position, const Quaternion<double>& orientation,
                     const Twist<Space, double>& twist)
    {
        put_pose(position, orientation);
        return set_twist(twist);
    }
    double set_twist(const Twist<Space, double>& twist)
    {
        const double energy = put_twist(twist);
        begin();
        std::visit([&](auto& stepper) { find_instant(stepper); }, stepper_);
        return energy + elastic_ + rotors();
    }

    using Marching::advance;

    // As `March::record`; `rows`: the coordinates' of each instant.
    Status record(std::span<const double> times, std::size_t first, double until, const Profiles& profiles,
                  double* whole, double* works, double* rows, std::size_t& done)
    {
        Slice slice{slice_};
        for (done = first; done < times.size() && times[done] <= until; ++done) {
            const Status status = slice.used_up() ? Status::unfinished : advance(times[done], slice);
            if (status != Status::marched) return status;
            if (!observe(profiles, whole, done, rows + done * row().size())) return Status::singular;
            std::copy_n(works_.begin(), std::tuple_size_v<Powers>, works + std::tuple_size_v<Powers> * done);
            slice.spend(6 * (swimmer_->grid.nodes + swimmer_->stations));
        }
        return Status::marched;
    }

    // Fills the `sample` of `whole` and the coordinates' `numbers` with what the present shows. The body's kinetic
    // energy has the rotors', and the actuators are the motors and what imposes a change of shape. False where M is not
    // positive definite.
    bool observe(const Profiles& profiles, double* whole, std::size_t sample, double* numbers)
    {
        double actuators = 0.0;
        const bool found = std::visit([&](auto& stepper) { return show(stepper, numbers, actuators); }, stepper_);
        if (!found) return false;
        Workspace<Space>& work = workspace();
        set_shape(numbers + row().begin[CoordinateRow::acceleration], work);
        const Observer observer(*swimmer_, profiles, whole);
        if (!observer.observe(settings_.law.law, water(), time_, state_, sample, work, here_)) return false;
        profiles.at(whole, Profiles::energies, sample)[0] += rotors();
        profiles.at(whole, Profiles::powers, sample)[0] = actuators;
        return true;
    }

    // The coordinate that has asked for the last step's length.
    std::size_t hardest() const
    {
        return std::visit([](const auto& stepper) { return stepper.hardest(); }, stepper_);
    }
    // The first of the modes that make M singular in the present state; none where it is positive definite.
    std::optional<std::size_t> singular_mode()
    {
        return std::visit(
            [&](auto& stepper) -> std::optional<std::size_t> {
                using Body = std::decay_t<decltype(stepper.body())>;
                if (stepper.body().configure_at(settings_.law, settings_.water, time_, state_, x_.data())) return {};
                const std::size_t at = stepper.body().singular;
                return at < Body::head ? 0 : at - Body::head;
            },
            stepper_);
    }

  private:
    friend Marching;

    // With the factors of the present shape.
    const LawOnGrid& law_on_grid(Workspace<Space>& work) const
    {
        set_shape(nullptr, work);
        return settings_.law.law;
    }
    const Water& water() const { return settings_.water; }

    static Steppers made(const Swimmer& swimmer, const Modes& modes, bool planar)
    {
        if (planar) return BentStepper<Plane>(swimmer, modes);
        return BentStepper<Space>(swimmer, modes);
    }

    double rotors() const
    {
        double sum = 0.0;
        for (std::size_t i = 0; i < rate_.size(); ++i) sum += 0.5 * modes_->inertia[i] * rate_[i] * rate_[i];
        return sum;
    }

    // The modes' factors for the present coordinates and rates and these accelerations; none: zero.
    void set_shape(const double* acceleration, Workspace<Space>& work) const
    {
        work.factor.resize(settings_.law.law.tables->rows());
        for (std::size_t m = 0; m < modes_->modes; ++m)
            work.factor[settings_.law.first_mode + m] = {x_[m], rate_[m], acceleration ? acceleration[m] : 0.0};
    }

    // Configures the stepper's body in the present state and finds its loads and forces.
    bool find_instant(auto& stepper)
    {
        auto& body = stepper.body();
        if (!body.configure_at(settings_.law, settings_.water, time_, state_, x_.data())) return false;
        body.move_by_rates(rate_.data(), x_.data());
        elastic_ = body.forces.elastic;
        return true;
    }

    bool show(auto& stepper, double* numbers, double& actuators)
    {
        if (!find_instant(stepper)) return false;
        auto& body = stepper.body();
        body.find_rates(settings_.law, settings_.water.current, state_);
        body.find_accelerations_and_drift(settings_.law);
        actuators = body.powers()[0];
        using Of = CoordinateRow;
        const auto at = row().begin;
        std::ranges::copy(x_, numbers + at[Of::x]);
        std::ranges::copy(rate_, numbers + at[Of::rate]);
        std::ranges::copy(body.acceleration, numbers + at[Of::acceleration]);
        for (std::size_t m = 0; m < modes_->modes; ++m)
            numbers[at[Of::moment] + m] = body.forces.total[m] + modes_->inertia[m] * body.acceleration[m];
        std::ranges::copy(body.forces.torque, numbers + at[Of::torque]);
        std::ranges::copy(body.forces.pushing, numbers + at[Of::pushing]);
        numbers[at[Of::elastic]] = elastic_, numbers[at[Of::rotors]] = rotors();
        numbers[at[Of::motor_power]] = body.forces.motor_power;
        numbers[at[Of::damping_power]] = body.forces.damping_power;
        numbers[at[Of::damping_work]] = works_.back();
        return true;
    }

    // The next step begins in the present state.
    void begin()
    {
        begin_ = false;
        const double first_length = first_step * settings_.bounds.longest;
        std::visit(
            [&](auto& stepper) {
                BentState y{state_, std::vector<double>(x_.size()), x_};
                if (stepper.body().configure_at(settings_.law, settings_.water, time_, state_, x_.data())) {
                    stepper.body().move_by_rates(rate_.data(), x_.data());
                    stepper.body().momenta_of(stepper.body().work.twist, rate_.data(), y.momentum.data());
                }
                stepper.begin(time_, y, works_, first_length);
            },
            stepper_);
    }

    void begin_later() { begin_ = true; }

    // Has the last step end at present, where something is about to change.
    void end_step()
    {
        if (begin_) return;
        begin_ = true;  // also where this fails
        std::visit(
            [&](auto& stepper) {
                if (stepper.end_at(settings_, time_)) stepper.state_at(time_, state_, x_, rate_, works_);
            },
            stepper_);
    }

    Status march_to(double time, Slice& slice)
    {
        if (begin_) begin();
        return std::visit(
            [&](auto& stepper) {
                const Status status = stepper.march(settings_, time, slice);
                if (status != Status::marched && status != Status::unfinished) {
                    begin();
                    return status;
                }
                time_ = status == Status::marched ? time : std::max(time_, stepper.end_time());
                stepper.state_at(time_, state_, x_, rate_, works_);
                return status;
            },
            stepper_);
    }

    std::shared_ptr<const Modes> modes_;
    BentSettings settings_;
    bool begin_ = false;  // is due
    std::vector<double> x_, rate_;
    double elastic_ = 0.0;  // [J], when last found
    BentPowers works_{};
};

}  // namespace eel_core
