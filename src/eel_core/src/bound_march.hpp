// SPDX-License-Identifier: Apache-2.0
// What the Python classes of marches share: one thread at a time, without Python's lock; state, works and counts.
#pragma once

#include <atomic>
#include <stdexcept>
#include <utility>

#include "from_python.hpp"

namespace eel_core {

// Of a state, what Python sees.
using PythonState = std::array<double, state_size>;
inline PythonState shown(const State& state)
{
    const State turned = half_turn(state);
    PythonState result;
    std::copy_n(turned.begin(), state_size, result.begin());
    return result;
}

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

// A `March` or `BentMarch` that Python holds.
template <class Core>
class BoundMarch {
  public:
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
    int advance(double time)
    {
        const Driven in_use(*this);
        const py::gil_scoped_release unlocked;
        return static_cast<int>(march_.advance(time));
    }
    std::int64_t set_slice(std::int64_t nodes)
    {
        const InUse in_use(in_use_);
        return march_.set_slice(nodes);
    }
    std::size_t memory()
    {
        const Driven in_use(*this);
        return march_.memory();
    }
    double time() const { return march_.time(); }
    std::optional<std::tuple<double, double, double, double>> outside() const
    {
        const auto found = march_.outside();
        if (!found) return {};
        const auto [time, x, y, z] = *found;
        return std::tuple(time, 0.0 - x, 0.0 - y, z);
    }
    PythonState state() const { return shown(march_.state()); }
    WorkDone works() const
    {
        WorkDone works;
        std::copy_n(march_.works().begin(), works.size(), works.begin());
        return works;
    }
    auto counts() const
    {
        const Counts counts = march_.counts();
        return std::tuple(counts.steps, counts.rejected, counts.evaluations);
    }

  protected:
    template <class... Given>
    explicit BoundMarch(bool has_law, Given&&... given) : march_(std::forward<Given>(given)...), has_law_(has_law)
    {
    }

    struct Driven : InUse {
        explicit Driven(BoundMarch& march) : InUse(march.in_use_)
        {
            if (!march.has_law_) throw std::runtime_error("this march follows no law on its grid yet");
        }
    };

    Profiles profiles_of(std::size_t samples, bool wrench, bool load) const
    {
        return {samples, march_.swimmer().stations, wrench, load, march_.swimmer().fins.size()};
    }
    static Numbers room_for(const Profiles& profiles, const py::object& whole)
    {
        return Numbers::sized(whole, "whole", profiles.begin[Profiles::quantities], true);
    }

    // Records what `record` of the core gives for so many instants, into `whole` and `works`: how many are complete,
    // and the status.
    template <class Record>
    py::tuple recorded(std::size_t instants, const py::object& whole, const py::object& works, bool wrench, bool load,
                       const Record& record)
    {
        const Profiles profiles = profiles_of(instants, wrench, load);
        const Numbers into = room_for(profiles, whole);
        const auto works_into = Numbers::sized(works, "works", std::tuple_size_v<WorkDone> * instants, true);
        const Driven in_use(*this);
        std::size_t done = 0;
        Status status = Status::marched;
        {
            const py::gil_scoped_release unlocked;
            status = record(profiles, into.data(), works_into.data(), done);
        }
        return py::make_tuple(done, static_cast<int>(status));
    }

    Core march_;
    bool has_law_;  // on the present grid
    std::atomic<bool> in_use_{false};
};

template <class Bound>
void bind_what_marches_share(py::class_<Bound>& bound)
{
    bound.def("__copy__", &Bound::copy)
        .def(
            "__deepcopy__", [](Bound& march, const py::dict&) { return march.copy(); }, py::arg("memo"))
        .def("set_state", &Bound::set_state, py::arg("position"), py::arg("orientation"), py::arg("twist"))
        .def("set_twist", &Bound::set_twist, py::arg("twist"))
        .def("twist", &Bound::twist)
        .def("set_slice", &Bound::set_slice, py::arg("nodes"))
        .def("advance", &Bound::advance, py::arg("time"))
        .def_property_readonly("memory", &Bound::memory)
        .def_property_readonly("time", &Bound::time)
        .def_property_readonly("state", &Bound::state)
        .def_property_readonly("works", &Bound::works)
        .def_property_readonly("outside", &Bound::outside)
        .def_property_readonly("counts", &Bound::counts);
}

// Lets copies in Python share the object, which never changes.
template <class Class>
void share_in_copies(Class& bound)
{
    bound.def("__copy__", [](const py::object& self) { return self; })
        .def("__deepcopy__", [](const py::object& self, const py::dict&) { return self; }, py::arg("memo"));
}

// The Python classes of bodies with modes (bind_bent.cpp).
void bind_bent_marches(py::module_& module);

}  // namespace eel_core
