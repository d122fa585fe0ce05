// SPDX-License-Identifier: Apache-2.0
// The Python class of flows. Its sources come as tuples, in the axes of the outside.
#pragma once

#include <memory>
#include <string>

#include "from_python.hpp"

namespace eel_core {

// Turns `rows` (n, 18) of places and flow, as those of `FunctionFlow`, into the other axes.
inline void turn_rows(double* rows, std::size_t count)
{
    static constexpr std::array<std::size_t, 10> turned{0, 1, 3, 4, 6, 7, 11, 14, 15, 16};
    for (std::size_t i = 0; i < count; ++i)
        for (const std::size_t column : turned) {
            double& value = rows[FunctionFlow::columns * i + column];
            value = 0.0 - value;
        }
}

// A function of Python: function(time [s], rows (n, 18)) fills in the rows. It is called with Python's lock.
inline FunctionFlow function_from(const py::object& function)
{
    return {[function](double time, std::vector<double>& rows) {
        const py::gil_scoped_acquire locked;
        const std::size_t count = rows.size() / FunctionFlow::columns;
        if (count == 0) return;
        turn_rows(rows.data(), count);
        // Memory of Python's: the function may keep it.
        auto* const bytes = reinterpret_cast<char*>(rows.data());
        const py::bytearray own(bytes, sizeof(double) * rows.size());
        const py::object view = py::memoryview(py::object(own));
        function(time, view.attr("cast")("d", py::make_tuple(count, FunctionFlow::columns)));
        std::copy_n(PyByteArray_AS_STRING(own.ptr()), sizeof(double) * rows.size(), bytes);
        turn_rows(rows.data(), count);
    }};
}

inline VortexFlow vortices_from(const py::object& rows, double core, const py::object& drift)
{
    const auto numbers = Numbers::sized(rows, "vortices", Numbers(rows, "vortices").size() / 3 * 3);
    VortexFlow flow{{}, core, vector_from(drift, "drift")};
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
        const double* const v = numbers.data() + i;
        flow.vortices.push_back({0.0 - v[0], 0.0 - v[1], v[2] / (2.0 * std::numbers::pi)});
    }
    return flow;
}

// Axes t, x, y and z, and the velocities (t, x, y, z, 3) at their points.
inline GriddedFlow grid_from(const py::tuple& axes, const py::object& velocity)
{
    GriddedFlow flow;
    std::array<std::size_t, 4> size{};
    std::size_t count = 1;
    constexpr std::size_t most = std::numeric_limits<std::size_t>::max() / 32;  // bytes of a point
    for (std::size_t k = 0; k < size.size(); ++k) {
        const Numbers points(axes[k], "axis");
        size[k] = points.size();
        auto& own = flow.axes[k].points = points.vector();
        check_finite(own, "axes");
        if (own.empty() || !std::ranges::is_sorted(own, std::less_equal())) throw py::value_error("axes must rise");
        if (count > most / own.size()) throw py::value_error("velocity must have its numbers at all points");
        count *= own.size();
        if (k != 1 && k != 2) continue;
        std::ranges::reverse(own);
        for (double& point : own) point = 0.0 - point;
    }
    const auto [times, columns, rows, layers] = size;
    const auto from = Numbers::sized(velocity, "velocity", 3 * count);
    std::vector<GriddedFlow::Point> points;
    points.reserve(from.size() / 3);
    for (std::size_t t = 0; t < times; ++t)
        for (std::size_t x = columns; x-- > 0;)
            for (std::size_t y = rows; y-- > 0;)
                for (std::size_t z = 0; z < layers; ++z) {
                    const double* const v = from.data() + 3 * (((t * columns + x) * rows + y) * layers + z);
                    points.push_back({0.0 - v[0], 0.0 - v[1], v[2], 0.0});
                }
    flow.points = std::make_shared<const std::vector<GriddedFlow::Point>>(std::move(points));
    return flow;
}

inline std::shared_ptr<Flow> flow_from(const py::list& sources)
{
    auto flow = std::make_shared<Flow>();
    for (const py::handle each : sources) {
        const auto source = each.cast<py::tuple>();
        const auto kind = source[0].cast<std::string>();
        const auto number = [&](std::size_t i) { return source[i].cast<double>(); };
        const auto vector = [&](std::size_t i, const char* name) { return vector_from(source[i], name); };
        if (kind == "ramped") {
            flow->sources.emplace_back(RampedFlow{vector(1, "velocity"), ramps_from(source[2])});
        } else if (kind == "spline") {
            SplineFlow spline{cubics_from<Vector3<double>>(source[1], source[2])};
            for (auto& cubic : spline.velocity.pieces)
                for (auto& coefficient : cubic) coefficient = half_turn(coefficient);
            flow->sources.emplace_back(std::move(spline));
        } else if (kind == "shear") {
            flow->sources.emplace_back(
                ShearFlow{vector(1, "velocity"), vector(2, "across"), number(3), number(4), source[5].cast<bool>()});
        } else if (kind == "vortices") {
            flow->sources.emplace_back(vortices_from(source[1], number(2), source[3]));
        } else if (kind == "wave") {
            flow->sources.emplace_back(
                WaveFlow{number(1), number(2), number(3), number(4), number(5), vector(6, "direction")});
        } else if (kind == "grid") {
            flow->sources.emplace_back(grid_from(source[1], source[2]));
        } else if (kind == "function") {
            flow->sources.emplace_back(function_from(source[1]));
        } else {
            throw py::value_error("flow must be of a known kind, got '" + kind + "'");
        }
    }
    return flow;
}

inline Water water_from(const py::object& current, std::shared_ptr<const Flow> flow)
{
    return {vector_from(current, "current"), std::move(flow)};
}

// Writes the flow at the places of `rows` (n, 18) into them.
inline void put_flow(const std::shared_ptr<Flow>& flow, double time, const py::object& rows)
{
    const std::size_t count = Numbers(rows, "rows").size() / FunctionFlow::columns;
    const auto into = Numbers::sized(rows, "rows", FunctionFlow::columns * count, true);
    turn_rows(into.data(), count);
    flow_at(*flow, time, into.data(), count);
    turn_rows(into.data(), count);
}

}  // namespace eel_core
