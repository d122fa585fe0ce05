// SPDX-License-Identifier: Apache-2.0
// Steps in time of a body with modes: ROS34PW2 of Rang and Angermann (BIT 45 (2005)), with dense output.
//
// It has order 3 for any Jacobian, is L-stable and stiffly accurate. The Jacobian contains the stiff terms: springs,
// dampers and servos' gains, with the mass matrix at the start of the step,
//
//     qdot <- du,  pidot <- - K dq - D du,  du from dpi by M.
//
// Its time column contains the motion of references, and the `drift` of qdot due to the change of M and of the imposed
// shape. Without these the order falls as the gain grows.
#pragma once

#include "eel_core/bending/balance.hpp"
#include "eel_core/steppers/stepper.hpp"

namespace eel_core {

struct BentState {
    State head{};
    std::vector<double> momentum, x;  // of the coordinates

    template <class Archive>
    void pass(Archive& archive)
    {
        archive(head, momentum, x);
    }
};

inline constexpr std::size_t bent_works = std::tuple_size_v<Powers> + 1;
using BentPowers = std::array<double, bent_works>;  // [W]: `Powers`, then the dampers' power

inline void add_scaled(double factor, const std::vector<double>& x, std::vector<double>& y)
{
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * x[i];
}

struct Ros34Pw2 {
    static constexpr std::size_t stages = 4;
    using Rows = std::array<std::array<double, stages>, stages>;
    static constexpr double diagonal = 0.435866521508459;
    static constexpr Rows alpha{{{}, {0.871733043016918}, {0.844570600153694, -0.112990642364842}, {0.0, 0.0, 1.0}}};
    static constexpr Rows gamma{{{},
                                 {-0.871733043016918},
                                 {-0.903380570130441, 0.0541806723880953},
                                 {0.242123807060953, -1.22325058390455, 0.545260255335102}}};
    static constexpr std::array<double, stages> weight{0.242123807060953, -1.22325058390455, 1.5452602553351,
                                                       0.435866521508459};
    static constexpr std::array<double, stages> embedded{0.378109031458194, -0.0960422922124232, 0.5,
                                                         0.217933260754230};
    static constexpr double sum(const Rows& rows, std::size_t i)
    {
        return rows[i][0] + rows[i][1] + rows[i][2] + rows[i][3];
    }
};

// A state with all known data at its time.
template <class M>
struct BentPoint {
    double time = 0.0;
    BentState y;
    State head_rate{};
    std::vector<double> momentum_rate, rate, drift, force;
    std::vector<double> stiffness, damping, in_time;  // derivatives of the forces
    std::vector<double> damping_but_stops;  // the stops' damping grows from zero, so that no acceleration jumps
    Frame<M, double> head{};                // axes of the head
    Definite mass;
    BentPowers powers{};

    template <class Archive>
    void pass(Archive& archive)
    {
        archive(time, y, head_rate, momentum_rate, rate, drift, force, stiffness, damping, in_time, damping_but_stops,
                this->head, mass, powers);
    }
};

template <class M>
class BentStepper {
    using Tableau = Ros34Pw2;

  public:
    BentStepper(const Swimmer& swimmer, const Modes& modes) : swimmer_(&swimmer), modes_(&modes), body_(swimmer, modes)
    {
        const std::size_t c = modes.coordinates;
        for (std::size_t i = 0; i < Tableau::stages; ++i)
            step_x_[i].resize(c), step_p_[i].resize(c), step_u_[i].resize(c);
        for (BentPoint<M>* point : {&before_, &here_})
            point->in_time.resize(c), point->y.momentum.resize(c), point->y.x.resize(c);
        trial_ = before_.y;
        scratch_.right.resize(M::freedoms + c);
        for (std::vector<double>* each : {&scratch_.bx, &scratch_.sum_x, &scratch_.sum_u, &scratch_.dx, &scratch_.du})
            each->resize(c);
    }

    Pace pace;

