// SPDX-License-Identifier: Apache-2.0
// The Python classes of flows and of their sources, whose numbers are in the axes of the outside.
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

inline SplineFlow spline_from(const py::object& knots, const py::object& coefficients)
{
    SplineFlow spline{cubics_from<Vector3<double>>(knots, coefficients)};
    for (auto& cubic : spline.velocity.pieces)
        for (auto& coefficient : cubic) coefficient = half_turn(coefficient);
    return spline;
}

// Appends a source of one of the kinds.
template <class... Source>
void append(std::vector<std::variant<Source...>>& sources, const py::handle& source)
{
    const bool known =
        ((py::isinstance<Source>(source) && (sources.emplace_back(source.cast<const Source&>()), true)) || ...);
    if (!known)
        throw py::value_error("sources must be of the classes of flows, got " + py::repr(source).cast<std::string>());
}

inline std::shared_ptr<Flow> flow_from(const py::list& sources)
{
    auto flow = std::make_shared<Flow>();
    for (const py::handle source : sources) append(flow->sources, source);
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

inline void bind_flows(py::module_& module)
{
    using Object = const py::object&;
    const auto vector = [](Object row, const char* name) { return vector_from(row, name); };
    py::class_<RampedFlow>(module, "RampedFlow")
        .def(py::init([vector](Object velocity, const py::list& ramps) {
                 return RampedFlow{vector(velocity, "velocity"), ramps_from(ramps)};
             }),
             py::arg("velocity"), py::arg("ramps"));
    py::class_<SplineFlow>(module, "SplineFlow").def(py::init(&spline_from), py::arg("knots"), py::arg("coefficients"));
    py::class_<ShearFlow>(module, "ShearFlow")
        .def(py::init([vector](Object velocity, Object across, double middle, double thickness, bool linear) {
                 return ShearFlow{vector(velocity, "velocity"), vector(across, "across"), middle, thickness, linear};
             }),
             py::arg("velocity"), py::arg("across"), py::arg("middle"), py::arg("width"), py::arg("linear"));
    py::class_<VortexFlow>(module, "VortexFlow")
        .def(py::init(&vortices_from), py::arg("vortices"), py::arg("core"), py::arg("drift"));
    py::class_<WaveFlow>(module, "WaveFlow")
        .def(py::init([vector](double amplitude, double wavenumber, double frequency, double surface, double phase,
                               Object direction) {
                 return WaveFlow{amplitude, wavenumber, frequency, surface, phase, vector(direction, "direction")};
             }),
             py::arg("amplitude"), py::arg("wavenumber"), py::arg("frequency"), py::arg("surface"), py::arg("phase"),
             py::arg("direction"));
    py::class_<GriddedFlow>(module, "GriddedFlow").def(py::init(&grid_from), py::arg("axes"), py::arg("velocity"));
    py::class_<FunctionFlow>(module, "FunctionFlow").def(py::init(&function_from), py::arg("function"));

    auto flow = py::class_<Flow, std::shared_ptr<Flow>>(module, "Flow");
    share_in_copies(flow);
    flow.def(py::init(&flow_from), py::arg("sources")).def("at", &put_flow, py::arg("time"), py::arg("rows"));
}

}  // namespace eel_core
