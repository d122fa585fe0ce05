// SPDX-License-Identifier: Apache-2.0
// A march that Python holds: one thread at a time, without Python's lock.
#pragma once

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string_view>

#include "eel_core/march/march.hpp"
#include "from_python.hpp"

namespace eel_core {

// Held while a call uses what the flag stands for. Throws where another thread does.
class InUse {
  public:
    explicit InUse(std::atomic<bool>& flag, const char* what = "this march is") : flag_(flag)
    {
        if (flag_.exchange(true)) throw std::runtime_error(std::string(what) + " under way in another thread");
    }
    ~InUse() { flag_ = false; }
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;

  private:
    std::atomic<bool>& flag_;
};

inline auto tuple_of(const Counts& counts) { return std::tuple(counts.steps, counts.rejected, counts.evaluations); }

inline constexpr std::pair<const char*, Command::Kind> command_kinds[] = {{"law", Command::law},
                                                                          {"position", Command::position},
                                                                          {"velocity", Command::velocity},
                                                                          {"effort", Command::effort}};

class PyMarch {
  public:
    PyMarch(std::shared_ptr<const Swimmer> swimmer, const std::string& method, std::size_t order, bool planar,
            const std::shared_ptr<const Modes>& modes)
        : march_(checked(std::move(swimmer), modes.get()), method_of(method, order, modes.get()), planar, modes)
    {
    }