    BentBody<M>& body() { return body_; }
    Workspace<M>& work() { return body_.work; }
    const Workspace<M>& work() const { return body_.work; }
    std::size_t hardest() const { return hardest_; }  // coordinate with the greatest error in the last step
    double end_time() const { return here_.time; }

    void begin(const BentSettings& settings, const Present& now)
    {
        BentState y{now.state, std::vector<double>(now.x.size()), now.x};
        if (body_.find_present(settings, now)) body_.find_momenta(y.momentum.data());
        here_.time = before_.time = now.time, here_.y = y, works_ = with_dampers(now.works, now.damping_work);
        anew_ = true, known_ends_ = 0;
    }

    Status march(const BentSettings& settings, double until, Slice& slice)
    {
        if (anew_ && !find_point(settings, here_, false)) return Status::singular;
        return pace.march(
            until, 2 * swimmer_->grid.nodes, 0, slice, [this] { return end_time(); },
            [&](double tiny) { return take_step(settings, tiny); });
    }

    // Repeats the last step so that it ends at `time` [s] within it. Returns whether it did. States between the ends of
    // steps are less exact than the ends, and no motion should begin there.
    bool end_at(BentSettings& settings, double time)
    {
        const double tiny = 1e-12 * std::max(1.0, std::abs(time));
        if (anew_ || time < before_.time + tiny || time > here_.time - tiny) return false;
        std::swap(before_, here_);
        works_ = works_before_;
        std::rotate(ends_.begin(), ends_.begin() + 1, ends_.end());
        known_ends_ -= known_ends_ > 0 ? 1 : 0;
        const auto place = std::upper_bound(settings.breakpoints.begin(), settings.breakpoints.end(), time);
        const auto index = place - settings.breakpoints.begin();
        settings.breakpoints.insert(place, time);
        Slice all{std::numeric_limits<std::int64_t>::max()};
        const Status status = march(settings, time, all);
        settings.breakpoints.erase(settings.breakpoints.begin() + index);
        return status == Status::marched;
    }

    // Archives all data that determine the next steps and the present (`march/archive.hpp`).
    template <class Archive>
    void pass(Archive& archive)
    {
        archive(pace, before_, here_, ends_, known_ends_, damping_of_ends_, matrix_, works_, works_before_, middle_,
                hardest_, anew_);
    }

    // Sets state, coordinates, their rates and the works to the present time, which lies within the step.
    EEL_CORE_APART void put_state(bool, Present& now) const
    {
        const double length = here_.time - before_.time;
        BentPowers works = works_;
        if (std::abs(here_.time - now.time) <= 1e-12 * std::max(1.0, std::abs(now.time)) || length == 0.0) {
            now.state = here_.y.head, now.x = here_.y.x, now.rate = here_.rate;
        } else {
            const double theta = std::clamp((now.time - before_.time) / length, 0.0, 1.0);
            interpolate(theta, now.state, now.x, now.rate);
            double square = 0.0;  // with fused products, which round the same in every build
            for (std::size_t k = 3; k < 7; ++k) square = std::fma(now.state[k], now.state[k], square);
            for (std::size_t k = 3; k < 7; ++k) now.state[k] /= std::sqrt(square);
            for (std::size_t k = 0; k < bent_works; ++k)
                works[k] =
                    works_before_[k] + length * work_until(theta, before_.powers[k], middle_[k], here_.powers[k]);
        }
        std::copy_n(works.begin(), now.works.size(), now.works.begin());
        now.damping_work = works.back();
    }

  private:
    // Integral from 0 to theta of the parabola through powers at 0, 1/2 and 1.
    static double work_until(double theta, double a, double b, double c)
    {
        const double slope = 4.0 * b - 3.0 * a - c, bend = 2.0 * (a - 2.0 * b + c);
        return theta * (a + theta * (slope / 2.0 + theta * bend / 3.0));
    }

