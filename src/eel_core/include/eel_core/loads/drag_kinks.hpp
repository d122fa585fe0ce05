// SPDX-License-Identifier: Apache-2.0
// Where the drag along the body is not smooth at an instant, and its integrals there.
//
// V|V| has a kink where V changes its sign, and the printed friction law a jump where Re = 8e4; within a panel either
// would cost the quadrature its order. Each such load is s(X) G(X) with G smooth and s a staircase, so
//
//     integral of s G = s_0 integral of G + sum_j jump_j (integral of G from X_j to the end),
//
// and the integrals to X_j come from the polynomial through the panel's nodes, as all other integrals do.
#pragma once

#include <utility>

#include "eel_core/loads/drag.hpp"

namespace eel_core {

// A change of sign by less than this part of the tail's speed counts as round-off. It changes the loads by the square
// of this part.
inline constexpr double noise_of_speeds = 1e-7;

// Value and derivative, at the fraction `t` of a panel, of the polynomial through the values of its nodes: the
// barycentric formula (Berrut and Trefethen, SIAM Review 46 (2004), eqs. 4.2 and 9.4).
inline std::array<double, 2> value_and_slope(const Grid& grid, const Row& values, std::size_t first, std::size_t count,
                                             double t)
{
    const auto term = [&](std::size_t k, Lanes& part, Lanes& apart, Lanes& value) {
        const Mask inside = Mask::below(count - k);
        apart = t - select(inside, grid.fraction.from(first + k), 2.0);
        part = select(inside, grid.barycentric.from(first + k), 0.0) / apart;
        value = select(inside, values.from(first + k), 0.0);
    };
    Lanes above(0.0), under(0.0), rise(0.0), part, apart, value;
    for (std::size_t k = 0; k < count; k += width) {
        term(k, part, apart, value);
        above += part * value;
        under += part;
    }
    const double whole = total(under), here = total(above) / whole;
    for (std::size_t k = 0; k < count; k += width) {
        term(k, part, apart, value);
        rise += part * (here - value) / apart;
    }
    return {here, total(rise) / whole};
}

// Fraction of the panel at which the values are zero, between node i and the one before it, which has the value
// `before`.
//
// From the quadratic through these two and a third node of the panel: an error e moves the load of V|V| by e^3. If
// `exact`, from the polynomial through all nodes, by Newton's method within a bracket.
inline double zero_between(const Grid& grid, const Row& values, std::size_t i, double before, bool exact)
{
    const std::size_t first = grid.first[i], count = grid.count[i];
    const double* const v = values.row(0);
    const double* const fraction = grid.fraction.row(0);
    const double* const by_step = grid.by_step.row(0);
    const double* const by_two = grid.by_two.row(0);
    double start = i > first ? fraction[i - 1] : 0.0, end = fraction[i];
    const double f = before, g = v[i], slope = (g - f) * by_step[i];
    const double bend = i + 1 < first + count ? ((v[i + 1] - g) * by_step[i + 1] - slope) * by_two[i]
                                              : (slope - (f - v[i - 2]) * by_step[i - 1]) * by_two[i - 1];
    // f + b s + bend s^2 with s from the start on, in the form without cancellation, where it is linear like f and g
    const double b = slope - bend * (end - start), steep = std::sqrt(std::max(b * b - 4.0 * bend * f, 0.0));
    double t = start - 2.0 * f / (b + (g > f ? steep : -steep));
    if (!(start < t && t < end)) t = std::min(std::max(start - f / slope, start), end);
    if (!exact) return t;

    bool start_is_node = i > first;  // else the panel's polynomial may have its zero before the panel
    double step_before_last = end - start, last_step = end - start;
    for (int k = 0; k < 40; ++k) {
        const auto [value, rise] = value_and_slope(grid, values, first, count, t);
        if ((value > 0.0) != (g > 0.0))
            start = t;
        else if (t > start)
            end = t;
        else
            break;
        double step = -value / rise;
        if (std::abs(step) < 1e-6) return std::min(std::max(t + step, start), end);  // error left: step^2
        if (t + step <= start && !start_is_node)
            step = start - t, start_is_node = true;
        else if (!(start < t + step && t + step < end) || std::abs(step) > 0.5 * std::abs(step_before_last))
            step = 0.5 * (start + end) - t;
        step_before_last = last_step, last_step = step, t += step;
    }
    return t;
}

// Weights [m] of the nodes of a panel for the integral from its start to its fraction `t`, by Clenshaw's recurrence.
inline void set_weights_ahead(const Grid& grid, std::size_t first, std::size_t count, double t,
                              std::vector<double>& weights)
{
    const double z = 2.0 * t - 1.0;
    for (std::size_t k = 0; k < count; k += width) {
        Lanes sum(0.0), before(0.0);
        for (std::size_t m = count; m > 0; --m) {
            const Lanes next = 2.0 * z * sum + (grid.series[m].from(first + k) - before);
            before = sum, sum = next;
        }
        (z * sum + (grid.series[0].from(first + k) - before)).store(weights.data() + k);
    }
}

// Corrects these weights for drag that is not smooth between the nodes. `missed`: of a `Swimmer`.
inline void add_missed_weights(const std::vector<Row>& missed, std::size_t first, std::size_t count, double t,
                               std::vector<double>& weights)
{
    const double last = static_cast<double>(missed.size() - 1);
    const double place = last * std::acos(std::clamp(1.0 - 2.0 * t, -1.0, 1.0)) / std::numbers::pi;
    const std::size_t before = static_cast<std::size_t>(std::min(place, last - 1.0));
    const double part = place - static_cast<double>(before);
    for (std::size_t k = 0; k < count; k += width) {
        const Lanes here = missed[before].from(first + k), next = missed[before + 1].from(first + k);
        (Lanes::load(weights.data() + k) + here + part * (next - here)).store(weights.data() + k);
    }
}

// Notes the kink where `speed` changes its sign before node i, and adapts the load's weights to it. A change below
// `noise` is round-off.
template <class M>
void add_kink(const Swimmer& swimmer, Speed speed, std::size_t i, double at_nose, double noise, Workspace<M>& work)
{
    const Grid& grid = swimmer.grid;
    const Row& values = work.speed[speed];
    const double value = values.node(i), before = i > 0 ? values.node(i - 1) : at_nose;
    if (!(std::abs(value - before) > noise)) return;
    const bool of_friction = speed == above_critical;
    const std::size_t first = grid.first[i], count = grid.count[i];
    if (work.kink_count == work.kinks.size()) work.kinks.emplace_back().weights.resize(grid.widest + width);
    Kink& kink = work.kinks[work.kink_count++];
    kink.speed = speed;
    kink.first = first;
    kink.fraction = zero_between(grid, values, i, before, of_friction && swimmer.first_watched <= lateral);
    kink.jump = (of_friction ? 1.0 : 2.0) * (value >= 0.0 ? 1.0 : -1.0);
    set_weights_ahead(grid, first, count, kink.fraction, kink.weights);
    if (const auto& missed = swimmer.missed_drag[speed]; !missed.empty())
        add_missed_weights(missed, first, count, kink.fraction, kink.weights);
    Row& weight = of_friction ? work.turbulent_weight : work.load_weight[speed];
    for (std::size_t k = 0; k < count; k += width) {
        const std::size_t node = first + k;
        const Lanes passed = select(Mask::below(i > node ? i - node : 0), grid.weight.from(node), 0.0);
        const Lanes ahead_of_kink = select(Mask::below(count - k), Lanes::load(kink.weights.data() + k), 0.0);
        weight.store_from(node, weight.from(node) + kink.jump * (passed - ahead_of_kink));
    }
}

// Signs of a block of values by their bits. Values that are round-off take the sign of the value before.
struct CarriedSign {
    bool negative, known;  // of the last value so far

