// SPDX-License-Identifier: Apache-2.0
// One instant of a body with modes: its motion, the rates of its momenta, and its accelerations.
//
// In addition to the head's state there is a momentum pi_m for each coordinate: (L, P', pi) = M (Omega, V, qdot) +
// momentum of the imposed change of shape. Its rate is
//
//     pidot_m = dT/dq_m + omega_m(l) . C_t + v_m(l) . N_t + integral (omega_m . c + v_m . n) dX - Q_m
//     dT/dq_m = - integral B_m . R^T (omega x S_C + v x S_N) dX
//
// with the momentum (S_C, S_N) of the part behind a section, about the section. The accelerations solve M a = h. In
// moving water, momenta belong to the motion through the water, the velocities in dT/dq_m are the true ones, and (c, n)
// has the additional terms (U x p, rho_f A a_u - g^T p). Fins act on their sections, as in fins.hpp.
#pragma once

#include <limits>
#include <optional>

#include "eel_core/bending/columns.hpp"

namespace eel_core {

template <class M>
class BentBody {
  public:
    static constexpr std::size_t head = M::freedoms;

    BentBody(const Swimmer& swimmer, const Modes& modes)
        : work(swimmer),
          columns(swimmer, modes),
          rate(modes.coordinates),
          acceleration(modes.coordinates),
          momentum_rate(modes.coordinates),
          drift(modes.coordinates),
          target(modes.servos.size()),
          swimmer_(&swimmer),
          modes_(&modes),
          load_(swimmer.grid.blocks),
          momentum_ahead_(swimmer.grid.blocks),
          mode_load_(modes.modes),
          added_(modes.modes),
          solution_(head + modes.coordinates),
          by_momenta_(head + modes.coordinates)
    {
        const std::size_t n = modes.coordinates;
        forces.total.resize(n), forces.pushing.resize(n), forces.torque.resize(modes.servos.size());
    }

    Workspace<M> work;
    Columns<M> columns;
    std::vector<double> rate, acceleration;  // of the coordinates
    std::vector<double> momentum_rate;       // pidot
    std::vector<double> drift;  // accelerations of the coordinates at constant momenta, from changes of M and b alone
    Forces forces;
    std::vector<Target> target;  // targets of the servos
    State head_rate{};           // of the head's part of the state

    // The shape at the coordinates x, and M. False if M is not positive definite.
    bool configure_at(const BentSettings& settings, double time, const State& y, const double* x)
    {
        law_ = &settings.law, time_ = time, state_ = y;
        work.factor.resize(settings.law.tables->rows());
        for (std::size_t m = 0; m < modes_->modes; ++m) work.factor[settings.first_mode + m] = {x[m], 0.0, 0.0};
        configure(*swimmer_, settings.law, time, work);
        set_targets(settings, work.factor, time, target);
        if (time != pushed_at_) {  // a stage ends with the step, and Python functions cost more than a stage
            pushed_at_ = std::numeric_limits<double>::quiet_NaN();  // even if one throws
            set_pushing(*modes_, time, drive_, forces.pushing);
            pushed_at_ = time;
        }
        work.head = head_frame(y, M());
        work.momentum = momentum_in_head(y, work.head);
        set_flow(*swimmer_, settings.water, time, Vector3{y[0], y[1], y[2]}, work);
        if constexpr (!M::planar)
            if (!work.fins.empty()) place_fins(*swimmer_, settings.law, settings.water, time, y, work);
        columns.set(*swimmer_, *modes_, settings, work);
        factored_ = columns.mass;
        singular_ = factored_.factor();
        return singular_ == Definite::definite;
    }

    // Shape, motion and loads at present. False if M is not positive definite.
    bool find_present(const BentSettings& settings, const Present& now)
    {
        if (!configure_at(settings, now.time, now.state, now.x.data())) return false;
        move_by_rates(now.rate.data(), now.x.data());
        return true;
    }
    // The first mode that makes M singular at present; none if M is positive definite.
    std::optional<std::size_t> singular_mode(const BentSettings& settings, const Present& now)
    {
        if (configure_at(settings, now.time, now.state, now.x.data())) return {};
        return singular_ < head ? 0 : singular_ - head;
    }
    // Kinetic energy of the rotors and armatures [J].
    double rotor_energy() const
    {
        double sum = 0.0;
        for (std::size_t i = 0; i < rate.size(); ++i) sum += 0.5 * modes_->armature[i] * rate[i] * rate[i];
        return sum;
    }

