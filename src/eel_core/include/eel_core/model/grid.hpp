// SPDX-License-Identifier: Apache-2.0
// Nodes along the body, in panels between its kinks, and the integral from the nose to each of them.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "eel_core/algebra/field.hpp"

namespace eel_core {

// Rows that integrate over the panel of each of n points: from its panel's start to the point, the integral of f is
// sum_j rows[i, j] f[first[i] + j] over the panel's count[i] nodes.
struct PanelRows {
    std::span<const double> rows;  // (n, widest) [m]
    std::span<const std::uint64_t> first, count;
    std::span<const double> fraction;  // (n,) of the panel, in its own variable
};

// The integral from the nose to n points: THE integral along the body, of every quantity.
//
// For each stretch of `filled` points: the integral to the node before the stretch's first panel is known. The rest is
// a sum over the nodes of its panels, with one weight for each point, so each node has a column of weights.
class FromNose {
  public:
    static constexpr std::size_t parts = filled / width;  // blocks of points in a stretch
    using Column = std::array<Lanes, parts>;
    struct Stretch {
        std::size_t begin, end;  // nodes
        std::size_t column;      // the first of `columns`
    };

    FromNose() = default;
    FromNose(const PanelRows& points, std::span<const double> node_weight)
    {
        const std::size_t n = points.first.size(), widest = n > 0 ? points.rows.size() / n : 0;
        place_ = Row(blocks_of(n));
        for (std::size_t i = 0; i < n; ++i)
            place_.row(0)[i] = static_cast<double>(points.first[i]) + points.fraction[i];
        for (std::size_t start = 0; start < n; start += filled) {
            const std::size_t last = std::min(start + filled, n) - 1;
            const std::size_t begin = points.first[start], end = points.first[last] + points.count[last];
            stretches_.push_back({begin, end, columns_.size()});
            for (std::size_t node = begin; node < end; ++node) {
                std::array<double, filled> weights{};
                for (std::size_t point = 0; point < filled; ++point) {
                    const std::size_t i = std::min(start + point, last), first = points.first[i];
                    if (node < first) weights[point] = node_weight[node];
                    if (first <= node && node < first + points.count[i])
                        weights[point] = points.rows[i * widest + node - first];
                }
                Column column;
                for (std::size_t part = 0; part < parts; ++part) column[part] = Lanes::load(&weights[part * width]);
                columns_.push_back(column);
            }
        }
    }

    std::span<const Stretch> stretches() const { return stretches_; }
    // For each point, the index of the first node of its panel plus its fraction of the panel; it rises along the body.
    const Row& place() const { return place_; }

    // `result` at the points, from the components of `integrand` at the nodes from `first_row` on; `known` is the
    // integral at the nodes (the result itself, if these are the points), and `at_nose` its value at the
    // nose. Only over the stretches from `begin` up to `end`, if integrand and `known` are zero before them.
    template <class Value, class Source>
    void integrate(const Field<Source>& integrand, std::size_t first_row, const Value& at_nose,
                   const Field<Value>& known, Field<Value>& result, std::size_t begin = 0,
                   std::size_t end = static_cast<std::size_t>(-1)) const
    {
        for (std::size_t s = begin; s < std::min(end, stretches_.size()); ++s) {
            const auto here = within<Value>(integrand, first_row, stretches_[s]);
            const std::size_t first = stretches_[s].begin;
            const Value before = first > 0 ? known.node(first - 1) : at_nose;
            for (std::size_t part = 0; part < parts; ++part) result.store(parts * s + part, before + here[part]);
        }
    }
    // The integral from the nose at the nodes, starting from zero.
    template <class Value, class Source>
    void integrate(const Field<Source>& integrand, Field<Value>& result, std::size_t first_row = 0) const
    {
        integrate(integrand, first_row, Components<Value>::make([](std::size_t) { return 0.0; }), result, result);
    }

