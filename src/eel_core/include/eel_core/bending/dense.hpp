// SPDX-License-Identifier: Apache-2.0
// Symmetric positive definite systems of any number of equations: L D L^T.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace eel_core {

// By the lower triangle, column by column; its factors once factored: L below the diagonal, 1/D on it.
class Definite {
  public:
    static constexpr std::size_t definite = static_cast<std::size_t>(-1);

    explicit Definite(std::size_t n = 0) : n_(n), entries_(n * n) {}

    std::size_t size() const { return n_; }
    double& at(std::size_t i, std::size_t j) { return i >= j ? entries_[j * n_ + i] : entries_[i * n_ + j]; }
    double at(std::size_t i, std::size_t j) const { return i >= j ? entries_[j * n_ + i] : entries_[i * n_ + j]; }

    // Factors the matrix in place. Returns `definite`, or the first row that is not.
    std::size_t factor()
    {
        for (std::size_t k = 0; k < n_; ++k) {
            double* const column = entries_.data() + k * n_;
            const double inverse = 1.0 / column[k];
            if (!(inverse > 0.0 && inverse < std::numeric_limits<double>::infinity())) return k;
            for (std::size_t j = k + 1; j < n_; ++j) {
                const double part = column[j] * inverse;
                double* const other = entries_.data() + j * n_;
                for (std::size_t i = j; i < n_; ++i) other[i] -= part * column[i];
            }
            for (std::size_t i = k + 1; i < n_; ++i) column[i] *= inverse;
            column[k] = inverse;
        }
        return definite;
    }

    // The solution for the right side `x`, by the factors.
    void solve(double* x) const
    {
        for (std::size_t k = 0; k < n_; ++k) {
            const double* const column = entries_.data() + k * n_;
            for (std::size_t i = k + 1; i < n_; ++i) x[i] -= column[i] * x[k];
        }
        for (std::size_t k = n_; k-- > 0;) {
            const double* const column = entries_.data() + k * n_;
            double sum = x[k] * column[k];
            for (std::size_t i = k + 1; i < n_; ++i) sum -= column[i] * x[i];
            x[k] = sum;
        }
    }

  private:
    std::size_t n_;
    std::vector<double> entries_;
};

}  // namespace eel_core