    // `rate` of a configured body, from the momenta of the coordinates. `move` follows.
    void find_rates_of(const double* momenta)
    {
        const auto whole = components_of(work.momentum);
        for (std::size_t i = 0; i < solution_.size(); ++i)
            solution_[i] = (i < head ? whole[i] : momenta[i - head]) - columns.at_rest[i];
        factored_.solve(solution_.data());
        std::copy_n(solution_.begin() + head, rate.size(), rate.begin());
    }
    // Velocities and loads for the head's part of `solution_` and `rate`.
    void move(const double* x)
    {
        work.twist = Components<Twist<M, double>>::make([&](std::size_t k) { return solution_[k]; });
        set_velocities(*swimmer_, work.twist, work);
        for (std::size_t m = 0; m < modes_->modes; ++m) {
            const Column<M>& own = columns.column[m];
            for (std::size_t k = own.first_block; k < swimmer_->grid.blocks; ++k) {
                work.omega.store(k, work.omega[k] + rate[m] * own.omega[k]);
                work.velocity.store(k, work.velocity[k] + rate[m] * own.velocity[k]);
            }
        }
        if (work.flowing) set_flow_load(*swimmer_, work);
        find_loads(*swimmer_, work);
        work.has_external = !law_->wrenches.empty();
        if (work.has_external) find_external_loads(*law_, time_, work);
        if (swimmer_->weighs()) set_weight(*swimmer_, 0.0, work);  // the energy is set by observations
        if constexpr (!M::planar)
            if (!work.fins.empty()) find_fin_loads(*swimmer_, *law_, time_, state_, work);
        set_mode_loads();
        if (work.flowing || !work.fins.empty()) set_added_loads();
        set_forces(*modes_, target, x, rate.data(), forces);
    }

    // Motion and loads from the rates of the coordinates.
    void move_by_rates(const double* rates, const double* x)
    {
        if (rates != rate.data()) std::copy_n(rates, rate.size(), rate.begin());
        auto left = components_of(work.momentum);
        for (std::size_t i = 0; i < head; ++i) {
            left[i] -= columns.at_rest[i];
            for (std::size_t m = 0; m < modes_->modes; ++m) left[i] -= columns.mass.at(head + m, i) * rate[m];
        }
        work.factored = work.inertia;
        work.factored.factor();
        work.factored.solve(left);
        std::copy_n(left.begin(), head, solution_.begin());
        std::ranges::copy(rate, solution_.begin() + head);
        move(x);
    }

    // Momenta of the coordinates, after `move_by_rates`.
    void find_momenta(double* momenta) const
    {
        for (std::size_t i = head; i < solution_.size(); ++i) {
            double row = columns.at_rest[i];
            for (std::size_t j = 0; j < solution_.size(); ++j) row += columns.mass.at(i, j) * solution_[j];
            momenta[i - head] = row;
        }
    }

    // `head_rate` and `momentum_rate` for state y, in the motion held by `work`.
    void find_rates(const BentSettings& settings, const State& y)
    {
        put_velocity(work.twist, work.head, settings.water.current, y, head_rate);
        by_loads_ = momentum_rate_from_loads(*swimmer_, work);
        put_momentum(by_loads_, work.head, head_rate);
        for (std::size_t k = state_size; k < state_space; ++k) head_rate[k] = work.servo_rate[k];
        set_momentum_behind();
        for (std::size_t m = 0; m < modes_->modes; ++m)
            momentum_rate[m] = gradient_of_energy(settings, m) + mode_load_[m] - forces.total[m];
        if (work.flowing || !work.fins.empty())
            for (std::size_t m = 0; m < modes_->modes; ++m) momentum_rate[m] += added_[m];
        for (std::size_t i = modes_->modes; i < modes_->coordinates; ++i) momentum_rate[i] = -forces.total[i];
    }

