// SPDX-License-Identifier: Apache-2.0
// The Python classes of marches, and of the modes of bodies that bend by themselves. A unit of its own: the code of
// single instants stays as it was compiled.
#include "bind_flow.hpp"
#include "bind_sampled.hpp"
#include "bound_march.hpp"

namespace eel_core {
namespace {

// Its attributes are those of `ModesOnGrid` (eel_dynamics/simulation/bending/modes_on_grid.py).
std::shared_ptr<Modes> modes_from(const py::object& m)
{
    auto modes = std::make_shared<Modes>();
    const auto numbers = [&](const char* name, std::size_t size) {
        return Numbers::sized(m.attr(name), name, size).vector();
    };
    const auto axis = array_of<std::uint64_t>(m, "axis"), first = array_of<std::uint64_t>(m, "first"),
               last = array_of<std::uint64_t>(m, "last"), continuous = array_of<std::uint64_t>(m, "continuous");
    modes->modes = axis.size();
    if (first.size() != modes->modes || last.size() != modes->modes || continuous.size() != modes->modes)
        throw py::value_error("modes must have an axis, a first and a last node each");
    for (const std::uint64_t each : axis.span()) modes->axis.push_back(each == 0 ? LawOnGrid::pitch : LawOnGrid::yaw);
    modes->first = first.vector<std::size_t>(), modes->last = last.vector<std::size_t>();
    modes->continuous = continuous.vector<bool>();
    modes->span = numbers("span", modes->modes), modes->moment = numbers("moment", modes->modes);
    const std::size_t c = modes->coordinates = array_of<double>(m, "inertia").size();
    if (c < modes->modes) throw py::value_error("modes must have an inertia each");
    modes->inertia = numbers("inertia", c), modes->rest = numbers("rest", c);
    modes->stiffness = numbers("stiffness", c * c), modes->damping = numbers("damping", c * c);
    for (const py::handle each : m.attr("servos")) {
        const auto [at, kp, kd, torque, speed] = each.cast<std::tuple<std::size_t, double, double, double, double>>();
        if (at >= c) throw py::value_error("a servo must drive a coordinate");
        modes->servos.push_back({at, kp, kd, torque, speed});
    }
    for (const py::handle each : m.attr("stops")) {
        const auto [at, low, high, k, d] = each.cast<std::tuple<std::size_t, double, double, double, double>>();
        if (at >= modes->modes) throw py::value_error("a stop must limit a mode");
        modes->stops.push_back({at, low, high, k, d});
    }
    modes->drive = m.attr("drive").cast<std::shared_ptr<LawOnGrid>>();
    modes->push = numbers("push", modes->drive ? c * modes->drive->tables->rows() : 0);
    for (const py::handle each : m.attr("torques")) {
        const auto torque = each.cast<py::tuple>();
        const auto coordinate = torque[0].cast<std::size_t>();
        if (coordinate >= c) throw py::value_error("a torque must drive a coordinate");
        if (torque.size() == 2)
            modes->torques.push_back({coordinate, [function = py::object(torque[1])](double time) {
                                          const py::gil_scoped_acquire locked;
                                          return function(time).cast<double>();
                                      }});
        else
            modes->torques.push_back({coordinate, [cubics = cubics_from<double>(torque[1], torque[2])](double time) {
                                          return cubics.at(time)[0];
                                      }});
    }
    return modes;
}

// Members of `StepBounds` by their names in Python.
constexpr std::pair<const char*, double StepBounds::*> step_bounds[] = {{"tolerance", &StepBounds::tolerance},
                                                                        {"longest", &StepBounds::longest},
                                                                        {"smallest", &StepBounds::smallest},
                                                                        {"length", &StepBounds::length},
                                                                        {"momentum_floor", &StepBounds::momentum_floor},
                                                                        {"part_of_span", &StepBounds::part_of_span},
                                                                        {"most_steps", &StepBounds::most_steps},
                                                                        {"spare_steps", &StepBounds::spare_steps},
                                                                        {"torque_floor", &StepBounds::torque_floor}};

}  // namespace

void bind_marches(py::module_& module)
{
    module.attr("STATUSES") =
        py::make_tuple("marched", "not_finite", "step_too_small", "singular", "too_many_steps", "unfinished");

    auto bounds = py::class_<StepBounds>(module, "StepBounds");
    share_in_copies(bounds);
    bounds.def(py::init([](const py::kwargs& given) {
        StepBounds made{};
        for (const auto& [name, member] : step_bounds) made.*member = given[name].cast<double>();
        return made;
    }));
    for (const auto& [name, member] : step_bounds) bounds.def_readonly(name, member);

    auto modes = py::class_<Modes, std::shared_ptr<Modes>>(module, "Modes");
    share_in_copies(modes);
    modes.def(py::init(&modes_from), py::arg("modes"));

    const auto of_present = [](auto member) {
        return [member](PyMarch& march) { return march.march().now().*member; };
    };
    py::class_<PyMarch>(module, "March")
        .def(py::init<std::shared_ptr<Swimmer>, const std::string&, std::size_t, bool, std::shared_ptr<Modes>>(),
             py::arg("swimmer"), py::arg("method"), py::arg("order"), py::arg("planar"),
             py::arg("modes") = std::shared_ptr<Modes>())
        .def("__copy__", &PyMarch::copy)
        .def(
            "__deepcopy__", [](PyMarch& march, const py::dict&) { return march.copy(); }, py::arg("memo"))
        .def("change", &PyMarch::change, py::arg("swimmer"), py::arg("method"), py::arg("order"), py::arg("planar"),
             py::arg("modes") = std::shared_ptr<Modes>())
        .def("follow", &PyMarch::follow, py::arg("law"), py::arg("breakpoints"), py::arg("bounds"), py::arg("ledger"),
             py::arg("current"), py::arg("flow"), py::arg("smoothly"), py::arg("fin_angles") = py::list(),
             py::arg("reference") = py::none())
        .def("start", &PyMarch::start, py::arg("position"), py::arg("orientation"), py::arg("twist"),
             py::arg("x") = py::none(), py::arg("rate") = py::none())
        .def("set_state", &PyMarch::set_state, py::arg("position"), py::arg("orientation"), py::arg("twist"))
        .def("set_twist", &PyMarch::set_twist, py::arg("twist"))
        .def("twist", &PyMarch::twist)
        .def("set_slice", &PyMarch::set_slice, py::arg("nodes"))
        .def("advance", &PyMarch::advance, py::arg("time"))
        .def("record", &PyMarch::record, py::arg("times"), py::arg("first"), py::arg("whole"), py::arg("works"),
             py::arg("rows"), py::arg("wrench"), py::arg("load"), py::arg("until"))
        .def("observe", &PyMarch::observe, py::arg("whole"), py::arg("row"), py::arg("wrench"), py::arg("load"))
        .def("command", &PyMarch::command, py::arg("servo"), py::arg("kind"), py::arg("value"))
        .def("singular_mode", &PyMarch::singular_mode)
        .def_property_readonly("time", of_present(&Present::time))
        .def_property_readonly("state", [](PyMarch& march) { return shown(march.march().now().state); })
        .def_property_readonly("works", of_present(&Present::works))
        .def_property_readonly("coordinates", of_present(&Present::x))
        .def_property_readonly("rates", of_present(&Present::rate))
        .def_property_readonly("outside", &PyMarch::outside)
        .def_property_readonly("row", &PyMarch::row)
        .def_property_readonly("hardest", [](PyMarch& march) { return march.march().hardest(); })
        .def_property_readonly("counts", [](PyMarch& march) { return tuple_of(march.march().counts()); });

    bind_sampled_marches(module);
}

}  // namespace eel_core
