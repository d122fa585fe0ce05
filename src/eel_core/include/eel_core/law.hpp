// SPDX-License-Identifier: Apache-2.0
// The curvature law K_d(t, X) = sum_m factor_m(t) row_m(X), for pitch (K2) and yaw (K3), with two time derivatives.
//
// A travelling wave is two rows, since sin(kX + phase - wt) = sin(kX + phase) cos wt - cos(kX + phase) sin wt. The
// quintic between two instants of a controller, and the blend from one law to the next, are rows with polynomial
// factors.
#pragma once

#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include "eel_core/algebra/field.hpp"
#include "eel_core/algebra/rotation.hpp"
#include "eel_core/model/external_wrench.hpp"
#include "eel_core/model/fin.hpp"

namespace eel_core {

// Value, rate and acceleration of a factor.
using Jet = std::array<double, 3>;

struct Ramp {
    double start, end, delta;  // adds delta f_r(t; start, end), eq. (64)

    void add_to(Jet& envelope, double time) const
    {
        if (time >= end) {
            envelope[0] += delta;
        } else if (time > start) {
            const double length = end - start, part = (time - start) / length, turn = 2.0 * std::numbers::pi;
            const auto [s, c] = sine_and_cosine(turn * part);
            envelope[0] += delta * (part - s / turn);
            envelope[1] += delta * (1.0 - c) / length;
            envelope[2] += delta * turn * s / (length * length);
        }
    }
};

// Terms of the law with the same axis, period and envelope.
struct Wave {
    double period;  // [s], 0: constant in time
    std::vector<std::vector<Ramp>>
        factors;               // of the envelope: the ramps of a factor add up, and factors multiply; none: 1
    std::size_t sine, cosine;  // rows of sin(kX + phase) and cos(kX + phase)

    Jet envelope(double time) const
    {
        Jet product{1.0, 0.0, 0.0};
        for (const std::vector<Ramp>& ramps : factors) {
            Jet sum{};
            for (const Ramp& ramp : ramps) ramp.add_to(sum, time);
            product = {product[0] * sum[0], product[1] * sum[0] + product[0] * sum[1],
                       product[2] * sum[0] + 2.0 * product[1] * sum[1] + product[0] * sum[2]};
        }
        return product;
    }

    void set(std::vector<Jet>& factor, double time) const
    {
        const Jet e = envelope(time);
        if (period == 0.0) {
            factor[sine] = e;
            return;
        }
        const double turns = time / period, w = 2.0 * std::numbers::pi / period;
        const auto [s, c] = sine_and_cosine(2.0 * std::numbers::pi * (turns - std::floor(turns)));
        const double bend = e[2] - e[0] * w * w;
        factor[sine] = {e[0] * c, e[1] * c - e[0] * w * s, bend * c - 2.0 * e[1] * w * s};
        factor[cosine] = {-e[0] * s, -e[1] * s - e[0] * w * c, -bend * s - 2.0 * e[1] * w * c};
    }
};

// Factors of the rows that hold value, rate and acceleration at one end of an interval of `length` [s], at the fraction
// `s` from that end: quintics that vanish with two derivatives at the other end. `sign` -1: for the interval's end.
inline void set_quintic(std::vector<Jet>& factor, std::size_t row, double s, double length, double sign)
{
    const double s2 = s * s, s3 = s2 * s, left = 1.0 - s, rate = sign / length, accel = 1.0 / (length * length);
    factor[row] = {1.0 - s3 * (10.0 - s * (15.0 - 6.0 * s)), -rate * 30.0 * s2 * left * left,
                   -accel * 60.0 * s * left * (1.0 - 2.0 * s)};
    double scale = sign * length;
    factor[row + 1] = {scale * (s - s3 * (6.0 - s * (8.0 - 3.0 * s))),
                       scale * rate * (1.0 - s2 * (18.0 - s * (32.0 - 15.0 * s))),
                       -scale * accel * s * (36.0 - s * (96.0 - 60.0 * s))};
    scale = length * length;
    factor[row + 2] = {scale * 0.5 * s2 * left * left * left, scale * rate * 0.5 * s * left * left * (2.0 - 5.0 * s),
                       scale * accel * left * (1.0 - s * (8.0 - 10.0 * s))};
}

// Six rows for each axis, for values at both ends of an interval; three, if the second end is zero (a blend that decays
// to zero).
struct Quintic {
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::size_t row = none;  // index of the first row
    double start = 0.0, end = 0.0;
    std::size_t of_start = 0, of_end = 3;  // of a segment: offsets of the rows for either end

