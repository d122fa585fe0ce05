// SPDX-License-Identifier: Apache-2.0
// Adams-Bashforth steps of variable length and order, with one evaluation each.
//
//     y(t + h) = y(t) + h sum_j g_j phi*_j,  phi*_j = beta_j phi_j,  phi_0 = f,
//     phi_(j+1) = phi_j - phi*_j of the step before
//
// in modified divided differences (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, section
// III.5, eqs. 5.7 to 5.10). The next term of the sum, known with the new rate, estimates the error of the step. After a
// start, the order rises from one.
//
// Stable steps get longer as the order falls: 2/7, 6/11, 1 and 2 times the time of the fastest decay at orders 4 to 1.
// So when steps have become very short, the order with the longest predicted step among three neighbours is taken, as
// in Hindmarsh's LSODE. Otherwise it is the requested order.
#pragma once

#include <algorithm>
#include <span>

#include "eel_core/momentum_balance.hpp"

namespace eel_core {

// y + factor x, for each entry.
inline void add_scaled(double factor, const State& x, State& y)
{
    for (std::size_t k = 0; k < state_space; ++k) y[k] += factor * x[k];
}

// sum_j weight_j x_j, for each entry.
inline State weighted_sum(std::span<const double> weight, std::span<const State> x)
{
    State result;
    for (std::size_t k = 0; k < state_space; k += width) {
        Lanes sum(0.0);
        for (std::size_t j = 0; j < x.size(); ++j) sum += weight[j] * Lanes::load(x[j].data() + k);
        sum.store(result.data() + k);
    }
    return result;
}

// y + length sum_j weight_j rate_j.
inline State stepped(State y, double length, std::span<const double> weight, std::span<const State> rate)
{
    add_scaled(length, weighted_sum(weight, rate), y);
    return y;
}

class Adams {
  public:
    static constexpr std::size_t highest = 6;   // at higher orders, stable steps are shorter than exact ones
    static constexpr double is_short = 0.0125;  // of the longest step: the order of shorter steps may fall
    // Least growth of a step by which a neighbouring order is taken, and least growth that is used at all, so that
    // steps stay equal: as in LSODE (Hindmarsh, ODEPACK, 1983), where they are 1.3/1.2, 1.4/1.2 and 1.1.
    static constexpr double gain_below = 1.1, gain_above = 1.3, least_growth = 1.15;
    // The greatest growth while the order exceeds the number of known steps, and later. Our own.
    static constexpr double growth_at_start = 2.0, growth_of_full_order = 1.5;

    explicit Adams(std::size_t wanted = 1) : wanted_(wanted) {}

    std::size_t order() const { return order_; }
    std::size_t terms() const { return terms_; }  // of the present step

    // Discards the past steps before a step with known `rate` at its start.
    void begin(const State& rate)
    {
        known_ = 0, order_ = wanted_, since_change_ = 0, may_rise_ = false;
        difference_[0] = rate;
    }

    // The step of `length` [s] from y.
    State step(double length, const State& y)
    {
        terms_ = std::min(order_, known_ + 1);
        const std::size_t top = terms_ + (may_rise_ ? 1 : 0);  // the last g, for the error
        set_weights(length, top);
        double beta = 1.0, to_end = length, to_start = 0.0;  // s, from the step's end and start to past rates
        for (std::size_t j = 0; j < top; ++j) {
            if (j > 0) {
                to_start += length_[j - 1];
                beta *= to_end / to_start;
                to_end += length_[j - 1];
            }
            for (std::size_t k = 0; k < state_space; ++k) starred_[j][k] = beta * difference_[j][k];
        }
        return stepped(y, length, weight_, std::span(starred_).first(terms_));
    }

    // The error / the step's length, for a step of so many terms with the `rate` at its end.
    State defect(std::size_t terms, const State& rate) const
    {
        State left = rate;
        for (std::size_t j = 0; j < terms; ++j) add_scaled(-1.0, starred_[j], left);
        for (double& value : left) value *= weight_[terms];
        return left;
    }

    // Adds the step of `length` [s] to the past steps, with the `rate` at its end.
    void accept(double length, const State& rate)
    {
        State left = rate;
        difference_[0] = left;
        for (std::size_t j = 0; j < terms_; ++j) {
            add_scaled(-1.0, starred_[j], left);
            difference_[j + 1] = left;
        }
        std::copy_backward(length_.begin(), length_.begin() + static_cast<std::ptrdiff_t>(wanted_),
                           length_.begin() + static_cast<std::ptrdiff_t>(wanted_) + 1);
        length_[0] = length;
        known_ = std::min(known_ + 1, wanted_);
    }

    // Whether the neighbouring orders of the present step are evaluated, as steps are short.
    bool may_fall() const { return terms_ > 1; }
    bool may_rise() const { return may_rise_; }

    // Chooses the order of the next step. Returns its length relative to this one's. growth: allowed by its
    // error. below, above: for short steps, allowed by the neighbouring orders; 0 if not evaluated.
    double choose_order(bool steps_are_short, double growth, double below, double above)
    {
        const bool settled = since_change_ > order_;
        ++since_change_;
        if (!steps_are_short) {
            if (settled && order_ < wanted_) ++order_, since_change_ = 0;
            may_rise_ = false;
            return taken(growth);
        }
        if (below > gain_below * growth)
            growth = below, order_ = terms_ - 1, since_change_ = 0;
        else if (settled && terms_ == order_ && order_ < wanted_ && above > gain_above * growth)
            growth = above, order_ = terms_ + 1, since_change_ = 0;
        may_rise_ = since_change_ > terms_ && order_ < wanted_;
        return taken(growth);
    }

  private:
    // g_j: for equal steps, or for the present lengths.
    void set_weights(double length, std::size_t top)
    {
        static constexpr std::array<double, 8> equal{1.0,           1.0 / 2.0,    5.0 / 12.0,        3.0 / 8.0,
                                                     251.0 / 720.0, 95.0 / 288.0, 19087.0 / 60480.0, 5257.0 / 17280.0};
        if (std::all_of(length_.begin(), length_.begin() + static_cast<std::ptrdiff_t>(top - 1),
                        [&](double past) { return past == length; })) {
            std::copy_n(equal.begin(), top + 1, weight_.begin());
            return;
        }
        std::array<double, highest + 3> row;
        for (std::size_t q = 0; q < row.size(); ++q) row[q] = 1.0 / static_cast<double>(q + 1);
        double to_end = length;
        weight_[0] = 1.0;
        for (std::size_t j = 1; j <= top; ++j) {
            for (std::size_t q = 0; q + j < row.size(); ++q) row[q] -= row[q + 1] * (length / to_end);
            weight_[j] = row[0];
            to_end += length_[j - 1];
        }
    }

    // The growth that is used of a proposed one.
    double taken(double growth) const
    {
        if (known_ + 1 < order_) return std::min(growth_at_start, growth);
        if (1.0 <= growth && growth < least_growth) return 1.0;
        return std::min(growth_of_full_order, growth);
    }

    std::size_t wanted_, known_ = 0, terms_ = 0, order_ = 1, since_change_ = 0;
    bool may_rise_ = false;                                    // the next order is to be evaluated: steps are short
    std::array<State, highest + 2> difference_{}, starred_{};  // phi_j at the end of the last step, phi*_j of this one
    std::array<double, highest + 2> length_{};                 // s, of the last steps, the latest first
    std::array<double, highest + 3> weight_{};                 // g_j
};

}  // namespace eel_core
