// SPDX-License-Identifier: Apache-2.0
// The Python module. EEL_CORE_MODULE is its name: one for each level of the processor.
#include <pybind11/pybind11.h>

#include "bind_flow.hpp"
#include "eel_core/build_info.hpp"
#include "eel_core/march/instant.hpp"
#include "eel_core/march/profiles.hpp"
#include "from_python.hpp"
#include "swimmer_from.hpp"

namespace py = pybind11;
using namespace eel_core;

// The Python classes of marches (bind_march.cpp).
namespace eel_core {
void bind_marches(py::module_& module);
}

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
py::dict layout(std::size_t samples, std::size_t stations, bool wrench, bool load, std::size_t fins,
                std::size_t sensors)
{
    const Profiles profiles(samples, stations, wrench, load, fins, sensors);
    py::dict result;
    for (const auto& [q, name, width] : Profiles::described) {
        const int of = profiles.along_body(q) ? 1 : profiles.of_fins(q) ? 2 : profiles.of_sensors(q) ? 3 : 0;
        result[name] = py::make_tuple(profiles.begin[q], profiles.instants(q), width, of);
    }
    return result;
}

Wave wave_from(const py::tuple& wave)
{
    Wave result{wave[0].cast<double>(), {}, wave[2].cast<std::size_t>(), wave[3].cast<std::size_t>()};
    for (const py::handle factor : wave[1]) result.factors.push_back(ramps_from(factor));
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
    const auto check = [&](std::size_t first, std::size_t count) {
        if (first >= rows || count > rows - first)
            throw py::value_error("law has " + std::to_string(rows) + " rows, and wants " + std::to_string(count) +
                                  " from row " + std::to_string(first) + " on");
    };
    for (const Wave& wave : law->waves) check(wave.sine, 1), check(wave.cosine, 1);
    if (!segment.is_none()) check(law->segment.row, 12);
    if (!blend.is_none()) check(law->blend.row, 6);
    return law;
}

std::array<std::vector<double>, 3> factors_at(const std::shared_ptr<LawOnGrid>& self, double time)
{
    const LawOnGrid& law = *self;
    std::vector<Jet> factor(law.tables->rows());
    law.set_factors(time, factor);
    std::array<std::vector<double>, 3> result;
    for (const Jet& jet : factor)
        for (std::size_t derivative = 0; derivative < 3; ++derivative) result[derivative].push_back(jet[derivative]);
    return result;
}

// Evaluates the rate of a state again and again, for benchmarks.
template <class M>
void repeat_rate_in(const Swimmer& swimmer, const LawOnGrid& law, double time, const State& y, std::size_t count,
                    const Water& water)
{
    Workspace<M> work(swimmer);
    State rate{};
    for (std::size_t k = 0; k < count; ++k) rate_of_state(swimmer, law, water, time, y, work, rate);
}
void repeat_rate(const std::shared_ptr<Swimmer>& of, bool planar, const std::shared_ptr<LawOnGrid>& under, double time,
                 const py::object& state, std::size_t count, std::shared_ptr<Flow> flow)
{
    constexpr std::size_t most_rates = 1'000'000;  // no signal is heard meanwhile
    const Swimmer& swimmer = *of;
    const LawOnGrid& law = *under;
    check_fits(law, swimmer);
    check_count(count, 0, most_rates, "count");
    State y{};
    std::ranges::copy(row_from<state_size>(state, "state"), y.begin());
    const py::gil_scoped_release unlocked;
    (planar ? repeat_rate_in<Plane> : repeat_rate_in<Space>)(swimmer, law, time, half_turn(y), count,
                                                             {{}, std::move(flow)});
}

// `Instant` for Python, of laws that are on its grid.
class PyInstant {
  public:
    explicit PyInstant(std::shared_ptr<Swimmer> swimmer) : swimmer_(std::move(swimmer)), instant_(swimmer_) {}