    unsigned carry(unsigned negative_bits, unsigned known_bits)
    {
        if (!known) {
            if (known_bits == 0) return negative = false, 0;
            negative = (negative_bits & known_bits & (~known_bits + 1)) != 0;  // the first known sign
            known = true;
        }
        unsigned result = 0;
        bool carried = negative;
        for (unsigned lane = 0; lane < width; ++lane) {
            if (known_bits >> lane & 1u) carried = (negative_bits >> lane & 1u) != 0;
            result |= (carried ? 1u : 0u) << lane;
        }
        return result;
    }
};

// Finds where a speed, `at_nose` at X = 0, changes its sign along the body.
template <class M>
void find_kinks_of(const Swimmer& swimmer, Speed speed, double at_nose, double noise, Workspace<M>& work)
{
    if (speed < swimmer.first_watched) return;
    constexpr unsigned all = (1u << width) - 1u;
    CarriedSign sign{at_nose<-noise, std::abs(at_nose)> noise};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Lanes values = work.speed[speed][k];
        unsigned negative = (values < Lanes(-noise)).bits();
        const unsigned known = negative | (values > Lanes(noise)).bits();
        if (!sign.known || known != all) negative = sign.carry(negative, known);
        const std::size_t here = std::min(width, swimmer.grid.nodes - std::min(swimmer.grid.nodes, width * k));
        unsigned changes = (negative ^ (negative << 1u | (sign.negative ? 1u : 0u))) & ((1u << here) - 1u);
        sign.negative = (negative >> (width - 1) & 1u) != 0;
        for (; changes != 0; changes &= changes - 1)
            add_kink(swimmer, speed, width * k + static_cast<std::size_t>(std::countr_zero(changes)), at_nose, noise,
                     work);
    }
}