    void set_segment(std::vector<Jet>& factor, double time) const
    {
        if (row == none) return;
        const double length = end - start, part = std::clamp((time - start) / length, 0.0, 1.0);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            set_quintic(factor, row + 6 * axis + of_start, part, length, 1.0);
            set_quintic(factor, row + 6 * axis + of_end, 1.0 - part, length, -1.0);
        }
    }
    void set_blend(std::vector<Jet>& factor, double time) const
    {
        if (row == none) return;
        const double length = end - start, part = std::max(0.0, (time - start) / length);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const std::size_t first = row + 3 * axis;
            if (part < 1.0)
                set_quintic(factor, first, part, length, 1.0);
            else
                factor[first] = factor[first + 1] = factor[first + 2] = Jet{};
        }
    }
};

// Rows at n points: one number per point, or the three Magnus moments.
template <std::size_t Parts>
struct RowTable {
    std::size_t blocks = 0;
    std::vector<std::array<Lanes, Parts>> lanes;  // [row][block]

    RowTable() = default;
    RowTable(std::size_t rows, std::size_t points) : blocks(blocks_of(points)), lanes(rows * blocks) {}

    const std::array<Lanes, Parts>& at(std::size_t row, std::size_t block) const { return lanes[row * blocks + block]; }

    // Sets a row from the values of n points, part after part.
    void set(std::size_t row, const double* values, std::size_t n)
    {
        for (std::size_t block = 0; block < blocks; ++block)
            for (std::size_t part = 0; part < Parts; ++part) {
                const std::size_t point = std::min(width * block, n), here = std::min(width, n - point);
                const double* const from = values + part * n + point;
                std::array<double, width> filled_up{};
                if (here < width) std::copy_n(from, here, filled_up.begin());
                lanes[row * blocks + block][part] = Lanes::load(here < width ? filled_up.data() : from);
            }
    }
    // The inverse of `set`.
    void get(std::size_t row, double* values, std::size_t n) const
    {
        for (std::size_t part = 0; part < Parts; ++part)
            for (std::size_t point = 0; point < n; ++point)
                values[part * n + point] = at(row, point / width)[part][point % width];
    }
};

// The rows of a law, tabulated at the nodes and the stations of a swimmer.
struct LawTables {
    std::vector<std::size_t> rows_of[2];  // of each axis, `LawOnGrid::Axis`
    RowTable<1> node;                     // [rad/m] at the nodes, per unit of factor
    RowTable<1> angle;                    // [rad], its integral from the nose to the nodes
    RowTable<3> moments;                  // [rad], Magnus moments over the interval that ends at each node
    RowTable<1> station;                  // as `node` and `moments`, at the stations, from the node before each
    RowTable<3> station_moments;

    LawTables() = default;
    // `axis` of each row: 0 pitch, 1 yaw; n nodes, s stations.
    LawTables(const std::vector<std::size_t>& axis, std::size_t n, std::size_t s)
        : node(axis.size(), n),
          angle(axis.size(), n),
          moments(axis.size(), n),
          station(axis.size(), s),
          station_moments(axis.size(), s),
          nodes_(n),
          stations_(s)
    {
        for (std::size_t row = 0; row < axis.size(); ++row) rows_of[axis[row] == 0 ? 0 : 1].push_back(row);
    }