    std::array<std::array<double, 6>, 6> inertia(const std::shared_ptr<LawOnGrid>& law, double time)
    {
        check_fits(*law, *swimmer_);
        const auto inertia = instant_.inertia(*law, time);
        std::array<std::array<double, 6>, 6> rows;
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j <= i; ++j) rows[i][j] = rows[j][i] = inertia.lower[inertia.at(i, j)];
        return rows;
    }
    std::tuple<std::array<double, 6>, std::array<double, 6>> loads(const std::shared_ptr<LawOnGrid>& law, double time,
                                                                   const py::object& twist)
    {
        check_fits(*law, *swimmer_);
        const auto [tail, drag] = instant_.loads(*law, time, twist_from(twist, "twist"));
        return {components_of(half_turn(tail)), components_of(half_turn(drag))};
    }
    void drag_powers(const std::shared_ptr<LawOnGrid>& law, const py::object& times, const py::object& twists,
                     const py::object& powers, const py::object& current, std::shared_ptr<Flow> flow,
                     const py::object& poses, const py::object& modes)
    {
        check_fits(*law, *swimmer_);
        const Numbers at(times, "times");
        const Numbers motion = Numbers::sized(twists, "twists", 6 * at.size()),
                      into = Numbers::sized(powers, "powers", 6 * at.size(), true),
                      heads = Numbers::sized(poses, "poses", 7 * at.size()), motion_of_modes(modes, "modes");
        const std::size_t numbers = at.size() == 0 ? 0 : motion_of_modes.size() / at.size();
        if (numbers / 2 > law->tables->rows()) throw py::value_error("modes must have rows of the law");
        const Water water = water_from(current, std::move(flow));
        const py::gil_scoped_release unlocked;
        for (std::size_t k = 0; k < at.size(); ++k) {
            State y{};
            std::copy_n(heads.data() + 7 * k, 7, y.begin());
            const auto twist = twist_of(motion.data() + 6 * k);
            std::ranges::copy(instant_.drag_powers(*law, at.data()[k], twist, water, half_turn(y),
                                                   {motion_of_modes.data() + numbers * k, numbers}),
                              into.data() + 6 * k);
        }
    }
    std::array<double, 6> momentum_rate(const std::shared_ptr<LawOnGrid>& law, double time, const py::object& twist,
                                        const py::object& acceleration)
    {
        check_fits(*law, *swimmer_);
        return components_of(half_turn(
            instant_.momentum_rate(*law, time, twist_from(twist, "twist"), twist_from(acceleration, "acceleration"))));
    }

  private:
    std::shared_ptr<const Swimmer> swimmer_;
    Instant instant_;
};

}  // namespace

PYBIND11_MODULE(EEL_CORE_MODULE, module)
{
    // One name for all levels: what is pickled by one can be read by another.
    module.attr("__name__") = "eel_core._core";
    module.def("build_info", &build_info_as_dict,
               "How this module was compiled: level, compiler, flags, sanitizers, pybind11.");
    module.def("layout", &layout, py::arg("samples"), py::arg("stations"), py::arg("wrench"), py::arg("load"),
               py::arg("fins") = 0, py::arg("sensors") = 0);
    module.attr("MOST_SERVOS") = most_servos;
    module.attr("FILLED") = filled;
    module.attr("FRICTION_LAWS") = names_of(friction_laws);

    auto swimmer = py::class_<Swimmer, std::shared_ptr<Swimmer>>(module, "Swimmer");
    share_in_copies(swimmer);
    swimmer.def(py::init(&swimmer_from), py::arg("grid"), py::arg("sections"), py::arg("stations"));

    bind_flows(module);

    auto law_tables = py::class_<LawTables, std::shared_ptr<LawTables>>(module, "LawTables");
    share_in_copies(law_tables);
    law_tables.def(py::init(&tables_from), py::arg("axis"), py::arg("rows"), py::arg("nodes"), py::arg("stations"));

    auto curvature_law = py::class_<LawOnGrid, std::shared_ptr<LawOnGrid>>(module, "LawOnGrid");
    share_in_copies(curvature_law);
    curvature_law
        .def(py::init(&law_from), needed("tables"), py::arg("origin"), py::arg("waves"), py::arg("segment"),
             py::arg("blend"))
        .def("factors", &factors_at, py::arg("time"));

    bind_marches(module);

    module.def("repeat_rate", &repeat_rate, needed("swimmer"), py::arg("planar"), needed("law"), py::arg("time"),
               py::arg("state"), py::arg("count"), py::arg("flow") = py::none());
    py::class_<PyInstant, std::shared_ptr<PyInstant>>(module, "Instant")
        .def(py::init<std::shared_ptr<Swimmer>>(), needed("swimmer"))
        .def("inertia", method(&PyInstant::inertia), needed("law"), py::arg("time"))
        .def("loads", method(&PyInstant::loads), needed("law"), py::arg("time"), py::arg("twist"))
        .def("drag_powers", method(&PyInstant::drag_powers), needed("law"), py::arg("times"), py::arg("twists"),
             py::arg("powers"), py::arg("current"), py::arg("flow"), py::arg("poses"), py::arg("modes"))
        .def("momentum_rate", method(&PyInstant::momentum_rate), needed("law"), py::arg("time"), py::arg("twist"),
             py::arg("acceleration"));
}
