// SPDX-License-Identifier: Apache-2.0
// A body 1 m long whose sections are all alike, on one panel, and a law that bends it into an arc.
#pragma once

#include <memory>
#include <numbers>

#include "eel_core/algorithm.hpp"

namespace eel_core {

inline constexpr std::size_t panel_nodes = 8;
inline constexpr double body_mass = 2.0, added_mass = 3.0, added_mass3 = 0.5, inertia3 = 0.02, drag3 = 0.7;  // per m

struct PanelOfOne {
    std::vector<double> fraction, rows;  // Chebyshev's nodes with the end; integrals from the start to each node
    std::vector<std::uint64_t> first = std::vector<std::uint64_t>(panel_nodes, 0),
                               count = std::vector<std::uint64_t>(panel_nodes, panel_nodes);

    PanelOfOne()
    {
        for (std::size_t i = 0; i < panel_nodes; ++i) {
            const double turn = 2.0 * std::numbers::pi * static_cast<double>(panel_nodes - 1 - i) /
                                static_cast<double>(2 * panel_nodes - 1);
            fraction.push_back(0.5 * (1.0 + std::cos(turn)));
        }
        rows.resize(panel_nodes * panel_nodes);
        for (std::size_t j = 0; j < panel_nodes; ++j) {
            std::vector<double> polynomial{1.0};  // 1 at node j, 0 at the others
            for (std::size_t i = 0; i < panel_nodes; ++i) {
                if (i == j) continue;
                std::vector<double> next(polynomial.size() + 1);
                for (std::size_t power = 0; power < polynomial.size(); ++power) {
                    next[power + 1] += polynomial[power] / (fraction[j] - fraction[i]);
                    next[power] -= polynomial[power] * fraction[i] / (fraction[j] - fraction[i]);
                }
                polynomial = next;
            }
            for (std::size_t i = 0; i < panel_nodes; ++i)
                for (std::size_t power = 0; power < polynomial.size(); ++power)
                    rows[i * panel_nodes + j] += polynomial[power] *
                                                 std::pow(fraction[i], static_cast<double>(power + 1)) /
                                                 static_cast<double>(power + 1);
        }
    }
};

template <class Value = double>
Field<Value> constant(const Value& value)
{
    Field<Value> field(blocks_of(panel_nodes));
    Components<Value>::each(value,
                            [&](std::size_t row, double part) { std::fill_n(field.row(row), panel_nodes, part); });
    return field;
}

inline std::shared_ptr<Swimmer> straight_body()
{
    const PanelOfOne panel;
    auto swimmer = std::make_shared<Swimmer>();
    Grid& grid = swimmer->grid;
    grid.nodes = grid.widest = panel_nodes, grid.blocks = blocks_of(panel_nodes);
    grid.first.assign(panel_nodes, 0), grid.count.assign(panel_nodes, panel_nodes);
    grid.weight = grid.fraction = Row(grid.blocks), grid.barycentric = constant(1.0);
    std::copy_n(panel.rows.end() - panel_nodes, panel_nodes, grid.weight.row(0));
    std::copy(panel.fraction.begin(), panel.fraction.end(), grid.fraction.row(0));
    grid.from_nose =
        FromNose({panel.rows, panel.first, panel.count, panel.fraction}, {grid.weight.row(0), panel_nodes});
    grid.set_steps();
    grid.series.assign(panel_nodes + 1, Row(grid.blocks));
    Sections& sections = swimmer->sections;
    sections = {constant<Section<double>>({body_mass, added_mass, added_mass3, 0.01, 0.015, inertia3, 0.0}),
                constant(0.0), constant(0.0), constant(body_mass),
                constant<DragSection<double>>({0.0, drag3, 0.0, 0.0, 0.0, 0.0, 0.0})};
    swimmer->tail.added2 = added_mass, swimmer->tail.added3 = added_mass3;
    swimmer->friction = Friction::laminar, swimmer->resistive = false;
    return swimmer;
}

// The columns of a row of the constant curvature `size` rad/m.
inline std::vector<double> constant_curvature(double size)
{
    const PanelOfOne panel;
    std::vector<double> columns(4 * panel_nodes, 0.0);
    for (std::size_t i = 0; i < panel_nodes; ++i) {
        columns[i] = size;
        columns[panel_nodes + i] = size * (panel.fraction[i] - (i > 0 ? panel.fraction[i - 1] : 0.0));
    }
    return columns;
}

// No pitch; in yaw the curvature f_r(t; 0, 1) times `bend`, all along the body.
inline LawOnGrid arc(double bend)
{
    auto tables = std::make_shared<LawTables>(std::vector<std::size_t>{0, 1}, panel_nodes, 0);
    tables->set(0, constant_curvature(0.0).data()), tables->set(1, constant_curvature(1.0).data());
    LawOnGrid law;
    law.tables = tables;
    law.waves = {{0.0, {}, 0, 0}, {0.0, {{{0.0, 1.0, bend}}}, 1, 1}};
    return law;
}

// At time 0 the curvature in pitch and yaw, all along the body, and two time derivatives: {{K2, K3}, rates, ...}.
inline LawOnGrid bending(const std::array<std::array<double, 2>, 3>& curvature)
{
    auto tables =
        std::make_shared<LawTables>(std::vector<std::size_t>{0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1}, panel_nodes, 0);
    for (std::size_t row = 0; row < 12; ++row) {
        const double size = row % 6 < 3 ? curvature[row % 6][row / 6] : 0.0;
        tables->set(row, constant_curvature(size).data());
    }
    LawOnGrid law;
    law.tables = tables, law.segment = {0, 0.0, 1.0};
    return law;
}

}  // namespace eel_core
