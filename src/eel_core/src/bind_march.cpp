// SPDX-License-Identifier: Apache-2.0
// The Python classes of marches, and of the modes of bodies that bend by themselves. A unit of its own: the code of
// single instants stays as it was compiled.
#include "bind_flow.hpp"
#include "bind_sampled.hpp"
#include "bound_march.hpp"

namespace eel_core {
namespace {

// The modes of a `ModeTable` (eel_dynamics/model/robot/compiled.py) on a grid with nodes at `x` [m].
std::shared_ptr<Modes> modes_from(const py::object& table, const py::object& x, const py::list& torques,
                                  const std::shared_ptr<LawOnGrid>& drive, const py::object& push)
{
    auto modes = std::make_shared<Modes>();
    const auto numbers = [&](const char* name, std::size_t size) {
        return Numbers::sized(table.attr(name), name, size);
    };
    const auto axis = array_of<std::int64_t>(table, "axis");
    const auto degree = Array<std::int64_t>::sized(table.attr("degree"), "degree", axis.size());
    const std::size_t n = modes->modes = axis.size(),
                      c = modes->coordinates = array_of<double>(table, "armature").size();
    if (degree.size() != n || c < n) throw py::value_error("modes must have a degree and an armature each");
    const auto start = numbers("start", n), end = numbers("end", n), limits = numbers("limits", 2 * n),
               stiffness = numbers("stop_stiffness", n), damping = numbers("stop_damping", n);
    const Numbers nodes(x, "x");
    const auto nodes_until = [places = nodes.span()](double place) {
        return static_cast<std::size_t>(std::ranges::upper_bound(places, place) - places.begin());
    };
    for (std::size_t m = 0; m < n; ++m) {
        const bool joint = degree.data()[m] < 0;
        const double first = start.data()[m], last = end.data()[m], span = joint ? 1.0 : last - first;
        const double low = limits.data()[2 * m], high = limits.data()[2 * m + 1];
        modes->axis.push_back(axis.data()[m] == 1 ? LawOnGrid::pitch : LawOnGrid::yaw);
        modes->first.push_back(nodes_until(first)), modes->last.push_back(nodes_until(last));
        modes->continuous.push_back(!joint), modes->span.push_back(span);
        // P_n has the norm span / (2 n + 1)
        modes->moment.push_back(joint ? 1.0 : static_cast<double>(2 * degree.data()[m] + 1) / span);
        if (std::isfinite(low) || std::isfinite(high))
            modes->stops.push_back({m, low, high, stiffness.data()[m], damping.data()[m]});
    }
    modes->armature = numbers("armature", c).vector(), modes->rest = numbers("rest", c).vector();
    modes->stiffness = numbers("stiffness", c * c).vector(), modes->damping = numbers("damping", c * c).vector();
    for (const py::handle motor : table.attr("motors")) {
        const auto number = [servo = py::object(motor.attr("servo"))](const char* name) {  // none: no limit
            return servo.attr(name).cast<std::optional<double>>().value_or(std::numeric_limits<double>::infinity());
        };
        const auto coordinate = motor.attr("coordinate").cast<std::size_t>();
        if (coordinate >= c) throw py::value_error("a servo must drive a coordinate");
        modes->servos.push_back(
            {coordinate, number("kp"), number("kd"), number("torque_limit"), number("speed_limit")});
    }
    modes->drive = drive;
    modes->push = Numbers::sized(push, "push", drive ? c * drive->tables->rows() : 0).vector();
    for (const py::handle each : torques) {
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

StepBounds bounds_from(const py::kwargs& given)
{
    StepBounds made{};
    for (const auto& [name, member] : step_bounds) {
        const double value = made.*member = given[name].cast<double>();
        // a fixed method has an infinite tolerance; a floor may be 0, or infinite where a power overflows
        const bool floor = member == &StepBounds::momentum_floor || member == &StepBounds::torque_floor;
        if (!(floor ? value >= 0.0 : value > 0.0) || (std::isinf(value) && !floor && member != &StepBounds::tolerance))
            throw py::value_error(std::string(name) + " must be finite and > 0, got " + std::to_string(value));
    }
    return made;
}

constexpr std::pair<const char*, Status> status_names[] = {{"marched", Status::marched},
                                                           {"not_finite", Status::not_finite},
                                                           {"step_too_small", Status::step_too_small},
                                                           {"singular", Status::singular},
                                                           {"too_many_steps", Status::too_many_steps},
                                                           {"unfinished", Status::unfinished}};

}  // namespace

void bind_marches(py::module_& module)
{
    py::list statuses(std::size(status_names));
    for (const auto& [name, status] : status_names) statuses[static_cast<std::size_t>(status)] = name;
    module.attr("STATUSES") = py::tuple(statuses);

    auto bounds = py::class_<StepBounds, std::shared_ptr<StepBounds>>(module, "StepBounds");
    share_in_copies(bounds);
    bounds.def(py::init(&bounds_from));
    for (const auto& [name, member] : step_bounds) bounds.def_readonly(name, member);

    auto modes = py::class_<Modes, std::shared_ptr<Modes>>(module, "Modes");
    share_in_copies(modes);
    modes.def(py::init(&modes_from), py::arg("table"), py::arg("x"), py::arg("torques"), py::arg("drive"),
              py::arg("push"));

    py::class_<PyMarch, std::shared_ptr<PyMarch>>(module, "March")
        .def(py::init<std::shared_ptr<Swimmer>, const std::string&, std::size_t, bool, std::shared_ptr<Modes>>(),
             needed("swimmer"), py::arg("method"), py::arg("order"), py::arg("planar"),
             py::arg("modes") = std::shared_ptr<Modes>())
        .def("__copy__", method(&PyMarch::copy))
        .def(
            "__deepcopy__", [](PyMarch& march, const py::dict&) { return march.copy(); }, needed("memo"))
        .def("state_as_bytes", method(&PyMarch::state_as_bytes))
        .def("set_state_from_bytes", method(&PyMarch::set_state_from_bytes), needed("state"))
        .def("change", method(&PyMarch::change), needed("swimmer"), py::arg("method"), py::arg("order"),
             py::arg("planar"), py::arg("modes") = std::shared_ptr<Modes>())
        .def("follow", method(&PyMarch::follow), needed("law"), py::arg("breakpoints"), needed("bounds"),
             py::arg("ledger"), py::arg("current"), py::arg("flow"), py::arg("smoothly"),
             py::arg("fin_angles") = py::list(), py::arg("reference") = py::none(), py::arg("wrenches") = py::list())
        .def("start", method(&PyMarch::start), py::arg("position"), py::arg("orientation"), py::arg("twist"),
             py::arg("x") = py::none(), py::arg("rate") = py::none())
        .def("set_state", method(&PyMarch::set_state), py::arg("position"), py::arg("orientation"), py::arg("twist"))
        .def("set_twist", method(&PyMarch::set_twist), py::arg("twist"))
        .def("twist", method(&PyMarch::twist))
        .def("set_slice", method(&PyMarch::set_slice), py::arg("nodes"))
        .def("advance", method(&PyMarch::advance), py::arg("time"))
        .def("record", method(&PyMarch::record), py::arg("times"), py::arg("first"), py::arg("whole"), py::arg("works"),
             py::arg("rows"), py::arg("wrench"), py::arg("load"), py::arg("until"))
        .def("observe", method(&PyMarch::observe), py::arg("whole"), py::arg("row"), py::arg("wrench"), py::arg("load"))
        .def("command", method(&PyMarch::command), py::arg("servo"), py::arg("kind"), py::arg("angle") = 0.0,
             py::arg("rate") = 0.0, py::arg("torque") = 0.0, py::arg("low") = -INFINITY, py::arg("high") = INFINITY)
        .def("to_blame", method(&PyMarch::to_blame), py::arg("singular"))
        .def_property_readonly("time", method(&PyMarch::time))
        .def_property_readonly("state", method(&PyMarch::state))
        .def_property_readonly("works", method(&PyMarch::works))
        .def_property_readonly("outside", method(&PyMarch::outside))
        .def_property_readonly("row", method(&PyMarch::row))
        .def_property_readonly("counts", method(&PyMarch::counts));

    bind_sampled_marches(module);
}

}  // namespace eel_core