    // The orientation of `head` is not normalised.
    void interpolate(double theta, State& head, std::vector<double>& x, std::vector<double>& rate) const
    {
        const double length = here_.time - before_.time, left = 1.0 - theta;
        const double b1 = theta * theta * (3.0 - 2.0 * theta), r0 = length * theta * left * left,
                     r1 = -length * theta * theta * left;
        for (std::size_t k = 0; k < state_space; ++k)
            head[k] = before_.y.head[k] + b1 * (here_.y.head[k] - before_.y.head[k]) + r0 * before_.head_rate[k] +
                      r1 * here_.head_rate[k];
        // Between the ends, the derivative of this cubic is closer to the stiff rates than their values at the ends.
        const double slope = 6.0 * theta * left / length, s0 = left * (1.0 - 3.0 * theta),
                     s1 = theta * (3.0 * theta - 2.0);
        x.resize(modes_->coordinates), rate.resize(modes_->coordinates);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double change = here_.y.x[i] - before_.y.x[i], u0 = before_.rate[i], u1 = here_.rate[i];
            x[i] = before_.y.x[i] + b1 * change + r0 * u0 + r1 * u1;
            rate[i] = slope * change + s0 * u0 + s1 * u1;
        }
    }

    bool evaluate(const BentSettings& settings, double time, const BentState& y)
    {
        ++pace.counts.evaluations;
        if (!body_.configure_at(settings, time, y.head, y.x.data())) return false;
        body_.find_rates_of(y.momentum.data());
        body_.move(y.x.data());
        body_.find_rates(settings, y.head);
        return true;
    }

    static BentPowers with_dampers(const Powers& powers, double dampers)
    {
        BentPowers all;
        std::copy(powers.begin(), powers.end(), all.begin());
        all.back() = dampers;
        return all;
    }

    // Rates, accelerations and linear forces at a point of known time and state. smoothed: at the end of a step.
    bool find_point(const BentSettings& settings, BentPoint<M>& point, bool smoothed)
    {
        ++pace.counts.evaluations;
        if (!body_.configure_at(settings, point.time, point.y.head, point.y.x.data())) return false;
        body_.find_rates_of(point.y.momentum.data());
        if (smoothed && smooth_rates(point)) {
            body_.move_by_rates(body_.rate.data(), point.y.x.data());
            body_.find_momenta(point.y.momentum.data());
        } else {
            body_.move(point.y.x.data());
        }
        body_.find_rates(settings, point.y.head);
        body_.find_accelerations_and_drift(settings);
        point.head_rate = body_.head_rate, point.momentum_rate = body_.momentum_rate, point.rate = body_.rate;
        point.drift = body_.drift, point.head = body_.work.head;
        point.force = body_.forces.total;
        point.mass = body_.columns.mass;
        linearise(*modes_, body_.target, point.y.x.data(), point.rate.data(), point.stiffness, point.damping,
                  point.in_time);
        point.damping_but_stops = point.damping;
        linearise_stops(*modes_, point.y.x.data(), point.rate.data(), point.stiffness, point.damping);
        if (settings.ledger) point.powers = with_dampers(body_.powers(), body_.forces.damping_power);
        return true;
    }

    // With stiff dampers, the coordinates are more exact than their rates from the momenta, whose errors become torques
    // in the dampers. Then the rates come from the cubic through the last four ends of steps: the difference is
    // filtered by (M + g D + g^2 K)^-1 g D, which is small unless dampers are stiff. False without such ends.
    bool smooth_rates(const BentPoint<M>& point)
    {
        if (known_ends_ < 2 || before_.damping_but_stops != damping_of_ends_) return false;
        constexpr std::size_t head = M::freedoms;
        const std::size_t c = modes_->coordinates;
        const std::array<double, 4> time{ends_[1].time, ends_[0].time, before_.time, point.time};
        const std::array<const double*, 4> x{ends_[1].x.data(), ends_[0].x.data(), before_.y.x.data(),
                                             point.y.x.data()};
        std::array<double, 4> weight{};
        for (std::size_t j = 0; j < 3; ++j) {
            weight[3] += 1.0 / (time[3] - time[j]);
            weight[j] = 1.0 / (time[j] - time[3]);
            for (std::size_t k = 0; k < 3; ++k)
                if (k != j) weight[j] *= (time[3] - time[k]) / (time[j] - time[k]);
        }
        std::vector<double>& apart = scratch_.dx;
        for (std::size_t i = 0; i < c; ++i) {
            apart[i] = -body_.rate[i];
            for (std::size_t j = 0; j < 4; ++j) apart[i] += weight[j] * x[j][i];
        }
        filter(point.time - before_.time, before_.damping, apart, scratch_.right);
        for (std::size_t i = 0; i < c; ++i) body_.rate[i] += scratch_.right[head + i];
        return true;
    }

