// SPDX-License-Identifier: Apache-2.0
// What Python hands over: arrays and tables as objects with arrays for attributes, copied into the structs of the core.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "eel_core/march/march.hpp"

namespace eel_core {

namespace py = pybind11;

// A contiguous array of numbers of type T, which Python keeps alive as long as this lives.
template <class T>
class Array {
  public:
    Array(const py::handle& object, const std::string& name, bool writable = false)
        : info_(py::cast<py::buffer>(object).request(writable))
    {
        std::size_t step = sizeof(T);
        for (std::size_t axis = info_.shape.size(); axis-- > 0; step *= length(axis))
            if (length(axis) > 1 && static_cast<std::size_t>(info_.strides[axis]) != step)
                throw py::value_error(name + " must be contiguous");
        if (!is_of_type())
            throw py::value_error(name + " must hold numbers of " + std::to_string(8 * sizeof(T)) + " bits like '" +
                                  py::format_descriptor<T>::format() + "', got '" + info_.format + "'");
    }

    std::size_t length(std::size_t axis) const { return static_cast<std::size_t>(info_.shape.at(axis)); }
    std::size_t size() const { return static_cast<std::size_t>(info_.size); }
    T* data() const { return static_cast<T*>(info_.ptr); }
    std::span<const T> span() const { return {data(), size()}; }
    void check_size(std::size_t wanted, const std::string& name) const
    {
        if (size() != wanted)
            throw py::value_error(name + " must have " + std::to_string(wanted) + " numbers, got " +
                                  std::to_string(size()));
    }

  private:
    bool is_of_type() const  // 'l' and 'q', 'L' and 'Q' are the same numbers
    {
        const char kind = info_.format.empty() ? '?' : info_.format.back();
        const bool fits = static_cast<std::size_t>(info_.itemsize) == sizeof(T);
        if (std::is_floating_point_v<T>) return fits && kind == 'd';
        return fits && (std::is_signed_v<T> ? kind == 'l' || kind == 'q' : kind == 'L' || kind == 'Q');
    }

