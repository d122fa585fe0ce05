// SPDX-License-Identifier: Apache-2.0
// Where a speed changes its sign within a panel: the place that the search finds, and the integrals up to it.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "eel_core/loads/drag_kinks.hpp"

using namespace eel_core;

namespace {

using Function = std::function<double(double)>;

// Two panels whose nodes are Chebyshev's with the end, as fractions of the panel; both are 1 m long.
Grid two_panels(std::size_t nodes_of_first, std::size_t nodes_of_second)
{
    Grid grid;
    grid.nodes = nodes_of_first + nodes_of_second, grid.blocks = blocks_of(grid.nodes);
    grid.widest = std::max(nodes_of_first, nodes_of_second);
    grid.fraction = grid.barycentric = Row(grid.blocks);
    for (const std::size_t count : {nodes_of_first, nodes_of_second}) {
        const std::size_t first = grid.first.size();
        double* const fraction = grid.fraction.row(0) + first;
        double* const weight = grid.barycentric.row(0) + first;
        for (std::size_t i = 0; i < count; ++i) {
            grid.first.push_back(first), grid.count.push_back(count);
            const double turn =
                2.0 * std::numbers::pi * static_cast<double>(count - 1 - i) / static_cast<double>(2 * count - 1);
            fraction[i] = 0.5 * (1.0 + std::cos(turn));
        }
        for (std::size_t i = 0; i < count; ++i) {
            weight[i] = 1.0;
            for (std::size_t j = 0; j < count; ++j)
                if (j != i) weight[i] /= 4.0 * (fraction[i] - fraction[j]);
        }
    }
    grid.set_steps();
    return grid;
}

struct Panel {
    Grid grid;
    std::size_t first;

    std::size_t count() const { return grid.count[first]; }
    double fraction(std::size_t i) const { return grid.fraction.node(first + i); }

    Row values_of(const Function& function) const
    {
        Row values(grid.blocks);
        for (std::size_t i = 0; i < count(); ++i) values.row(0)[first + i] = function(fraction(i));
        return values;
    }
    // Where the search finds the zero of a function that has the value `at_start` where the panel begins.
    double zero_of(const Function& function, double at_start, bool exact = true) const
    {
        const Row values = values_of(function);
        std::size_t i = 0;
        while (i + 1 < count() && (values.node(first + i) > 0.0) == (at_start > 0.0)) ++i;
        const double before = i > 0 ? values.node(first + i - 1) : at_start;
        return zero_between(grid, values, first + i, before, exact);
    }
    double zero_of(const Function& function) const { return zero_of(function, function(0.0)); }
    double at(const Function& function, double fraction) const
    {
        return value_and_slope(grid, values_of(function), first, count(), fraction)[0];
    }
};

std::vector<Panel> panels() { return {{two_panels(9, 7), 0}, {two_panels(5, 11), 5}, {two_panels(16, 8), 16}}; }

struct Shape {
    const char* name;
    Function of;
};
std::vector<Shape> shapes()
{
    return {
        {"linear", [](double s) { return s; }},
        {"square", [](double s) { return -s * (1.0 + s); }},
        {"exponential", [](double s) { return std::expm1(3.0 * s); }},
        {"cubic", [](double s) { return s * s * s + 1e-3 * s; }},
        {"steep", [](double s) { return std::tanh(4.0 * s); }},
    };
}
const double zeros[] = {1e-9, 0.003, 0.2, 0.5, 0.77, 0.999, 1.0 - 1e-9};

}  // namespace

TEST(DragKinks, ExactSearchFindsTheZeroOfThePanelsPolynomial)
{
    for (const Panel& panel : panels())
        for (const Shape& shape : shapes())
            for (const double zero : zeros) {
                const Function moved = [&](double s) { return shape.of(s - zero); };
                const double found = panel.zero_of(moved);
                const std::string which = shape.name + std::string(", ") + std::to_string(zero) + ", " +
                                          std::to_string(panel.count()) + " nodes";
                const bool before_panel = (panel.at(moved, 0.0) > 0.0) == (moved(1.0) > 0.0);  // the polynomial's zero
                if (before_panel)
                    EXPECT_EQ(found, 0.0) << which;
                else
                    EXPECT_LT(std::abs(panel.at(moved, found)), 1e-11) << which;
            }
}

TEST(DragKinks, ExactSearchFindsTheZeroOfALine)
{
    for (const Panel& panel : panels())
        for (const double zero : zeros)
            EXPECT_NEAR(panel.zero_of([&](double s) { return s - zero; }), zero, 1e-12) << panel.count() << " nodes";
}

TEST(DragKinks, QuadraticThroughThreeNodesFindsTheZeroOfAParabola)
{
    for (const Panel& panel : panels())
        for (const double zero : {0.003, 0.2, 0.5, 0.77, 0.999}) {
            const Function parabola = [&](double s) { return (s - zero) * (1.0 + s); };
            EXPECT_NEAR(panel.zero_of(parabola, parabola(0.0), false), zero, 1e-12) << panel.count() << " nodes";
        }
}

TEST(DragKinks, ZeroBeforeThePanelCountsAsItsStart)
{
    for (const Panel& panel : panels()) EXPECT_EQ(panel.zero_of([](double s) { return 0.3 + s; }, -1e-6), 0.0);
}

TEST(DragKinks, PanelsPolynomialHasValueAndSlopeOfAPolynomialOfItsDegree)
{
    for (const Panel& panel : panels()) {
        const Row values = panel.values_of([](double s) { return 1.0 - 2.0 * s + 3.0 * s * s * s; });
        for (const double t : {0.01, 0.3, 0.6, 0.98}) {
            const auto [value, slope] = value_and_slope(panel.grid, values, panel.first, panel.count(), t);
            EXPECT_NEAR(value, 1.0 - 2.0 * t + 3.0 * t * t * t, 1e-13);
            EXPECT_NEAR(slope, -2.0 + 9.0 * t * t, 1e-11);
        }
    }
}

TEST(DragKinks, EachSpeedMayChangeItsSignBetweenAnyTwoNodes)
{
    Swimmer swimmer;
    swimmer.grid = two_panels(33, 16);
    swimmer.grid.weight = Row(swimmer.grid.blocks);
    swimmer.grid.series.assign(swimmer.grid.widest + 1, Row(swimmer.grid.blocks));
    Workspace<Space> work(swimmer);
    const std::array watched{lateral, vertical, roll, above_critical};
    for (int instant = 0; instant < 2; ++instant) {
        work.kink_count = 0;
        for (const Speed speed : watched) {
            for (std::size_t i = 0; i < swimmer.grid.nodes; ++i) work.speed[speed].row(0)[i] = i % 2 == 0 ? -1.0 : 1.0;
            find_kinks_of(swimmer, speed, 1.0, 1e-7, work);
        }
        ASSERT_EQ(work.kink_count, watched.size() * swimmer.grid.nodes);
    }
    for (std::size_t j = 0; j < work.kink_count; ++j) {
        const std::size_t i = j % swimmer.grid.nodes;
        EXPECT_EQ(work.kinks[j].speed, watched[j / swimmer.grid.nodes]);
        EXPECT_EQ(work.kinks[j].first, swimmer.grid.first[i]);
        EXPECT_EQ(std::signbit(work.kinks[j].jump), i % 2 == 0);
    }
}
