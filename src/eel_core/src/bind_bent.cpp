// SPDX-License-Identifier: Apache-2.0
// The Python classes of bodies with modes. A unit of its own: the code of bodies without modes stays as it was
// compiled.
#include "bind_bent.hpp"

#include <algorithm>
#include <array>

#include "bind_fins.hpp"
#include "bind_flow.hpp"
#include "bound_march.hpp"
#include "eel_core/bending/bent_march.hpp"

namespace eel_core {
namespace {

std::vector<double> numbers_from(const py::handle& object, const char* name, std::size_t size)
{
    const Numbers numbers = array_of<double>(object, name);
    numbers.check_size(size, name);
    return {numbers.data(), numbers.data() + size};
}

// Its attributes are those of `ModesOnGrid` (eel_model/robot/on_grid.py).
std::shared_ptr<const Modes> modes_from(const py::object& m)
{
    auto modes = std::make_shared<Modes>();
    const auto axis = array_of<std::uint64_t>(m, "axis"), first = array_of<std::uint64_t>(m, "first"),
               last = array_of<std::uint64_t>(m, "last"), continuous = array_of<std::uint64_t>(m, "continuous");
    modes->modes = axis.size();
    if (first.size() != modes->modes || last.size() != modes->modes || continuous.size() != modes->modes)
        throw py::value_error("modes must have an axis, a first and a last node each");
    for (const std::uint64_t each : axis.span()) modes->axis.push_back(each == 0 ? LawOnGrid::pitch : LawOnGrid::yaw);
    modes->first.assign(first.span().begin(), first.span().end());
    modes->last.assign(last.span().begin(), last.span().end());
    modes->continuous.assign(continuous.span().begin(), continuous.span().end());
    modes->span = numbers_from(m, "span", modes->modes), modes->moment = numbers_from(m, "moment", modes->modes);
    const std::size_t c = modes->coordinates = array_of<double>(m, "inertia").size();
    if (c < modes->modes) throw py::value_error("modes must have an inertia each");
    modes->inertia = numbers_from(m, "inertia", c), modes->rest = numbers_from(m, "rest", c);
    modes->stiffness = numbers_from(m, "stiffness", c * c), modes->damping = numbers_from(m, "damping", c * c);
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
        GivenTorque& given = modes->torques.emplace_back();
        given.coordinate = torque[0].cast<std::size_t>();
        if (given.coordinate >= c) throw py::value_error("a torque must drive a coordinate");
        if (torque.size() == 2) {
            given.function = [function = py::object(torque[1])](double time) {
                const py::gil_scoped_acquire locked;
                return function(time).cast<double>();
            };
            continue;
        }
        const Numbers knots(torque[1], "knots"), cubics(torque[2], "cubics");
        if (knots.size() < 2) throw py::value_error("knots must be two or more");
        cubics.check_size(4 * (knots.size() - 1), "cubics");
        given.knots.assign(knots.data(), knots.data() + knots.size());
        given.cubics.assign(cubics.data(), cubics.data() + cubics.size());
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
    void follow(const std::shared_ptr<const LawOnGrid>& law, const py::object& reference,
                std::shared_ptr<const LawOnGrid> drive, const py::object& push, std::vector<double> breakpoints,
                const StepBounds& bounds, double torque_floor, bool ledger, const py::object& current,
                std::shared_ptr<const Flow> flow, bool smoothly, const py::list& fin_angles)
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
        const Numbers servos(reference, "reference"), pushed(push, "push");
        servos.check_size(modes.servos.size() * settings.law.first_mode, "reference");
        settings.law.reference.assign(servos.data(), servos.data() + servos.size());
        if (settings.law.drive) {
            pushed.check_size(modes.coordinates * settings.law.drive->tables->rows(), "push");
            settings.law.push.assign(pushed.data(), pushed.data() + pushed.size());
        }
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
        const Numbers instants(times, "times"), into(whole, "whole", true), works_into(works, "works", true),
            rows_into(rows, "rows", true);
        const Profiles profiles = profiles_for(into, instants.size(), wrench, load);
        works_into.check_size(std::tuple_size_v<WorkDone> * instants.size(), "works");
        rows_into.check_size(march_.row().size() * instants.size(), "rows");
        const Driven in_use(*this);
        std::size_t done = 0;
        Status status = Status::marched;
        {
            const py::gil_scoped_release unlocked;
            status = march_.record(instants.span(), first, until, profiles, into.data(), works_into.data(),
                                   rows_into.data(), done);
        }
        return py::make_tuple(done, static_cast<int>(status));
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
        const Numbers into(whole, "whole", true), row_into(row, "row", true);
        const Profiles profiles = profiles_for(into, 1, wrench, load);
        row_into.check_size(march_.row().size(), "row");
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
        const Numbers numbers(object, name);
        numbers.check_size(march_.modes().coordinates, name);
        return {numbers.data(), numbers.data() + numbers.size()};
    }
};

py::dict row_layout(const PyBentMarch& march)
{
    const CoordinateRow row = march.march().row();
    py::dict places;
    const auto put_place = [&](const char* name, std::size_t begin, std::size_t count) {
        places[name] = py::make_tuple(begin, begin + count);
    };
    put_place("x", row.x(), row.coordinates), put_place("rate", row.rate(), row.coordinates);
    put_place("acceleration", row.acceleration(), row.coordinates), put_place("moment", row.moment(), row.modes);
    put_place("torque", row.torque(), row.servos), put_place("pushing", row.pushing(), row.coordinates);
    constexpr const char* singles[] = {"elastic", "rotors", "motor_power", "damping_power", "damping_work"};
    for (std::size_t k = 0; k < CoordinateRow::singles; ++k) put_place(singles[k], row.single() + k, 1);
    return places;
}

}  // namespace

