// SPDX-License-Identifier: Apache-2.0
// Fins, their servos and their given angles, as tuples of Python. Section axes are the same outside.
#pragma once

#include <string>

#include "eel_core/march/march.hpp"
#include "from_python.hpp"

namespace eel_core {

// Gives the swimmer its fins: (node, normal (3,), centre (3,), pressure, lift slope, induced drag, normal drag,
// friction drag, added mass, servo, sign, first station there or behind); and the servos: (time constant, limit, roll
// gain, rate gain, node, initial angle).
inline void add_fins(Swimmer& swimmer, const py::list& fins, const py::list& servos)
{
    std::size_t slot = state_size;
    for (const py::handle each : servos) {
        const auto [tau, limit, roll, rate, node, initial] =
            each.cast<std::tuple<double, double, double, double, std::size_t, double>>();
        if (tau > 0.0 && slot == state_space)
            throw py::value_error("servos with a time constant must be " + std::to_string(most_servos) + " at most");
        swimmer.servos.push_back({tau, limit, roll, rate, node, tau > 0.0 ? slot++ : 0, initial});
    }
    for (const py::handle each : fins) {
        const auto t = each.cast<py::tuple>();
        const auto number = [&](std::size_t i) { return t[i].cast<double>(); };
        const auto vector = [&](std::size_t i) {
            const auto v = t[i].cast<std::array<double, 3>>();
            return Vector3{v[0], v[1], v[2]};
        };
        const auto node = t[0].cast<std::size_t>(), servo = t[9].cast<std::size_t>();
        if (node >= swimmer.grid.nodes || servo >= swimmer.servos.size())
            throw py::value_error("fins must have a node of the grid and a servo of those given");
        swimmer.fins.push_back({node, vector(1), vector(2), number(3), number(4), number(5), number(6), number(7),
                                number(8), servo, node + 1, t[11].cast<std::size_t>(), number(10)});
    }
}

// What the servos are given: (knots (n,) [s], coefficients (n - 1, 4) of cubics from the constant on).
inline std::vector<AngleLaw> angles_from(const py::list& given)
{
    std::vector<AngleLaw> laws;
    for (const py::handle each : given) {
        const auto [knots, coefficients] = each.cast<std::pair<py::object, py::object>>();
        const Numbers times(knots, "knots"), numbers(coefficients, "coefficients");
        if (times.size() < 2) throw py::value_error("knots must be two or more, got " + std::to_string(times.size()));
        numbers.check_size(4 * (times.size() - 1), "coefficients");
        AngleLaw law{{times.data(), times.data() + times.size()}, {}};
        for (std::size_t piece = 0; piece + 1 < times.size(); ++piece) {
            const double* const c = numbers.data() + 4 * piece;
            law.pieces.push_back({c[0], c[1], c[2], c[3]});
        }
        laws.push_back(std::move(law));
    }
    return laws;
}

}  // namespace eel_core
