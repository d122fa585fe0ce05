// SPDX-License-Identifier: Apache-2.0
// A swimmer and the tables of its law, from objects of Python with arrays for attributes.
#pragma once

#include <string>

#include "from_python.hpp"

namespace eel_core {

// Of each of n points, a number or a compound, whose components are attributes with these names.
template <class Value = double>
Field<Value> field_from(const py::handle& object, std::initializer_list<const char*> names, std::size_t n)
{
    Field<Value> field(blocks_of(n));
    for (std::size_t row = 0; const char* const name : names) {
        const auto numbers = Numbers::sized(object.attr(name), name, n);
        std::copy_n(numbers.data(), n, field.row(row++));
    }
    return field;
}

inline Sections sections_from(const py::handle& s, std::size_t n)
{
    return {field_from<Section<double>>(
                s, {"mass", "added2", "added3", "inertia1", "inertia2", "inertia3", "added_roll"}, n),
            field_from(s, {"lever"}, n), field_from(s, {"net"}, n), field_from(s, {"displaced"}, n),
            field_from<DragSection<double>>(
                s, {"drag2", "drag3", "drag_roll", "laminar", "turbulent", "by_critical_speed", "segment"}, n)};
}

// `matrix`: rows for the m `points`, as those of `PanelRows`, whose panels rise, and again from the point `anew` on.
inline FromNose from_nose(const py::handle& points, std::size_t m, const py::handle& matrix, const Row& weight,
                          std::size_t nodes, std::size_t anew = 0)
{
    const auto fraction = Numbers::sized(points.attr("fraction"), "fraction", m);
    const std::size_t widest = array_of<double>(points, "matrix").length(1);
    const auto rows = Numbers::sized(matrix, "matrix", m * widest);
    const auto first = Array<std::uint64_t>::sized(points.attr("first"), "first", m),
               count = Array<std::uint64_t>::sized(points.attr("count"), "count", m);
    for (std::size_t i = 0; i < m; ++i) {
        const std::uint64_t begin = first.data()[i], size = count.data()[i];
        if (begin >= nodes || size > std::min<std::uint64_t>(widest, nodes - begin) ||
            (i > 0 && i != anew && begin < first.data()[i - 1]))
            throw py::value_error("first and count must be of panels one behind the other, within the nodes");
    }
    return FromNose({rows.span(), first.span(), count.span(), fraction.span()}, {weight.row(0), nodes});
}

inline Grid grid_from(const py::handle& g)
{
    Grid grid;
    const auto first = array_of<std::uint64_t>(g, "first"), count = array_of<std::uint64_t>(g, "count");
    const std::size_t n = first.size();
    if (n == 0) throw py::value_error("grid must have nodes, got none");
    const auto series = Numbers::sized(g.attr("series"), "series", (array_of<double>(g, "matrix").length(1) + 1) * n);
    grid.nodes = n, grid.blocks = blocks_of(n), grid.widest = array_of<double>(g, "matrix").length(1);
    grid.first = first.vector<std::size_t>(), grid.count = count.vector<std::size_t>();
    grid.weight = field_from(g, {"weight"}, n);
    grid.from_nose = from_nose(g, n, g.attr("matrix"), grid.weight, n);
    for (std::size_t i = 0; i < n; ++i)
        if (grid.first[i] > i || i - grid.first[i] >= grid.count[i])
            throw py::value_error("first and count must be of the panel that the node lies in");
    grid.fraction = field_from(g, {"fraction"}, n);
    grid.barycentric = field_from(g, {"barycentric"}, n);
    grid.set_steps();
    for (std::size_t degree = 0; degree <= grid.widest; ++degree) {
        Row row(grid.blocks);
        std::copy_n(series.data() + degree * n, n, row.row(0));
        grid.series.push_back(row);
    }
    return grid;
}

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
        if (node >= swimmer.grid.nodes) throw py::value_error("servos must have a node of the grid");
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
        const auto behind = t[11].cast<std::size_t>();
        if (node >= swimmer.grid.nodes || servo >= swimmer.servos.size() || behind > swimmer.stations)
            throw py::value_error("fins must have a node of the grid, a servo of those given, and a station");
        swimmer.fins.push_back({node, vector(1), vector(2), number(3), number(4), number(5), number(6), number(7),
                                number(8), servo, node + 1, behind, number(10)});
    }
}

// Gives the swimmer its appendages: (node or None at X = 0, arm (3,), drag (3,), whether by the speed, whether of the
// body, first station there or behind).
inline void add_appendages(Swimmer& swimmer, const py::list& appendages)
{
    for (const py::handle each : appendages) {
        const auto [node, arm, drag, by_speed, of_body, station] =
            each.cast<std::tuple<std::optional<std::size_t>, std::array<double, 3>, std::array<double, 3>, bool, bool,
                                 std::size_t>>();
        if (node && *node >= swimmer.grid.nodes) throw py::value_error("appendages must have a node of the grid");
        swimmer.appendages.push_back({node.value_or(Appendage::nose),
                                      {arm[0], arm[1], arm[2]},
                                      {drag[0], drag[1], drag[2]},
                                      by_speed,
                                      of_body,
                                      station});
    }
}