    // `acceleration`, the head's in `work`, and `drift`; after `find_rates`.
    void find_accelerations_and_drift(const BentSettings& settings)
    {
        const LawOnGrid& law = settings.law;
        for (std::size_t m = 0; m < modes_->modes; ++m) work.factor[settings.first_mode + m][1] = rate[m];
        for (std::size_t k = 0; k < swimmer_->grid.blocks; ++k)
            work.curvature_rate.store(k, law.combine_both(law.tables->node, work.factor, 1, k));
        const double on_nose = water_on_nose(*swimmer_, work);
        const auto left = accelerating_load(*swimmer_, law, on_nose, work);
        imposed_at_rest_ = power_of_shape(*swimmer_, work);
        for (std::size_t k = 0; k < swimmer_->grid.blocks; ++k) {  // about the sections, weighted
            Wrench<M, Lanes> taken = work.density[k];
            taken.angular = taken.angular - cross(work.position[k], taken.linear);
            load_.store(k, swimmer_->grid.weight[k] * taken);
        }
        const auto of_head = components_of(left), by_loads = components_of(by_loads_);
        const std::size_t n = modes_->coordinates;
        for (std::size_t i = 0; i < head; ++i) solution_[i] = of_head[i], by_momenta_[i] = by_loads[i];
        for (std::size_t i = 0; i < n; ++i) {
            solution_[head + i] = -forces.total[i];
            if (i < modes_->modes)
                solution_[head + i] += mode_load_[i] - columns.work_of(i, load_) + work_of_fins(i, of_force);
            by_momenta_[head + i] = momentum_rate[i];
        }
        factored_.solve(solution_.data());
        factored_.solve(by_momenta_.data());
        work.head_acceleration = Components<Twist<M, double>>::make([&](std::size_t k) { return solution_[k]; });
        for (std::size_t i = 0; i < n; ++i) {
            acceleration[i] = solution_[head + i];
            drift[i] = acceleration[i] - by_momenta_[head + i];
        }
        work.nose_force = on_nose - swimmer_->nose_mass * work.head_acceleration.linear.x;
        if constexpr (!M::planar)
            if (!work.fins.empty()) accelerate_fins();
    }

    // Power [W] that imposes the change of shape, - integral C . Kdot_imposed, after the accelerations.
    double imposed_power() const
    {
        double power = imposed_at_rest_;
        for (std::size_t i = 0; i < solution_.size(); ++i) power += solution_[i] * columns.momentum[i];
        return power;
    }
    // Powers [W] of motors and imposed change of shape, wake, nose, drag, flow; after the accelerations.
    Powers powers() const
    {
        Powers powers = powers_of_loads(*swimmer_, work);
        powers[0] = forces.motor_power + imposed_power();
        return powers;
    }

  private:
    // omega_a(l) . C_t + v_a(l) . N_t + integral (omega_a . c + v_a . n) dX, for each mode.
    void set_mode_loads()
    {
        for (std::size_t k = 0; k < swimmer_->grid.blocks; ++k) load_.store(k, loads_on_sections(*swimmer_, work, k));
        const std::size_t tail = swimmer_->grid.nodes - 1;
        const auto force = work.tail.linear;
        const Angular<M, double> torque = work.tail.angular - cross(work.position.node(tail), force);
        for (std::size_t m = 0; m < modes_->modes; ++m) {
            const Column<M>& own = columns.column[m];
            mode_load_[m] =
                columns.work_of(m, load_) + dot(own.omega.node(tail), torque) + dot(own.velocity.node(tail), force);
        }
        if (!work.appendages.empty()) add_appendages();
        if (work.has_external) add_external();
    }

    EEL_CORE_APART void add_appendages()
    {
        for (std::size_t i = 0; i < swimmer_->appendages.size(); ++i) {
            const std::size_t node = swimmer_->appendages[i].node;
            if (node == Appendage::nose) continue;  // ahead of all modes
            const AppendageMotion<M>& now = work.appendages[i];
            for (std::size_t m = 0; m < modes_->modes; ++m)
                mode_load_[m] += columns.work_at(node, m, {cross(now.arm, now.force), now.force});
        }
    }

    EEL_CORE_APART void add_external()
    {
        for (const ExternalLoad<M>& now : work.external)
            for (std::size_t m = 0; now.node != Appendage::nose && m < modes_->modes; ++m)
                mode_load_[m] += columns.work_at(now.node, m, now.wrench);
    }

    // Terms of the flow and the fins in the rates of the modes' momenta.
    EEL_CORE_APART void set_added_loads()
    {
        std::ranges::fill(added_, 0.0);
        if (work.flowing) {
            for (std::size_t k = 0; k < swimmer_->grid.blocks; ++k) load_.store(k, load_of_flow(*swimmer_, work, k));
            for (std::size_t m = 0; m < modes_->modes; ++m) added_[m] = columns.work_of(m, load_);
        }
        for (std::size_t m = 0; m < modes_->modes; ++m)
            added_[m] += work_of_fins(m, [](const FinMotion& now) { return now.load; });
    }

    static Wrench<Space, double> of_force(const FinMotion& now) { return {cross(now.arm, now.whole), now.whole}; }