    std::size_t rows() const { return rows_of[0].size() + rows_of[1].size(); }
    std::size_t columns() const { return 4 * (nodes_ + stations_); }

    // Sets a row from its columns: at the n nodes, their moments (3, n), at the s stations, their moments (3, s).
    void set(std::size_t row, const double* columns)
    {
        const std::size_t n = nodes_, s = stations_;
        node.set(row, columns, n), moments.set(row, columns + n, n);
        station.set(row, columns + 4 * n, s), station_moments.set(row, columns + 4 * n + s, s);
        double sum = 0.0;
        for (std::size_t block = 0; block < angle.blocks; ++block) {
            std::array<double, width> lanes;
            for (std::size_t lane = 0; lane < width; ++lane) lanes[lane] = sum += moments.at(row, block)[0][lane];
            angle.lanes[row * angle.blocks + block] = {Lanes::load(lanes.data())};
        }
    }

    // Archives which rows are active, and all rows by their columns (`march/archive.hpp`).
    template <class Archive>
    void pass(Archive& archive)
    {
        const std::size_t n = nodes_, s = stations_, rows = node.blocks > 0 ? node.lanes.size() / node.blocks : 0;
        archive.same(rows), archive.same(n), archive.same(s);
        archive(rows_of[0], rows_of[1]);
        std::vector<double> row_columns(columns());
        for (std::size_t row = 0; row < rows; ++row) {
            double* const to = row_columns.data();
            node.get(row, to, n), moments.get(row, to + n, n);
            station.get(row, to + 4 * n, s), station_moments.get(row, to + 4 * n + s, s);
            archive(row_columns);
            if constexpr (Archive::reads) set(row, to);
        }
    }

  private:
    std::size_t nodes_ = 0, stations_ = 0;
};

struct LawOnGrid {
    enum Axis : std::size_t { pitch = 0, yaw = 1 };

    std::shared_ptr<const LawTables> tables;
    double origin = 0.0;  // [s], simulation time of the law's own t = 0
    std::vector<Wave> waves;
    Quintic segment, blend;
    std::vector<AngleLaw> fins;            // given angles of the fins' servos; none: 0
    std::vector<ExternalWrench> wrenches;  // from outside

    // Factors of the rows at `time` [s].
    void set_factors(double time, std::vector<Jet>& factor) const
    {
        for (const Wave& wave : waves) wave.set(factor, time - origin);
        segment.set_segment(factor, time);
        blend.set_blend(factor, time);
    }

    // Sum of factor times row over the rows of an axis, at a block of points; `derivative` 0, 1, 2.
    template <std::size_t Parts>
    std::array<Lanes, Parts> combine(const RowTable<Parts>& table, Axis axis, const std::vector<Jet>& factor,
                                     std::size_t derivative, std::size_t block) const
    {
        std::array<Lanes, Parts> sum;
        sum.fill(Lanes(0.0));
        for (const std::size_t row : tables->rows_of[axis])
            for (std::size_t part = 0; part < Parts; ++part)
                sum[part] += factor[row][derivative] * table.at(row, block)[part];
        return sum;
    }
    // Pitch and yaw.
    Vector2<Lanes> combine_both(const RowTable<1>& table, const std::vector<Jet>& factor, std::size_t derivative,
                                std::size_t block) const
    {
        return {combine(table, pitch, factor, derivative, block)[0], combine(table, yaw, factor, derivative, block)[0]};
    }
    // The rotations over the intervals with these `moments`.
    Quaternion<Lanes> turn(const RowTable<3>& moments, const std::vector<Jet>& factor, std::size_t block) const
    {
        const auto p = combine(moments, pitch, factor, 0, block), y = combine(moments, yaw, factor, 0, block);
        return magnus({p[0], y[0]}, {p[1], y[1]}, {p[2], y[2]});
    }
};

}  // namespace eel_core
