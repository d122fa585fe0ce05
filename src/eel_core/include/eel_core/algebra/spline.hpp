// SPDX-License-Identifier: Apache-2.0
// Splines through samples, by B-splines: de Boor, A Practical Guide to Splines (1978), chapters IX, X and XIII.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace eel_core {

// The spline of an odd degree through rows of values at points x, which rise: one for each column. The derivative of
// that degree does not jump at the points next to either end ("not a knot"). With fewer points it is a polynomial.
class Spline {
  public:
    static constexpr std::size_t highest = 5;  // degree

    Spline(std::span<const double> x, std::vector<double> values, std::size_t degree)
        : degree_(std::min(degree, x.size() - 1)), columns_(values.size() / x.size()), coefficients_(std::move(values))
    {
        const std::size_t apart = x.size() > degree_ + 1 ? (degree_ + 1) / 2 : x.size();
        knots_.assign(degree_ + 2, x.front());  // one more at each end than it needs itself, for the integral
        for (std::size_t k = apart; k + apart < x.size(); ++k) knots_.push_back(x[k]);
        knots_.insert(knots_.end(), degree_ + 2, x.back());
        solve(x);
    }

    std::size_t columns() const { return columns_; }

    // The values (columns) at x; beyond the ends those of the polynomials there.
    void at(double x, double* values) const { combine(coefficients_, degree_, x, values); }

    // What takes x to the integrals from the first point to x.
    std::vector<double> integrals() const
    {
        std::vector<double> sums(coefficients_.size() + columns_);
        for (std::size_t row = 0; row < points(); ++row) {
            const double length = (knots_[row + degree_ + 2] - knots_[row + 1]) / static_cast<double>(degree_ + 1);
            for (std::size_t k = row * columns_; k < (row + 1) * columns_; ++k)
                sums[k + columns_] = sums[k] + length * coefficients_[k];
        }
        return sums;
    }
    void integral(const std::vector<double>& integrals, double x, double* values) const
    {
        combine(integrals, degree_ + 1, x, values);
    }

  private:
    using Basis = std::array<double, highest + 2>;

    std::size_t points() const { return coefficients_.size() / columns_; }

    // The last knot before x that begins an interval.
    std::size_t interval_of(double x) const
    {
        const auto first = knots_.begin() + static_cast<std::ptrdiff_t>(degree_) + 1;
        const auto last = knots_.end() - static_cast<std::ptrdiff_t>(degree_) - 2;
        return static_cast<std::size_t>(std::upper_bound(first + 1, last, x) - knots_.begin()) - 1;
    }

    // The B-splines of a degree that are not zero in an interval, at x.
    Basis basis(std::size_t degree, std::size_t interval, double x) const
    {
        Basis b{1.0};
        for (std::size_t d = 1; d <= degree; ++d) {
            double saved = 0.0;
            for (std::size_t r = 0; r < d; ++r) {
                const double right = knots_[interval + 1 + r], left = knots_[interval + 1 + r - d];
                const double part = b[r] / (right - left);
                b[r] = saved + (right - x) * part;
                saved = (x - left) * part;
            }
            b[d] = saved;
        }
        return b;
    }

    void combine(const std::vector<double>& rows, std::size_t degree, double x, double* values) const
    {
        const std::size_t interval = interval_of(x);
        const Basis b = basis(degree, interval, x);
        const double* row = rows.data() + (interval - degree_ - 1) * columns_;
        std::fill_n(values, columns_, 0.0);
        for (std::size_t r = 0; r <= degree; ++r, row += columns_)
            for (std::size_t k = 0; k < columns_; ++k) values[k] += b[r] * row[k];
    }

    // The coefficients in place of the values, by elimination: the matrix is totally positive and needs no pivots.
    void solve(std::span<const double> x)
    {
        const auto subtract = [&](std::size_t from, double factor, std::size_t row) {
            for (std::size_t k = 0; k < columns_; ++k)
                coefficients_[from * columns_ + k] -= factor * coefficients_[row * columns_ + k];
        };
        std::vector<Basis> matrix(x.size());
        std::vector<std::size_t> first(x.size());  // column of each row
        for (std::size_t i = 0; i < x.size(); ++i) {
            const std::size_t interval = interval_of(x[i]);
            matrix[i] = basis(degree_, interval, x[i]), first[i] = interval - degree_ - 1;
            for (std::size_t j = first[i]; j < i; ++j) {
                const double factor = matrix[i][j - first[i]] / matrix[j][j - first[j]];
                for (std::size_t k = j + 1; k <= first[j] + degree_; ++k)
                    matrix[i][k - first[i]] -= factor * matrix[j][k - first[j]];
                subtract(i, factor, j);
            }
        }
        for (std::size_t i = x.size(); i-- > 0;) {
            for (std::size_t j = i + 1; j <= first[i] + degree_; ++j) subtract(i, matrix[i][j - first[i]], j);
            for (std::size_t k = i * columns_; k < (i + 1) * columns_; ++k) coefficients_[k] /= matrix[i][i - first[i]];
        }
    }

    std::size_t degree_, columns_;
    std::vector<double> coefficients_, knots_;
};

}  // namespace eel_core