    // Work of `wrench` of each fin, about its section, on the motion of a mode; 0 without fins.
    template <class OfFin>
    double work_of_fins(std::size_t m, OfFin wrench) const
    {
        double sum = 0.0;
        if constexpr (!M::planar)
            for (std::size_t i = 0; i < swimmer_->fins.size(); ++i)
                sum += columns.work_at(swimmer_->fins[i].node, m, wrench(work.fins[i]));
        return sum;
    }

    // Updates the fins' forces with the accelerations.
    EEL_CORE_APART void accelerate_fins()
    {
        for (std::size_t i = 0; i < swimmer_->fins.size(); ++i) {
            FinMotion& now = work.fins[i];
            const std::size_t node = swimmer_->fins[i].node;
            const Twist<Space, double>& of_head = work.head_acceleration;
            Vector3<double> gained = of_head.linear + cross(of_head.angular, now.position);
            for (std::size_t m = 0; m < modes_->modes; ++m) gained += acceleration[m] * columns.at(now, node, m);
            now.whole = now.whole - swimmer_->fins[i].added_mass * dot(now.normal, gained) * now.normal;
        }
    }

    // The momentum from the nose to each node; then the part that turns with the modes, into `integrand`.
    void set_momentum_behind()
    {
        for (std::size_t k = 0; k < swimmer_->grid.blocks; ++k) {
            const auto section = swimmer_->sections[k];
            const auto frame = work.frame[k];
            auto [angular, linear] = momentum_of_sections<M>(*swimmer_, section, swimmer_->sections.lever[k], frame,
                                                             work.omega[k], work.velocity[k]);
            if (work.flowing) linear = linear - frame.parent(section.water_momentum(frame.local(work.flow[k].u)));
            work.integrand.store(k, {angular + cross(work.position[k], linear), linear});
        }
        swimmer_->grid.from_nose.integrate(work.integrand, momentum_ahead_);
        Momentum<M, double> whole = momentum_ahead_.node(swimmer_->grid.nodes - 1);
        if constexpr (!M::planar)
            for (const FinMotion& fin : work.fins) whole += at_fin(fin, fin.momentum);
        for (std::size_t k = 0; k < swimmer_->grid.blocks; ++k) {
            Momentum<M, Lanes> ahead = momentum_ahead_[k];
            if constexpr (!M::planar)
                if (!work.fins.empty())
                    ahead += fins_ahead(*swimmer_, work, k, &Fin::node_behind, &FinMotion::momentum);
            const Vector<M, Lanes> linear = whole.linear - ahead.linear, velocity = work.velocity[k];
            const Angular<M, Lanes> angular = (whole.angular - ahead.angular) - cross(work.position[k], linear);
            const Angular<M, Lanes> turned = cross(work.omega[k], angular) + cross(velocity, linear);
            work.integrand.store(k, {work.frame[k].local(turned), Vector<M, Lanes>{}});
        }
    }

    // dT/dq_m, from `work.integrand`.
    double gradient_of_energy(const BentSettings& settings, std::size_t m) const
    {
        const Column<M>& own = columns.column[m];
        const std::size_t end = (own.last_node + width - 1) / width;
        Lanes sum(0.0);
        for (std::size_t k = own.first_node / width; k < end; ++k) {
            const auto turned = work.integrand[k].angular;
            Lanes along;
            if constexpr (M::planar)
                along = turned;
            else
                along = modes_->axis[m] == LawOnGrid::pitch ? turned.y : turned.z;
            sum += swimmer_->grid.weight[k] * (Columns<M>::shape(settings, m, k) * along);
        }
        return -total(sum);
    }

    const Swimmer* swimmer_;
    const Modes* modes_;
    Definite factored_;
    std::size_t singular_ = 0;       // row of M that is not positive definite
    Field<Wrench<M, double>> load_;  // about the sections, weighted by their length, in the axes of the head
    Field<Momentum<M, double>> momentum_ahead_;         // of each node, about the head
    std::vector<double> mode_load_, added_, solution_;  // `added_`: only in the rates of momenta
    std::vector<double> by_momenta_;                    // accelerations that the rates of momenta alone would give
    std::vector<Jet> drive_;
    Wrench<M, double> by_loads_{};
    double imposed_at_rest_ = 0.0;    // W, power of the imposed change of shape without accelerations
    const LawOnGrid* law_ = nullptr;  // of the instant, like the next two
    double time_ = 0.0;
    double pushed_at_ = std::numeric_limits<double>::quiet_NaN();  // [s], of `forces.pushing`
    State state_{};
};

}  // namespace eel_core