    py::buffer_info info_;
};

using Numbers = Array<double>;

template <class T>
Array<T> array_of(const py::handle& object, const char* name)
{
    return Array<T>(object.attr(name), name);
}

template <std::size_t N>
std::array<double, N> row_from(const py::handle& object, const std::string& name)
{
    const Numbers numbers(object, name);
    numbers.check_size(N, name);
    std::array<double, N> result;
    std::copy_n(numbers.data(), N, result.begin());
    return result;
}
inline Vector3<double> vector_from(const py::handle& object, const std::string& name)
{
    const auto v = row_from<3>(object, name);
    return half_turn(Vector3{v[0], v[1], v[2]});
}
inline Quaternion<double> orientation_from(const py::handle& object)
{
    const auto q = row_from<4>(object, "orientation");
    return half_turn(Quaternion<double>{q[0], q[1], q[2], q[3]});
}
inline Twist<Space, double> twist_of(const double* v)
{
    return half_turn(Twist<Space, double>{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
}
inline Twist<Space, double> twist_from(const py::handle& object, const std::string& name)
{
    return twist_of(row_from<6>(object, name).data());
}
inline State state_from(const py::handle& object)
{
    const auto v = row_from<state_size>(object, "state");
    State y{};
    std::copy(v.begin(), v.end(), y.begin());
    return half_turn(y);
}

// One number for each of n points.
inline Row points(const py::handle& object, const char* name, std::size_t n)
{
    const Numbers numbers = array_of<double>(object, name);
    numbers.check_size(n, name);
    Row row(blocks_of(n));
    std::copy_n(numbers.data(), n, row.row(0));
    return row;
}

inline Sections sections_from(const py::handle& s, std::size_t n)
{
    return {points(s, "mass", n),       points(s, "added2", n),
            points(s, "added3", n),     points(s, "inertia1", n),
            points(s, "inertia2", n),   points(s, "inertia3", n),
            points(s, "added_roll", n), points(s, "lever", n),
            points(s, "net", n),        points(s, "displaced", n),
            points(s, "drag2", n),      points(s, "drag3", n),
            points(s, "drag_roll", n),  points(s, "laminar", n),
            points(s, "turbulent", n),  points(s, "by_critical_speed", n)};
}

// `matrix`: rows for the `points`, as those of `PanelRows`.
inline FromNose from_nose(const py::handle& points, const py::handle& matrix, const Row& weight, std::size_t nodes)
{
    const Numbers rows(matrix, "matrix"), fraction = array_of<double>(points, "fraction");
    const auto first = array_of<std::uint64_t>(points, "first"), count = array_of<std::uint64_t>(points, "count");
    rows.check_size(array_of<double>(points, "matrix").size(), "matrix");
    return FromNose({rows.span(), first.span(), count.span(), fraction.span()}, {weight.row(0), nodes});
}

inline Grid grid_from(const py::handle& g)
{
    Grid grid;
    const auto first = array_of<std::uint64_t>(g, "first"), count = array_of<std::uint64_t>(g, "count");
    const auto series = array_of<double>(g, "series");
    const std::size_t n = first.size();
    if (n == 0) throw py::value_error("grid must have nodes, got none");
    grid.nodes = n, grid.blocks = blocks_of(n), grid.widest = array_of<double>(g, "matrix").length(1);
    grid.first.assign(first.span().begin(), first.span().end());
    grid.count.assign(count.span().begin(), count.span().end());
    grid.weight = points(g, "weight", n);
    grid.from_nose = from_nose(g, g.attr("matrix"), grid.weight, n);
    grid.fraction = points(g, "fraction", n);
    grid.barycentric = points(g, "barycentric", n);
    grid.set_steps();
    for (std::size_t degree = 0; degree <= grid.widest; ++degree) {
        Row row(grid.blocks);
        std::copy_n(series.data() + degree * n, n, row.row(0));
        grid.series.push_back(row);
    }
    return grid;
}

inline std::shared_ptr<const Swimmer> swimmer_from(const py::object& grid, const py::object& sections,
                                                   const py::object& stations, const std::string& friction,
                                                   bool resistive, std::size_t first_watched, bool wake,
                                                   bool inertia_of_water, const py::object& tail_water,
                                                   bool flow_gradient, double nose_mass, double nose_drag,
                                                   bool distributed_pressure, bool offset, double righting,
                                                   double gravity, const py::object& missed_drag)
{
    auto swimmer = std::make_shared<Swimmer>();
    swimmer->grid = grid_from(grid);
    const std::size_t n = swimmer->grid.nodes;
    swimmer->sections = sections_from(sections, n);
    const auto name = std::find(friction_names.begin(), friction_names.end(), friction);
    if (name == friction_names.end())
        throw py::value_error("friction is none of FRICTION_LAWS, got '" + friction + "'");
    swimmer->friction = static_cast<Friction>(name - friction_names.begin());
    swimmer->resistive = resistive, swimmer->first_watched = first_watched, swimmer->wake = wake ? 1.0 : 0.0;
    swimmer->inertia_of_water = inertia_of_water ? 1.0 : 0.0, swimmer->flow_gradient = flow_gradient;
    const Numbers water(tail_water, "tail_water");
    water.check_size(3, "tail_water");
    swimmer->tail.added2 = water.data()[0], swimmer->tail.added3 = water.data()[1];
    swimmer->tail.added_roll = water.data()[2];
    swimmer->nose_mass = nose_mass, swimmer->nose_drag = nose_drag,
    swimmer->distributed_pressure = distributed_pressure;
    swimmer->offset = offset, swimmer->righting = righting, swimmer->gravity = gravity;

    for (std::size_t speed = lateral; const py::handle each : missed_drag) {
        const Numbers table(each, "missed_drag");
        if (table.length(0) < 2) throw py::value_error("missed_drag must have two rows or more");
        table.check_size(table.length(0) * n, "missed_drag");
        for (std::size_t place = 0; place < table.length(0); ++place) {
            swimmer->missed_drag.at(speed).emplace_back(blocks_of(n));
            std::copy_n(table.data() + place * n, n, swimmer->missed_drag[speed].back().row(0));
        }
        ++speed;
    }

    const auto before = array_of<std::uint64_t>(stations, "nodes_before");
    const std::size_t m = swimmer->stations = before.size();
    swimmer->nodes_before.assign(before.span().begin(), before.span().end());
    swimmer->at_station = sections_from(stations.attr("sections"), m);
    swimmer->added2_slope = points(stations, "added2_slope", m);
    swimmer->added3_slope = points(stations, "added3_slope", m);
    swimmer->added_roll_slope = points(stations, "added_roll_slope", m);
    const py::object places = stations.attr("points");
    swimmer->to_station = from_nose(places, places.attr("matrix"), swimmer->grid.weight, n);
    const Row none(swimmer->grid.blocks);
    for (const py::handle rows : stations.attr("missed")) swimmer->missed.push_back(from_nose(places, rows, none, n));
    if (!swimmer->missed.empty() && swimmer->missed.size() != SectionPart::count)
        throw py::value_error("stations must have missed rows for each part of a section, or none");
    return swimmer;
}

// rows (m, 4 (n + s)), as `LawTables::set` takes them.
inline std::shared_ptr<const LawTables> tables_from(const std::vector<std::size_t>& axis, const py::object& rows,
                                                    std::size_t n, std::size_t s)
{
    const Numbers numbers(rows, "rows");
    const std::size_t m = axis.size();
    numbers.check_size(4 * m * (n + s), "rows");
    auto tables = std::make_shared<LawTables>(axis, n, s);
    for (std::size_t row = 0; row < m; ++row) tables->set(row, numbers.data() + row * tables->columns());
    return tables;
}

}  // namespace eel_core
