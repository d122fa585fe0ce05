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

inline Row constant(double value)
{
    Row row(blocks_of(panel_nodes));
    std::fill_n(row.row(0), panel_nodes, value);
    return row;
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
    sections = {constant(body_mass), constant(added_mass), constant(added_mass3), constant(0.01),
                constant(0.015),     constant(inertia3),   constant(0.0),         constant(0.0),
                constant(0.0),       constant(body_mass),  constant(0.0),         constant(drag3),
                constant(0.0),       constant(0.0),        constant(0.0),         constant(0.0)};
    swimmer->tail.added2 = added_mass, swimmer->tail.added3 = added_mass3;
    swimmer->friction = Friction::laminar, swimmer->resistive = false;
    return swimmer;
}

// Rows of constant curvature 1 rad/m in pitch and yaw; the yaw's factor is f_r(t; 0, 1) times `bend`.
inline LawOnGrid arc(double bend)
{
    const PanelOfOne panel;
    auto tables = std::make_shared<LawTables>(std::vector<std::size_t>{0, 1}, panel_nodes, 0);
    std::vector<double> columns(4 * panel_nodes, 0.0);
    tables->set(0, columns.data());
    for (std::size_t i = 0; i < panel_nodes; ++i) {
        columns[i] = 1.0;
        columns[panel_nodes + i] = panel.fraction[i] - (i > 0 ? panel.fraction[i - 1] : 0.0);
    }
    tables->set(1, columns.data());
    LawOnGrid law;
    law.tables = tables;
    law.waves = {{0.0, {}, 0, 0}, {0.0, {{{0.0, 1.0, bend}}}, 1, 1}};
    return law;
}

}  // namespace eel_core