template <class M>
void find_kinks(const Swimmer& swimmer, Workspace<M>& work)
{
    work.kink_count = 0;
    const std::size_t tail = swimmer.grid.nodes - 1;
    const Vector<M, double> nose = work.nose_through_water();
    double at_tail = std::abs(work.speed[axial].node(tail)) + std::abs(work.speed[lateral].node(tail));
    if constexpr (M::planar) {
        find_kinks_of(swimmer, lateral, nose.y, noise_of_speeds * at_tail, work);
    } else {
        at_tail += std::abs(work.speed[vertical].node(tail));
        const auto omega = work.omega.node(tail);
        const double spin = std::abs(omega.x) + std::abs(omega.y) + std::abs(omega.z);
        double turning = work.twist.angular.x;
        if (work.flowing) turning -= 0.5 * work.flow.nose().g.curl_along(Vector3{1.0, 0.0, 0.0});
        find_kinks_of(swimmer, lateral, nose.y, noise_of_speeds * at_tail, work);
        find_kinks_of(swimmer, vertical, nose.z, noise_of_speeds * at_tail, work);
        find_kinks_of(swimmer, roll, turning, noise_of_speeds * spin, work);
    }
    if (jumps(swimmer.friction)) find_kinks_of(swimmer, above_critical, -1.0, 0.0, work);
}

// Jump of the sign at a kink, at those points of a block that lie behind it, by their `place`; 0 ahead of it.
inline Lanes jump_behind(const Kink& kink, Lanes place)
{
    return select(place >= Lanes(static_cast<double>(kink.first) + kink.fraction), kink.jump, 0.0);
}

// Input of `add_jumps`: the resistance (minus the drag) whose sign follows a speed, as if that speed were positive,
// per length and about the head, at the nodes; and its integral from the nose to the stations.
struct UnsignedResistance {
    Field<Wrench<Space, double>> density, integral;
};

// Adds the jumps at the kinks to the `integral` of the balance's density from the nose to the stations.
inline void add_jumps(const Swimmer& swimmer, const Workspace<Space>& work, UnsignedResistance& own,
                      Field<Wrench<Space, double>>& integral)
{
    std::array<bool, speeds> integrated{};
    for (std::size_t j = 0; j < work.kink_count; ++j) {
        const Speed speed = work.kinks[j].speed;
        if (std::exchange(integrated[speed], true)) continue;
        LoadSigns<Lanes> sign{};
        sign.of(speed) = 1.0;
        for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
            const auto load =
                resistive_load(swimmer.sections.drag(k), work.friction_laminar[k], work.friction_excess[k], sign,
                               speeds_from(work, width * k), roll_from(work, width * k));
            own.density.store(k, -about_head<Space>(work.frame[k], work.position[k], load));
        }
        swimmer.to_station.integrate(own.density, swimmer.grid.weight, own.integral);
        for (std::size_t i = j; i < work.kink_count; ++i) {
            const Kink& kink = work.kinks[i];
            if (kink.speed != speed) continue;
            const std::size_t first = kink.first, count = swimmer.grid.count[first];
            Wrench<Space, Lanes> sum{};
            for (std::size_t k = 0; width * k < first; ++k)
                sum += select(Mask::below(first - width * k), swimmer.grid.weight[k], 0.0) * own.density[k];
            for (std::size_t k = 0; k < count; k += width)
                sum += select(Mask::below(count - k), Lanes::load(kink.weights.data() + k), 0.0) *
                       own.density.from(first + k);
            const Wrench<Space, double> ahead_of_kink = total_of(sum);
            for (std::size_t k = 0; k < blocks_of(swimmer.stations); ++k)
                integral.store(k, integral[k] + jump_behind(kink, swimmer.to_station.place()[k]) *
                                                    (own.integral[k] - ahead_of_kink));
        }
    }
}

}  // namespace eel_core
