// SPDX-License-Identifier: Apache-2.0
// The Python module. EEL_CORE_MODULE is its name: one for each level of the processor.
#include <pybind11/pybind11.h>

#include <sstream>

#include "bind_flow.hpp"
#include "bind_sampled.hpp"
#include "bind_splines.hpp"
#include "bound_march.hpp"
#include "eel_core/build_info.hpp"
#include "eel_core/march/instant.hpp"
#include "from_python.hpp"
#include "swimmer_from.hpp"

namespace py = pybind11;
using namespace eel_core;

namespace {

py::dict build_info_as_dict()
{
    const BuildInfo info = build_info();
    constexpr const char* pybind11 =
        PYBIND11_TOSTRING(PYBIND11_VERSION_MAJOR) "." PYBIND11_TOSTRING(PYBIND11_VERSION_MINOR);
    return py::dict(py::arg("level") = info.level, py::arg("compiler") = info.compiler, py::arg("flags") = info.flags,
                    py::arg("sanitizers") = info.sanitizers, py::arg("pybind11") = pybind11);
}

// Where the quantities of samples lie in one array: name -> (begin, instants, numbers of an instant).
py::dict layout(std::size_t samples, std::size_t stations, bool wrench, bool load, std::size_t fins)
{
    std::istringstream names(
        "position orientation twist head_acceleration center_of_mass energies powers closure backbone "
        "section_orientation curvature curvature_rate torque force fluid_force resistive_force tail_force nose_force "
        "wake_momentum_rate fin_angle fin_force");
    const Profiles profiles(samples, stations, wrench, load, fins);
    py::dict result;
    std::string name;
    for (std::size_t q = 0; names >> name; ++q) {
        const int of = profiles.along_body(q) ? 1 : profiles.of_fins(q) ? 2 : 0;
        result[name.c_str()] = py::make_tuple(profiles.begin[q], profiles.instants(q), Profiles::width_of[q], of);
    }
    return result;
}

Wave wave_from(const py::tuple& wave)
{
    Wave result{wave[0].cast<double>(), {}, wave[2].cast<std::size_t>(), wave[3].cast<std::size_t>()};
    for (const py::handle factor : wave[1]) {
        auto& ramps = result.factors.emplace_back();
        for (const py::handle ramp : factor) {
            const auto [start, end, delta] = ramp.cast<std::tuple<double, double, double>>();
            ramps.push_back({start, end, delta});
        }
    }
    return result;
}

Quintic quintic_from(const py::object& quintic)
{
    if (quintic.is_none()) return {};
    const auto [row, start, end] = quintic.cast<std::tuple<std::size_t, double, double>>();
    return {row, start, end};
}

std::shared_ptr<LawOnGrid> law_from(std::shared_ptr<LawTables> tables, double origin, const py::list& waves,
                                    const py::object& segment, const py::object& blend)
{
    auto law = std::make_shared<LawOnGrid>();
    law->tables = std::move(tables), law->origin = origin;
    for (const py::handle wave : waves) law->waves.push_back(wave_from(wave.cast<py::tuple>()));
    law->segment = quintic_from(segment), law->blend = quintic_from(blend);
    const std::size_t rows = law->tables->rows();
    const auto check = [&](std::size_t last) {
        if (last >= rows)
            throw py::value_error("law has " + std::to_string(rows) + " rows, and wants row " + std::to_string(last));
    };
    for (const Wave& wave : law->waves) check(wave.sine), check(wave.cosine);
    if (law->segment.row != Quintic::none) check(law->segment.row + 11);
    if (law->blend.row != Quintic::none) check(law->blend.row + 5);
    return law;
}

std::array<std::vector<double>, 3> factors_at(const LawOnGrid& law, double time)
{
    std::vector<Jet> factor(law.tables->rows());
    law.set_factors(time, factor);
    std::array<std::vector<double>, 3> result;
    for (const Jet& jet : factor)
        for (std::size_t derivative = 0; derivative < 3; ++derivative) result[derivative].push_back(jet[derivative]);
    return result;
}

void check_fits(const LawOnGrid& law, const Swimmer& swimmer)
{
    const LawTables& t = *law.tables;
    const std::size_t rows = t.rows(), nodes = swimmer.grid.blocks, stations = blocks_of(swimmer.stations);
    const auto fits = [&](const auto& table, std::size_t blocks) {
        return table.lanes.size() == rows * blocks && (rows == 0 || table.blocks == blocks);
    };
    if (!(fits(t.node, nodes) && fits(t.angle, nodes) && fits(t.moments, nodes) && fits(t.station, stations) &&
          fits(t.station_moments, stations)))
        throw py::value_error("law must be tabulated on the nodes and stations of the swimmer");
}

class PyMarch : public BoundMarch<March> {
  public:
    PyMarch(const std::shared_ptr<const Swimmer>& swimmer, const std::string& method, std::size_t order, bool planar)
        : BoundMarch(false, swimmer, Method::of(method, order), planar)
    {
    }

