// SPDX-License-Identifier: Apache-2.0
// The Python classes of bodies with modes. A unit of its own: the code of bodies without modes stays as it was
// compiled.
#include <algorithm>
#include <array>

#include "bind_flow.hpp"
#include "bound_march.hpp"
#include "eel_core/bending/bent_march.hpp"

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

class PyBentMarch : public BoundMarch<BentMarch> {
  public:
    PyBentMarch(std::shared_ptr<const Swimmer> swimmer, const std::shared_ptr<const Modes>& modes, bool planar)
        : BoundMarch(false, checked(std::move(swimmer), *modes), modes, planar)
    {
    }

    std::unique_ptr<PyBentMarch> copy()
    {
        const InUse in_use(in_use_);
        return std::unique_ptr<PyBentMarch>(new PyBentMarch(march_, has_law_));
    }
    void change(std::shared_ptr<const Swimmer> swimmer, const std::shared_ptr<const Modes>& modes, bool planar)
    {
        const InUse in_use(in_use_);
        has_law_ = false;
        march_.change(checked(std::move(swimmer), *modes), modes, planar);
    }
    void follow(const std::shared_ptr<LawOnGrid>& law, const py::object& reference, std::shared_ptr<LawOnGrid> drive,
                const py::object& push, std::vector<double> breakpoints, const StepBounds& bounds, double torque_floor,
                bool ledger, const py::object& current, std::shared_ptr<Flow> flow, bool smoothly,
                const py::list& fin_angles)
    {
        const InUse in_use(in_use_);
        const Modes& modes = march_.modes();
        const std::size_t rows = law->tables->rows();
        if (rows < modes.modes || law->tables->node.blocks != march_.swimmer().grid.blocks)
            throw py::value_error("law must be tabulated on the nodes of the swimmer, with the modes as its last rows");
        BentSettings settings{{*law, rows - modes.modes, {}, std::move(drive), {}, {}},
                              std::move(breakpoints),
                              bounds,
                              torque_floor,
                              ledger,
                              water_from(current, std::move(flow))};
        settings.law.law.fins = angles_from(fin_angles);
        const std::size_t imposed = modes.servos.size() * settings.law.first_mode;
        settings.law.reference = Numbers::sized(reference, "reference", imposed).vector();
        if (const auto& muscles = settings.law.drive)
            settings.law.push = Numbers::sized(push, "push", modes.coordinates * muscles->tables->rows()).vector();
        smoothly &= has_law_;
        has_law_ = true;
        march_.follow(std::move(settings), smoothly);
    }
    double start(const py::object& position, const py::object& orientation, const py::object& twist,
                 const py::object& x, const py::object& rate)
    {
        const Driven in_use(*this);
        return march_.start(vector_from(position, "position"), orientation_from(orientation),
                            twist_from(twist, "twist"), coordinates_from(x, "x"), coordinates_from(rate, "rate"));
    }
    py::tuple record(const py::object& times, std::size_t first, const py::object& whole, const py::object& works,
                     const py::object& rows, bool wrench, bool load, double until)
    {
        const Numbers instants(times, "times");
        const auto rows_into = Numbers::sized(rows, "rows", march_.row().size() * instants.size(), true);
        const auto record = [&](const Profiles& profiles, double* into, double* works_into, std::size_t& done) {
            return march_.record(instants.span(), first, until, profiles, into, works_into, rows_into.data(), done);
        };
        return recorded(instants.size(), whole, works, wrench, load, record);
    }
    void command(std::size_t servo, const std::string& kind, double value)
    {
        const Driven in_use(*this);
        constexpr std::array kinds{"law", "angle", "rate", "torque"};
        const auto* const found = std::find(kinds.begin(), kinds.end(), kind);
        if (servo >= march_.modes().servos.size() || found == kinds.end())
            throw py::value_error("a command must be for a servo, and of a known kind");
        march_.command(servo, static_cast<Command::Kind>(found - kinds.begin()), value);
    }
    bool observe(const py::object& whole, const py::object& row, bool wrench, bool load)
    {
        const Profiles profiles = profiles_of(1, wrench, load);
        const Numbers into = room_for(profiles, whole);
        const auto row_into = Numbers::sized(row, "row", march_.row().size(), true);
        const Driven in_use(*this);
        return march_.observe(profiles, into.data(), 0, row_into.data());
    }
    std::optional<std::size_t> singular_mode()
    {
        const Driven in_use(*this);
        return march_.singular_mode();
    }
    const BentMarch& march() const { return march_; }

  private:
    PyBentMarch(const BentMarch& march, bool has_law) : BoundMarch(has_law, march) {}

    static std::shared_ptr<const Swimmer> checked(std::shared_ptr<const Swimmer> swimmer, const Modes& modes)
    {
        for (std::size_t m = 0; m < modes.modes; ++m)
            if (modes.first[m] >= modes.last[m] || modes.last[m] > swimmer->grid.nodes)
                throw py::value_error("modes must have nodes of the grid");
        return swimmer;
    }
    std::vector<double> coordinates_from(const py::object& object, const char* name) const
    {
        return Numbers::sized(object, name, march_.modes().coordinates).vector();
    }
};

py::dict row_layout(const PyBentMarch& march)
{
    const CoordinateRow row = march.march().row();
    py::dict places;
    for (std::size_t q = 0; q < CoordinateRow::quantities; ++q)
        places[CoordinateRow::names[q]] = py::make_tuple(row.begin[q], row.begin[q + 1]);
    return places;
}

}  // namespace

void bind_bent_marches(py::module_& module)
{
    auto modes = py::class_<Modes, std::shared_ptr<Modes>>(module, "Modes");
    share_in_copies(modes);
    modes.def(py::init(&modes_from), py::arg("modes"));

    auto marches = py::class_<PyBentMarch>(module, "BentMarch");
    bind_what_marches_share(marches);
    marches
        .def(py::init<std::shared_ptr<Swimmer>, std::shared_ptr<Modes>, bool>(), py::arg("swimmer"), py::arg("modes"),
             py::arg("planar"))
        .def("change", &PyBentMarch::change, py::arg("swimmer"), py::arg("modes"), py::arg("planar"))
        .def("follow", &PyBentMarch::follow, py::arg("law"), py::arg("reference"), py::arg("drive"), py::arg("push"),
             py::arg("breakpoints"), py::arg("bounds"), py::arg("torque_floor"), py::arg("ledger"), py::arg("current"),
             py::arg("flow"), py::arg("smoothly"), py::arg("fin_angles") = py::list())
        .def("start", &PyBentMarch::start, py::arg("position"), py::arg("orientation"), py::arg("twist"), py::arg("x"),
             py::arg("rate"))
        .def("record", &PyBentMarch::record, py::arg("times"), py::arg("first"), py::arg("whole"), py::arg("works"),
             py::arg("rows"), py::arg("wrench"), py::arg("load"), py::arg("until"))
        .def("observe", &PyBentMarch::observe, py::arg("whole"), py::arg("row"), py::arg("wrench"), py::arg("load"))
        .def("command", &PyBentMarch::command, py::arg("servo"), py::arg("kind"), py::arg("value"))
        .def("singular_mode", &PyBentMarch::singular_mode)
        .def_property_readonly("hardest", [](const PyBentMarch& march) { return march.march().hardest(); })
        .def_property_readonly("coordinates", [](const PyBentMarch& march) { return march.march().coordinates(); })
        .def_property_readonly("rates", [](const PyBentMarch& march) { return march.march().rates(); })
        .def_property_readonly("row", &row_layout);
}

}  // namespace eel_core