    // The integral from the nose at the points, from the integrand only. weight: [m], of the nodes.
    template <class Value>
    void integrate(const Field<Value>& integrand, const Row& weight, Field<Value>& result) const
    {
        Value before = Components<Value>::make([](std::size_t) { return 0.0; });
        std::size_t node = 0;
        for (std::size_t s = 0; s < stretches_.size(); ++s) {
            for (; node < stretches_[s].begin; ++node) before += weight.node(node) * integrand.node(node);
            const auto here = within<Value>(integrand, 0, stretches_[s]);
            for (std::size_t part = 0; part < parts; ++part) result.store(parts * s + part, before + here[part]);
        }
    }

    // Adds to `result` at the points, times their `factor`, the result of these rows for `integrand`: the first
    // components, those of a `Value`.
    template <class Value, class Source>
    void add(const Field<Source>& integrand, const Row& factor, Field<Source>& result) const
    {
        for (std::size_t s = 0; s < stretches_.size(); ++s) {
            const auto here = within<Value>(integrand, 0, stretches_[s]);
            for (std::size_t part = 0; part < parts; ++part) {
                const std::size_t k = parts * s + part;
                Components<typename Field<Value>::Block>::each(here[part], [&](std::size_t c, Lanes lanes) {
                    double* const at = result.row(c) + width * k;
                    (Lanes::load(at) + factor[k] * lanes).store(at);
                });
            }
        }
    }

  private:
    // For the points of a stretch: the integral from the start of its first panel.
    template <class Value, class Source>
    std::array<typename Field<Value>::Block, parts> within(const Field<Source>& integrand, std::size_t first_row,
                                                           const Stretch& stretch) const
    {
        using Block = typename Field<Value>::Block;
        constexpr std::size_t count = Components<Block>::count;
        const std::size_t stride = integrand.stride();
        const Column* column = columns_.data() + stretch.column;
        const double* f = integrand.row(first_row) + stretch.begin;
        // Two alternating sets of sums, as a single set would wait for its last term.
        constexpr std::size_t sets = count * parts < 6 ? 2 : 1;
        std::array<std::array<std::array<Lanes, parts>, count>, sets> sum{};
        const auto add_node = [&](std::size_t node, std::size_t set) {
            for (std::size_t part = 0; part < parts; ++part) {
                const Lanes weight = column[node][part];
                for (std::size_t c = 0; c < count; ++c) sum[set][c][part] += f[c * stride + node] * weight;
            }
        };
        const std::size_t nodes = stretch.end - stretch.begin;
        std::size_t node = 0;
        for (; node + sets <= nodes; node += sets)
            for (std::size_t set = 0; set < sets; ++set) add_node(node + set, set);
        if (node < nodes) add_node(node, 0);
        std::array<Block, parts> result;
        for (std::size_t part = 0; part < parts; ++part)
            result[part] = Components<Block>::make(
                [&](std::size_t c) { return sets == 1 ? sum[0][c][part] : sum[0][c][part] + sum[sets - 1][c][part]; });
        return result;
    }

    std::vector<Stretch> stretches_;
    std::vector<Column> columns_;
    Row place_;
};

// The n nodes. A multiple of `filled` leaves no lanes empty. Empty lanes have no weight.
struct Grid {
    std::size_t nodes = 0, blocks = 0, widest = 0;  // widest: nodes of the largest panel
    Row weight;                                     // [m], of the integral over the body
    std::vector<std::size_t> first, count;          // first node of the node's panel, and its number of nodes
    FromNose from_nose;

    // Data to find places within a panel, and to integrate up to them (`drag_kinks`):
    Row fraction;             // of the node's panel, in its own variable
    Row by_step, by_two;      // 1 / fraction since the previous node; 1 / fraction between the nodes before and after
    Row barycentric;          // weights of the interpolation within the panel
    std::vector<Row> series;  // [m]: the rows of `PanelRows`, as series of Chebyshev polynomials T_m

    // Sets the data that follow from `fraction`, `first` and `count`.
    void set_steps()
    {
        by_step = by_two = Row(blocks);
        const double* const at = fraction.row(0);
        for (std::size_t i = 0; i < nodes; ++i) {
            const double before = i > first[i] ? at[i - 1] : 0.0;
            const double behind = i + 1 < first[i] + count[i] ? at[i + 1] : 2.0;
            by_step.row(0)[i] = 1.0 / (at[i] - before);
            by_two.row(0)[i] = 1.0 / (behind - before);
        }
    }
};

}  // namespace eel_core