    // A march of its own, in the same state.
    std::unique_ptr<PyMarch> copy()
    {
        const InUse in_use(in_use_);
        return std::unique_ptr<PyMarch>(new PyMarch(march_, has_law_));
    }
    void change(const std::shared_ptr<const Swimmer>& swimmer, const std::string& method, std::size_t order,
                bool planar)
    {
        const InUse in_use(in_use_);
        has_law_ = false;
        march_.change(swimmer, Method::of(method, order), planar);
    }
    void follow(const std::shared_ptr<const LawOnGrid>& law, std::vector<double> breakpoints, const StepBounds& bounds,
                bool ledger, const py::object& current, std::shared_ptr<Flow> flow, bool smoothly,
                const py::list& fin_angles)
    {
        check_fits(*law, march_.swimmer());
        LawOnGrid own = *law;
        own.fins = angles_from(fin_angles);
        const InUse in_use(in_use_);
        smoothly &= has_law_;
        has_law_ = true;
        march_.follow({std::move(own), std::move(breakpoints), bounds, ledger, water_from(current, std::move(flow))},
                      smoothly);
    }
    double start(const py::object& position, const py::object& orientation, const py::object& twist)
    {
        const Driven in_use(*this);
        return march_.start(vector_from(position, "position"), orientation_from(orientation),
                            twist_from(twist, "twist"));
    }
    py::tuple record(const py::object& times, std::size_t first, const py::object& whole, const py::object& works,
                     bool wrench, bool load, double until)
    {
        const Numbers instants(times, "times");
        const auto record = [&](const Profiles& profiles, double* into, double* works_into, std::size_t& done) {
            return march_.record(instants.span(), first, until, profiles, into, works_into, done);
        };
        return recorded(instants.size(), whole, works, wrench, load, record);
    }
    bool observe(const py::object& whole, bool wrench, bool load)
    {
        const Profiles profiles = profiles_of(1, wrench, load);
        const Numbers into = room_for(profiles, whole);
        const Driven in_use(*this);
        return march_.observe(Observer(march_.swimmer(), profiles, into.data()), 0);
    }

  private:
    PyMarch(const March& march, bool has_law) : BoundMarch(has_law, march) {}
};

// Members of `StepBounds` by their names in Python.
constexpr std::pair<const char*, double StepBounds::*> step_bounds[] = {{"tolerance", &StepBounds::tolerance},
                                                                        {"longest", &StepBounds::longest},
                                                                        {"smallest", &StepBounds::smallest},
                                                                        {"length", &StepBounds::length},
                                                                        {"momentum_floor", &StepBounds::momentum_floor},
                                                                        {"part_of_span", &StepBounds::part_of_span},
                                                                        {"most_steps", &StepBounds::most_steps},
                                                                        {"spare_steps", &StepBounds::spare_steps}};

// Evaluates the rate of a state again and again, for benchmarks.
template <class M>
void repeat_rate_in(const Swimmer& swimmer, const LawOnGrid& law, double time, const State& y, std::size_t count,
                    const Water& water)
{
    Workspace<M> work(swimmer);
    State rate{};
    for (std::size_t k = 0; k < count; ++k) rate_of_state(swimmer, law, water, time, y, work, rate);
}
void repeat_rate(const Swimmer& swimmer, bool planar, const LawOnGrid& law, double time, const py::object& state,
                 std::size_t count, std::shared_ptr<Flow> flow)
{
    const State y = state_from(state);
    const py::gil_scoped_release unlocked;
    (planar ? repeat_rate_in<Plane> : repeat_rate_in<Space>)(swimmer, law, time, y, count, {{}, std::move(flow)});
}

std::array<std::array<double, 6>, 6> inertia_at(Instant& instant, const LawOnGrid& law, double time)
{
    const auto inertia = instant.inertia(law, time);
    std::array<std::array<double, 6>, 6> rows;
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j <= i; ++j) rows[i][j] = rows[j][i] = inertia.lower[inertia.at(i, j)];
    return rows;
}

}  // namespace