    // Sets `right` to (M + g D + g^2 K)^-1 g D x of the last step, for head and coordinates.
    void filter(double length, const std::vector<double>& damping, const std::vector<double>& x,
                std::vector<double>& right) const
    {
        constexpr std::size_t head = M::freedoms;
        std::fill(right.begin(), right.end(), 0.0);
        for (std::size_t i = 0; i < x.size(); ++i)
            for (std::size_t j = 0; j < x.size(); ++j)
                right[head + i] += Tableau::diagonal * length * damping[i * x.size() + j] * x[j];
        matrix_.solve(right.data());
    }

    // Adds the start of the last step to the past ends.
    void remember_end()
    {
        if (known_ends_ > 0 && before_.damping_but_stops != damping_of_ends_) known_ends_ = 0;
        damping_of_ends_ = before_.damping_but_stops;
        known_ends_ = std::min(known_ends_ + 1, ends_.size());
        std::rotate(ends_.begin(), ends_.end() - 1, ends_.end());
        ends_[0].time = before_.time, ends_[0].x = before_.y.x;
    }

    // Tries a step of `length` [s] into `trial_`. error: relative to the tolerance.
    Status attempt(const BentSettings& settings, double length, double& error)
    {
        constexpr std::size_t head = M::freedoms;
        const std::size_t c = modes_->coordinates, n = head + c;
        const double g = Tableau::diagonal * length;
        error = std::numeric_limits<double>::infinity();
        Definite& matrix = matrix_;
        matrix = here_.mass;
        for (std::size_t i = 0; i < c; ++i)
            for (std::size_t j = 0; j <= i; ++j)
                matrix.at(head + i, head + j) += g * (here_.damping[i * c + j] + g * here_.stiffness[i * c + j]);
        if (matrix.factor() != Definite::definite) return Status::singular;
        std::vector<double>&right = scratch_.right, &bx = scratch_.bx;
        std::vector<double>&sum_x = scratch_.sum_x, &sum_u = scratch_.sum_u;
        for (std::size_t stage = 0; stage < Tableau::stages; ++stage) {
            const State* head_rate = &here_.head_rate;
            const std::vector<double>*momentum_rate = &here_.momentum_rate, *rate = &here_.rate;
            if (stage > 0) {
                trial_ = here_.y;
                for (std::size_t j = 0; j < stage; ++j) add_step(Tableau::alpha[stage][j], j);
                if (!evaluate(settings, here_.time + Tableau::sum(Tableau::alpha, stage) * length, trial_))
                    return Status::singular;
                head_rate = &body_.head_rate, momentum_rate = &body_.momentum_rate, rate = &body_.rate;
            }
            const double g_time = length * length * (Tableau::diagonal + Tableau::sum(Tableau::gamma, stage));
            std::fill(sum_x.begin(), sum_x.end(), 0.0), std::fill(sum_u.begin(), sum_u.end(), 0.0);
            for (std::size_t j = 0; j < stage; ++j) {
                add_scaled(Tableau::gamma[stage][j], step_x_[j], sum_x);
                add_scaled(Tableau::gamma[stage][j], step_u_[j], sum_u);
            }
            const auto of_head = components_of(momentum_in_head(*head_rate, here_.head));
            for (std::size_t i = 0; i < head; ++i) right[i] = length * of_head[i];
            for (std::size_t i = 0; i < c; ++i) bx[i] = length * ((*rate)[i] + sum_u[i]) + g_time * here_.drift[i];
            for (std::size_t i = 0; i < c; ++i) {
                double stiff = 0.0, slow = here_.in_time[i];
                for (std::size_t j = 0; j < c; ++j) {
                    const double k = here_.stiffness[i * c + j], d = here_.damping[i * c + j];
                    stiff += length * (k * sum_x[j] + d * sum_u[j]) + g * k * bx[j];
                    slow -= d * here_.drift[j];
                }
                right[head + i] = length * (*momentum_rate)[i] + g_time * slow - stiff;
            }
            matrix.solve(right.data());
            for (std::size_t k = 0; k < state_space; ++k) step_head_[stage][k] = length * (*head_rate)[k];
            for (std::size_t i = 0; i < c; ++i) {
                step_u_[stage][i] = right[head + i];
                step_x_[stage][i] = bx[i] + g * right[head + i];
                double sum = 0.0;
                for (std::size_t j = 0; j < n; ++j) sum += here_.mass.at(head + i, j) * right[j];
                step_p_[stage][i] = sum;
            }
        }
        trial_ = here_.y;
        for (std::size_t j = 0; j < Tableau::stages; ++j) add_step(Tableau::weight[j], j);
        normalise(trial_.head);
        double sum = 0.0;
        for (const double value : trial_.head) sum += std::abs(value);
        for (std::size_t i = 0; i < c; ++i) sum += std::abs(trial_.x[i]) + std::abs(trial_.momentum[i]);
        if (!(sum < 1e300)) return Status::not_finite;  // NaN too
        error = error_of(settings, length);
        return Status::marched;
    }