// Which physics is on, and its numbers, by their names in Python.
inline constexpr std::pair<const char*, bool Swimmer::*> switches[] = {
    {"resistive", &Swimmer::resistive},
    {"segmented", &Swimmer::segmented},
    {"flow_gradient", &Swimmer::flow_gradient},
    {"distributed_pressure", &Swimmer::distributed_pressure},
    {"offset", &Swimmer::offset}};
inline constexpr std::pair<const char*, double Swimmer::*> quantities[] = {
    {"wake", &Swimmer::wake},           {"inertia_of_water", &Swimmer::inertia_of_water},
    {"nose_mass", &Swimmer::nose_mass}, {"nose_drag", &Swimmer::nose_drag},
    {"righting", &Swimmer::righting},   {"gravity", &Swimmer::gravity}};

inline constexpr std::pair<const char*, Friction> friction_laws[] = {{"printed", Friction::printed},
                                                                     {"laminar", Friction::laminar},
                                                                     {"blended", Friction::blended},
                                                                     {"taylor", Friction::taylor}};

inline std::shared_ptr<Swimmer> swimmer_from(const py::object& grid, const py::object& sections,
                                             const py::object& stations, const py::kwargs& physics)
{
    auto swimmer = std::make_shared<Swimmer>();
    swimmer->grid = grid_from(grid);
    const std::size_t n = swimmer->grid.nodes;
    swimmer->sections = sections_from(sections, n);
    swimmer->friction = value_named(friction_laws, physics["friction"].cast<std::string>(), "friction");
    swimmer->first_watched = physics["first_watched"].cast<std::size_t>();
    for (const auto& [key, member] : switches) swimmer.get()->*member = physics[key].cast<bool>();
    for (const auto& [key, member] : quantities) swimmer.get()->*member = physics[key].cast<double>();
    const auto water = row_from<3>(physics["tail_water"], "tail_water");
    swimmer->tail.added2 = water[0], swimmer->tail.added3 = water[1], swimmer->tail.added_roll = water[2];

    for (std::size_t speed = lateral; const py::handle each : physics["missed_drag"]) {
        const auto table = Numbers::sized(each, "missed_drag", n * Numbers(each, "missed_drag").length(0));
        if (table.length(0) < 2) throw py::value_error("missed_drag must have two rows or more");
        for (std::size_t place = 0; place < table.length(0); ++place) {
            swimmer->missed_drag.at(speed).emplace_back(blocks_of(n));
            std::copy_n(table.data() + place * n, n, swimmer->missed_drag[speed].back().row(0));
        }
        ++speed;
    }

    const auto before = array_of<std::uint64_t>(stations, "nodes_before");
    const std::size_t m = swimmer->stations = before.size();
    swimmer->shown = physics["shown"].cast<std::size_t>();
    if (swimmer->shown != m && swimmer->first_sensor() >= m)
        throw py::value_error("shown must be the stations, or sensors follow from a whole stretch on");
    swimmer->nodes_before = before.vector<std::size_t>();
    for (const std::size_t nodes : swimmer->nodes_before)
        if (nodes > n) throw py::value_error("nodes_before must be at most the nodes, got " + std::to_string(nodes));
    swimmer->at_station = sections_from(stations.attr("sections"), m);
    swimmer->added2_slope = field_from(stations, {"added2_slope"}, m);
    swimmer->added3_slope = field_from(stations, {"added3_slope"}, m);
    swimmer->added_roll_slope = field_from(stations, {"added_roll_slope"}, m);
    const py::object places = stations.attr("points");
    const std::size_t anew = swimmer->first_sensor();
    swimmer->to_station = from_nose(places, m, places.attr("matrix"), swimmer->grid.weight, n, anew);
    const Row none(swimmer->grid.blocks);
    for (const py::handle rows : stations.attr("missed"))
        swimmer->missed.push_back(from_nose(places, m, rows, none, n, anew));
    if (!swimmer->missed.empty() && swimmer->missed.size() != SectionPart::count)
        throw py::value_error("stations must have missed rows for each part of a section, or none");
    add_fins(*swimmer, physics["fins"], physics["servos"]);
    add_appendages(*swimmer, physics["appendages"]);
    return swimmer;
}

// rows (m, 4 (n + s)), as `LawTables::set` takes them.
inline std::shared_ptr<LawTables> tables_from(const std::vector<std::size_t>& axis, const py::object& rows,
                                              std::size_t n, std::size_t s)
{
    constexpr std::size_t most = 1'000'000;
    check_count(n, 0, most, "nodes"), check_count(s, 0, most, "stations");
    const auto numbers = Numbers::sized(rows, "rows", 4 * axis.size() * (n + s));
    auto tables = std::make_shared<LawTables>(axis, n, s);
    for (std::size_t row = 0; row < axis.size(); ++row) tables->set(row, numbers.data() + row * tables->columns());
    return tables;
}

}  // namespace eel_core