PYBIND11_MODULE(EEL_CORE_MODULE, module)
{
    // One name for all levels: what is pickled by one can be read by another.
    module.attr("__name__") = "eel_core._core";
    module.def("build_info", &build_info_as_dict,
               "How this module was compiled: level, compiler, flags, sanitizers, pybind11.");
    module.def("layout", &layout, py::arg("samples"), py::arg("stations"), py::arg("wrench"), py::arg("load"),
               py::arg("fins") = 0);
    module.attr("MOST_SERVOS") = most_servos;
    module.attr("FRICTION_LAWS") = py::tuple(py::cast(friction_names));
    module.attr("STATUSES") =
        py::make_tuple("marched", "not_finite", "step_too_small", "singular", "too_many_steps", "unfinished");

    auto swimmer = py::class_<Swimmer, std::shared_ptr<Swimmer>>(module, "Swimmer");
    share_in_copies(swimmer);
    swimmer.def(py::init(&swimmer_from), py::arg("grid"), py::arg("sections"), py::arg("stations"));

    auto flow_class = py::class_<Flow, std::shared_ptr<Flow>>(module, "Flow");
    share_in_copies(flow_class);
    flow_class.def(py::init(&flow_from), py::arg("sources")).def("at", &put_flow, py::arg("time"), py::arg("rows"));

    auto law_tables = py::class_<LawTables, std::shared_ptr<LawTables>>(module, "LawTables");
    share_in_copies(law_tables);
    law_tables.def(py::init(&tables_from), py::arg("axis"), py::arg("rows"), py::arg("nodes"), py::arg("stations"));

    auto curvature_law = py::class_<LawOnGrid, std::shared_ptr<LawOnGrid>>(module, "LawOnGrid");
    share_in_copies(curvature_law);
    curvature_law
        .def(py::init(&law_from), py::arg("tables"), py::arg("origin"), py::arg("waves"), py::arg("segment"),
             py::arg("blend"))
        .def("factors", &factors_at, py::arg("time"));

    auto bounds = py::class_<StepBounds>(module, "StepBounds");
    share_in_copies(bounds);
    bounds.def(py::init([](const py::kwargs& given) {
        StepBounds made{};
        for (const auto& [name, member] : step_bounds) made.*member = given[name].cast<double>();
        return made;
    }));
    for (const auto& [name, member] : step_bounds) bounds.def_readonly(name, member);

    auto marches = py::class_<PyMarch>(module, "March");
    bind_what_marches_share(marches);
    marches
        .def(py::init<std::shared_ptr<Swimmer>, const std::string&, std::size_t, bool>(), py::arg("swimmer"),
             py::arg("method"), py::arg("order"), py::arg("planar"))
        .def("change", &PyMarch::change, py::arg("swimmer"), py::arg("method"), py::arg("order"), py::arg("planar"))
        .def("follow", &PyMarch::follow, py::arg("law"), py::arg("breakpoints"), py::arg("bounds"), py::arg("ledger"),
             py::arg("current"), py::arg("flow"), py::arg("smoothly"), py::arg("fin_angles") = py::list())
        .def("start", &PyMarch::start, py::arg("position"), py::arg("orientation"), py::arg("twist"))
        .def("record", &PyMarch::record, py::arg("times"), py::arg("first"), py::arg("whole"), py::arg("works"),
             py::arg("wrench"), py::arg("load"), py::arg("until"))
        .def("observe", &PyMarch::observe, py::arg("whole"), py::arg("wrench"), py::arg("load"));

    bind_sampled_marches(module);
    bind_bent_marches(module);
    bind_splines(module);

    module.def("repeat_rate", &repeat_rate, py::arg("swimmer"), py::arg("planar"), py::arg("law"), py::arg("time"),
               py::arg("state"), py::arg("count"), py::arg("flow") = py::none());
    py::class_<Instant>(module, "Instant")
        .def(py::init<std::shared_ptr<const Swimmer>>(), py::arg("swimmer"))
        .def("inertia", &inertia_at, py::arg("law"), py::arg("time"))
        .def(
            "loads",
            [](Instant& instant, const LawOnGrid& law, double time, const py::object& twist) {
                const auto [tail, drag] = instant.loads(law, time, twist_from(twist, "twist"));
                return std::make_tuple(components_of(half_turn(tail)), components_of(half_turn(drag)));
            },
            py::arg("law"), py::arg("time"), py::arg("twist"))
        .def(
            "drag_powers",
            [](Instant& instant, const LawOnGrid& law, const py::object& times, const py::object& twists,
               const py::object& powers, const py::object& current, std::shared_ptr<Flow> flow,
               const py::object& poses) {
                const Numbers at(times, "times");
                const Numbers motion = Numbers::sized(twists, "twists", 6 * at.size()),
                              into = Numbers::sized(powers, "powers", 4 * at.size(), true),
                              heads = Numbers::sized(poses, "poses", 7 * at.size());
                const Water water = water_from(current, std::move(flow));
                const py::gil_scoped_release unlocked;
                for (std::size_t k = 0; k < at.size(); ++k) {
                    State y{};
                    std::copy_n(heads.data() + 7 * k, 7, y.begin());
                    const auto twist = twist_of(motion.data() + 6 * k);
                    std::ranges::copy(instant.drag_powers(law, at.data()[k], twist, water, half_turn(y)),
                                      into.data() + 4 * k);
                }
            },
            py::arg("law"), py::arg("times"), py::arg("twists"), py::arg("powers"), py::arg("current"), py::arg("flow"),
            py::arg("poses"))
        .def(
            "momentum_rate",
            [](Instant& instant, const LawOnGrid& law, double time, const py::object& twist,
               const py::object& acceleration) {
                return components_of(half_turn(instant.momentum_rate(law, time, twist_from(twist, "twist"),
                                                                     twist_from(acceleration, "acceleration"))));
            },
            py::arg("law"), py::arg("time"), py::arg("twist"), py::arg("acceleration"));
}