    void add_step(double factor, std::size_t stage)
    {
        if (factor == 0.0) return;
        add_scaled(factor, step_head_[stage], trial_.head);
        add_scaled(factor, step_x_[stage], trial_.x);
        add_scaled(factor, step_p_[stage], trial_.momentum);
    }

    // The difference of the two results / the tolerance: for the head as elsewhere; for the coordinates as angles, and
    // as the torques of springs and dampers.
    double error_of(const BentSettings& settings, double length)
    {
        const std::size_t c = modes_->coordinates;
        std::array<double, Tableau::stages> weight;
        for (std::size_t j = 0; j < weight.size(); ++j) weight[j] = Tableau::weight[j] - Tableau::embedded[j];
        State defect{};
        std::vector<double>&dx = scratch_.dx, &du = scratch_.du, &smoothed = scratch_.right;
        std::fill(dx.begin(), dx.end(), 0.0), std::fill(du.begin(), du.end(), 0.0);
        for (std::size_t j = 0; j < weight.size(); ++j) {
            add_scaled(weight[j] / length, step_head_[j], defect);
            add_scaled(weight[j], step_x_[j], dx), add_scaled(weight[j], step_u_[j], du);
        }
        // For continuous parts, without the smoothing of the rates at the step's end: their high modes are stiff.
        filter(length, here_.damping, du, smoothed);
        for (std::size_t i = 0; i < modes_->modes; ++i)
            if (modes_->continuous[i]) du[i] -= smoothed[M::freedoms + i];
        double worst = 0.0;
        const double scale = std::max(pace.torque_scale, settings.bounds.torque_floor);
        for (std::size_t i = 0; i < c; ++i) {
            double torque = 0.0;
            for (std::size_t j = 0; j < c; ++j)
                torque += here_.stiffness[i * c + j] * dx[j] + here_.damping[i * c + j] * du[j];
            const bool mode = i < modes_->modes;
            const double here = std::max((mode ? modes_->span[i] : 1.0) * std::abs(dx[i]),
                                         (mode ? modes_->moment[i] : 1.0) * std::abs(torque) / scale);
            if (here > worst) worst = here, hardest_ = i;
        }
        return std::max(worst / settings.bounds.tolerance,
                        error_by_tolerance(settings.bounds, pace.scale, trial_.head, defect, length));
    }