    // A march of its own, in the same state.
    std::shared_ptr<PyMarch> copy()
    {
        const InUse in_use(in_use_);
        return std::shared_ptr<PyMarch>(new PyMarch(march_, has_law_));
    }
    // All that goes on but what drives the body, as bytes.
    py::bytes state_as_bytes()
    {
        const Driven in_use(*this);
        Writer writer;
        march_.pass(writer);
        return writer.finished();
    }
    void set_state_from_bytes(const py::bytes& state)
    {
        const Driven in_use(*this);
        Reader reader{std::string_view(state)};
        March there = march_;
        there.pass(reader), reader.finish();
        march_ = std::move(there);
    }
    double time() { return march_.now().time; }
    WorkDone works() { return march_.now().works; }
    auto counts() { return tuple_of(march_.counts()); }
    std::vector<double> state()
    {
        const State state = half_turn(march_.now().state);
        return {state.begin(), state.begin() + state_size};
    }
    void change(std::shared_ptr<const Swimmer> swimmer, const std::string& method, std::size_t order, bool planar,
                const std::shared_ptr<const Modes>& modes)
    {
        const InUse in_use(in_use_);
        const std::size_t coordinates = modes ? modes->coordinates : 0;
        if (coordinates != march_.now().x.size())
            throw py::value_error("modes must have " + std::to_string(march_.now().x.size()) +
                                  " coordinates as before, got " + std::to_string(coordinates));
        march_.change(checked(std::move(swimmer), modes.get()), method_of(method, order, modes.get()), planar, modes);
        has_law_ = false;
    }
    void follow(const std::shared_ptr<LawOnGrid>& law, std::vector<double> breakpoints,
                const std::shared_ptr<StepBounds>& bounds, bool ledger, const py::object& current,
                std::shared_ptr<Flow> flow, bool smoothly, const py::list& fin_angles, const py::object& reference,
                const py::list& wrenches)
    {
        const InUse in_use(in_use_);
        check_fits(*law, march_.swimmer());
        if (march_.modes() && law->tables->rows() < march_.modes()->modes)
            throw py::value_error("law must have the modes as its last rows");
        check_rises(breakpoints, "breakpoints");
        BentSettings settings{
            {*law, std::move(breakpoints), *bounds, ledger, water_from(current, std::move(flow))}, 0, {}, {}};
        for (const py::handle each : fin_angles) {
            const auto [knots, coefficients] = each.cast<std::pair<py::object, py::object>>();
            settings.law.fins.push_back(cubics_from<double>(knots, coefficients));
        }
        for (const py::handle each : wrenches)
            settings.law.wrenches.push_back(wrench_from(each.cast<py::tuple>(), march_.swimmer().grid.nodes));
        if (const Modes* const modes = march_.modes()) {
            settings.first_mode = law->tables->rows() - modes->modes;
            const std::size_t imposed = modes->servos.size() * settings.first_mode;
            settings.reference = Numbers::sized(reference, "reference", imposed).vector();
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
    double set_state(const py::object& position, const py::object& orientation, const py::object& twist)
    {
        const Driven in_use(*this);
        return march_.set_state(vector_from(position, "position"), orientation_from(orientation),
                                twist_from(twist, "twist"));
    }
    double set_twist(const py::object& twist)
    {
        const Driven in_use(*this);
        return march_.set_twist(twist_from(twist, "twist"));
    }
    std::array<double, 6> twist()
    {
        const Driven in_use(*this);
        return components_of(half_turn(march_.twist()));
    }
    void command(std::size_t servo, const std::string& kind, double angle, double rate, double torque, double low,
                 double high)
    {
        const Driven in_use(*this);
        if (!march_.modes() || servo >= march_.modes()->servos.size())
            throw py::value_error("a command must be for a servo");
        march_.command(servo, {value_named(command_kinds, kind, "kind"), angle, rate, torque, low, high});
    }
    int advance(double time)
    {
        const Driven in_use(*this);
        check_finite({&time, 1}, "time");
        const py::gil_scoped_release unlocked;
        return static_cast<int>(march_.advance(time));
    }
    // How many instants are complete, and the status.
    py::tuple record(const py::object& times, std::size_t first, const py::object& whole, const py::object& works,
                     const py::object& rows, bool wrench, bool load, double until)
    {
        const Numbers instants(times, "times");
        const std::size_t n = instants.size();
        check_finite(instants.span(), "times");
        const Profiles profiles = profiles_of(n, wrench, load);
        const Numbers into = room_for(profiles, whole),
                      works_into = Numbers::sized(works, "works", std::tuple_size_v<WorkDone> * n, true),
                      rows_into = Numbers::sized(rows, "rows", march_.row().size() * n, true);
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
    bool observe(const py::object& whole, const py::object& row, bool wrench, bool load)
    {
        const Profiles profiles = profiles_of(1, wrench, load);
        const Numbers into = room_for(profiles, whole),
                      row_into = Numbers::sized(row, "row", march_.row().size(), true);
        const Driven in_use(*this);
        return march_.observe(profiles, into.data(), 0, row_into.data());
    }
    std::int64_t set_slice(std::int64_t nodes)
    {
        const InUse in_use(in_use_);
        if (nodes < 1) throw py::value_error("nodes must be 1 or more, got " + std::to_string(nodes));
        return march_.set_slice(nodes);
    }
    std::size_t to_blame(bool singular)
    {
        const Driven in_use(*this);
        return march_.to_blame(singular);
    }
    std::optional<std::tuple<double, double, double, double>> outside() const
    {
        const auto found = march_.outside();
        if (!found) return {};
        const auto [time, x, y, z] = *found;
        return std::tuple(time, 0.0 - x, 0.0 - y, z);
    }
    // Where the numbers of an instant's coordinates lie in a row: name -> (begin, end).
    py::dict row() const
    {
        const CoordinateRow row = march_.row();
        py::dict places;
        for (std::size_t q = 0; q < CoordinateRow::quantities; ++q)
            places[CoordinateRow::names[q]] = py::make_tuple(row.begin[q], row.begin[q + 1]);
        return places;
    }

  private:
    PyMarch(const March& march, bool has_law) : march_(march), has_law_(has_law) {}

    struct Driven : InUse {
        explicit Driven(PyMarch& march) : InUse(march.in_use_)
        {
            if (!march.has_law_) throw std::runtime_error("this march follows no law on its grid yet");
        }
    };

    static Method method_of(const std::string& name, std::size_t order, const Modes* modes)
    {
        return modes ? Method() : Method::of(name, order);
    }
    static std::shared_ptr<const Swimmer> checked(std::shared_ptr<const Swimmer> swimmer, const Modes* modes)
    {
        for (std::size_t m = 0; modes && m < modes->modes; ++m)
            if (modes->first[m] >= modes->last[m] || modes->last[m] > swimmer->grid.nodes)
                throw py::value_error("modes must have nodes of the grid");
        return swimmer;
    }
    std::vector<double> coordinates_from(const py::object& object, const char* name) const
    {
        const std::size_t n = march_.now().x.size();
        return object.is_none() ? std::vector<double>(n) : Numbers::sized(object, name, n).vector();
    }
    Profiles profiles_of(std::size_t samples, bool wrench, bool load) const
    {
        const Swimmer& swimmer = march_.swimmer();
        return {samples, swimmer.shown, wrench, load, swimmer.fins.size(), swimmer.sensors()};
    }
    static Numbers room_for(const Profiles& profiles, const py::object& whole)
    {
        return Numbers::sized(whole, "whole", profiles.begin[Profiles::quantities], true);
    }

    March march_;
    bool has_law_ = false;  // on the present grid
    std::atomic<bool> in_use_{false};
};

}  // namespace eel_core