void bind_bent_marches(py::module_& module)
{
    py::class_<Modes, std::shared_ptr<Modes>>(module, "Modes")
        .def(py::init([](const py::object& modes) { return std::const_pointer_cast<Modes>(modes_from(modes)); }),
             py::arg("modes"))
        .def("__copy__", [](const py::object& self) { return self; })
        .def("__deepcopy__", [](const py::object& self, const py::dict&) { return self; }, py::arg("memo"));

    auto marches = py::class_<PyBentMarch>(module, "BentMarch");
    bind_what_marches_share(marches);
    marches
        .def(py::init<std::shared_ptr<Swimmer>, std::shared_ptr<Modes>, bool>(), py::arg("swimmer"), py::arg("modes"),
             py::arg("planar"))
        .def("change", &PyBentMarch::change, py::arg("swimmer"), py::arg("modes"), py::arg("planar"))
        .def(
            "follow",
            [](PyBentMarch& march, const std::shared_ptr<LawOnGrid>& law, const py::object& reference,
               std::shared_ptr<LawOnGrid> drive, const py::object& push, std::vector<double> breakpoints,
               const StepBounds& bounds, double torque_floor, bool ledger, const py::object& current,
               std::shared_ptr<Flow> flow, bool smoothly, const py::list& fin_angles) {
                march.follow(law, reference, std::move(drive), push, std::move(breakpoints), bounds, torque_floor,
                             ledger, current, std::move(flow), smoothly, fin_angles);
            },
            py::arg("law"), py::arg("reference"), py::arg("drive"), py::arg("push"), py::arg("breakpoints"),
            py::arg("bounds"), py::arg("torque_floor"), py::arg("ledger"), py::arg("current"), py::arg("flow"),
            py::arg("smoothly"), py::arg("fin_angles") = py::list())
        .def("start", &PyBentMarch::start, py::arg("position"), py::arg("orientation"), py::arg("twist"), py::arg("x"),
             py::arg("rate"))
        .def("record", &PyBentMarch::record, py::arg("times"), py::arg("first"), py::arg("whole"), py::arg("works"),
             py::arg("rows"), py::arg("wrench"), py::arg("load"), py::arg("until"))
        .def("observe", &PyBentMarch::observe, py::arg("whole"), py::arg("row"), py::arg("wrench"), py::arg("load"))
        .def("command", &PyBentMarch::command, py::arg("servo"), py::arg("kind"), py::arg("value"))
        .def("singular_mode", &PyBentMarch::singular_mode)
        .def_property_readonly("hardest", [](const PyBentMarch& march) { return march.march().hardest(); })
        .def_property_readonly("coordinates",
                               [](const PyBentMarch& march) { return list_of(march.march().coordinates()); })
        .def_property_readonly("rates", [](const PyBentMarch& march) { return list_of(march.march().rates()); })
        .def_property_readonly("row", &row_layout);
}

}  // namespace eel_core
