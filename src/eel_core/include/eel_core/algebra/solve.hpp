// SPDX-License-Identifier: Apache-2.0
// Symmetric positive definite systems, by L D L^T.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace eel_core {

// A symmetric matrix of three or six rows, stored as its lower triangle, row by row. After factoring: L below the
// diagonal, 1/D on it.
template <std::size_t N>
class Factored {
  public:
    static constexpr std::size_t at(std::size_t i, std::size_t j) { return i * (i + 1) / 2 + j; }

    std::array<double, N*(N + 1) / 2> lower{};

    // The product of the matrix, before factoring, with a vector.
    std::array<double, N> times(const std::array<double, N>& x) const
    {
        std::array<double, N> result{};
        for (std::size_t i = 0; i < N; ++i)
            for (std::size_t j = 0; j < N; ++j) result[i] += lower[j <= i ? at(i, j) : at(j, i)] * x[j];
        return result;
    }

    // Factors the matrix in place. False if it is not positive definite.
    bool factor()
    {
        bool definite = true;
#pragma GCC unroll 6
        for (std::size_t k = 0; k < N; ++k) {
            const double inverse = 1.0 / lower[at(k, k)];
            definite &= inverse > 0.0 && inverse < std::numeric_limits<double>::infinity();
#pragma GCC unroll 6
            for (std::size_t i = N - 1; i > k; --i) {
                const double part = lower[at(i, k)] * inverse;
#pragma GCC unroll 6
                for (std::size_t j = k + 1; j <= i; ++j) lower[at(i, j)] -= part * lower[at(j, k)];
            }
#pragma GCC unroll 6
            for (std::size_t i = k + 1; i < N; ++i) lower[at(i, k)] *= inverse;
            lower[at(k, k)] = inverse;
        }
        return definite;
    }

    // The solution for the right-hand side `x`, from the factors.
    void solve(std::array<double, N>& x) const
    {
#pragma GCC unroll 6
        for (std::size_t i = 1; i < N; ++i)
#pragma GCC unroll 6
            for (std::size_t j = 0; j < i; ++j) x[i] -= lower[at(i, j)] * x[j];
#pragma GCC unroll 6
        for (std::size_t k = 0; k < N; ++k) {
            const std::size_t i = N - 1 - k;
            x[i] *= lower[at(i, i)];
#pragma GCC unroll 6
            for (std::size_t j = i + 1; j < N; ++j) x[i] -= lower[at(j, i)] * x[j];
        }
    }
};

// The same for any size, column by column. After factoring: L below the diagonal, 1/D on it.
class Definite {
  public:
    static constexpr std::size_t definite = static_cast<std::size_t>(-1);

    explicit Definite(std::size_t n = 0) : n_(n), entries_(n * n) {}

    std::size_t size() const { return n_; }
    template <class Archive>
    void pass(Archive& archive)
    {
        archive(n_, entries_);
    }
    double& at(std::size_t i, std::size_t j) { return i >= j ? entries_[j * n_ + i] : entries_[i * n_ + j]; }
    double at(std::size_t i, std::size_t j) const { return i >= j ? entries_[j * n_ + i] : entries_[i * n_ + j]; }

    // Factors the matrix in place. Returns `definite`, or the index of the first row that fails.
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

    // The solution for the right-hand side `x`, from the factors.
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