    Status take_step(const BentSettings& settings, double tiny)
    {
        const bool fixed = std::isinf(settings.bounds.tolerance);
        constexpr double order = 3.0;
        const StepBounds& bounds = settings.bounds;
        const double start = here_.time;
        const Span span(settings.breakpoints, start + tiny);
        double asked = pace.proposed, length = time_step_size(!fixed, false, bounds, asked, start, span, tiny);
        double error = 0.0;
        pace.torque_scale = std::max(pace.torque_scale, greatest_torque(here_.force));
        for (;;) {
            Status status = attempt(settings, length, error);
            if (status == Status::marched && error <= 1.0) {
                std::swap(before_, here_);
                here_.time = std::abs(start + length - span.next) <= tiny ? span.next : start + length;
                here_.y = trial_;
                if (find_point(settings, here_, true)) break;
                std::swap(before_, here_), status = Status::singular;
            }
            pace.shorten(status, error, order, length);
            asked = length;
            if (fixed || length < bounds.smallest) {
                return status == Status::marched ? Status::step_too_small : status;
            }
        }
        pace.propose(bounds, length, asked, growth_factor(error, order));
        remember_end();
        anew_ = false;
        pace.accept(bounds, length, here_.y.head);
        works_before_ = works_;
        return settings.ledger ? add_works(settings) : Status::marched;
    }

    double greatest_torque(const std::vector<double>& force) const
    {
        double greatest = 0.0;
        for (std::size_t i = 0; i < force.size(); ++i)
            greatest = std::max(greatest, std::abs(force[i]) * (i < modes_->modes ? modes_->moment[i] : 1.0));
        return greatest;
    }

    // By Simpson's rule. Not inlined, so that its sums round the same for every caller.
    EEL_CORE_APART Status add_works(const BentSettings& settings)
    {
        const double length = here_.time - before_.time, time = before_.time + 0.5 * length;
        State head{};
        std::vector<double>&x = scratch_.middle_x, &rate = scratch_.middle_rate;
        interpolate(0.5, head, x, rate);
        normalise(head);
        ++pace.counts.evaluations;
        if (!body_.configure_at(settings, time, head, x.data())) return Status::singular;
        body_.move_by_rates(rate.data(), x.data());
        body_.find_rates(settings, head);
        body_.find_accelerations_and_drift(settings);
        middle_ = with_dampers(body_.powers(), body_.forces.damping_power);
        for (std::size_t k = 0; k < bent_works; ++k)
            works_[k] += length * work_until(1.0, before_.powers[k], middle_[k], here_.powers[k]);
        return Status::marched;
    }

    const Swimmer* swimmer_;
    const Modes* modes_;
    BentBody<M> body_;
    BentPoint<M> before_, here_;  // start and end of the last step
    BentState trial_;
    struct End {
        double time = 0.0;
        std::vector<double> x;

        template <class Archive>
        void pass(Archive& archive)
        {
            archive(time, x);
        }
    };
    std::array<End, 3> ends_;  // of the steps before the last one, the latest first
    std::size_t known_ends_ = 0;
    std::vector<double> damping_of_ends_;  // `damping_but_stops` at these ends
    Definite matrix_;                      // of the last step, factored
    std::array<State, Tableau::stages> step_head_{};
    std::array<std::vector<double>, Tableau::stages> step_x_, step_p_, step_u_;
    struct Scratch {                           // of a step: no allocation within a step
        std::vector<double> right;             // of the linear system, then its solution: head and coordinates
        std::vector<double> bx, sum_x, sum_u;  // coordinates: of a stage
        std::vector<double> dx, du;            // the difference of the two results
        std::vector<double> middle_x, middle_rate;
    } scratch_;
    BentPowers works_{}, works_before_{}, middle_{};  // at the end and the start of the step; powers at its middle
    std::size_t hardest_ = 0;
    bool anew_ = true;
};

}  // namespace eel_core
