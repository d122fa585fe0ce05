// SPDX-License-Identifier: Apache-2.0
// What the Python classes of marches share: one thread at a time, without Python's lock; state, works and counts.
#pragma once

#include <atomic>
#include <stdexcept>
#include <utility>

#include "from_python.hpp"

namespace eel_core {

template <class S>
py::list list_of(const S& numbers)
{
    py::list result;
    for (const double number : numbers) result.append(number);
    return result;
}

inline py::list list_of_state(const State& state)
{
    const State turned = half_turn(state);
    return list_of(std::span(turned).first(state_size));
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
    py::list twist()
    {
        const Driven in_use(*this);
        return list_of(components_of(half_turn(march_.twist())));
    }
    int advance(double time)
    {
        const Driven in_use(*this);
        const py::gil_scoped_release unlocked;
        return static_cast<int>(march_.advance(time));
    }
    void set_slice(std::int64_t nodes)
    {
        const InUse in_use(in_use_);
        march_.set_slice(nodes);
    }
    std::size_t memory()
    {
        const Driven in_use(*this);
        return march_.memory();
    }
    double time() const { return march_.time(); }
    py::object outside() const
    {
        const auto found = march_.outside();
        if (!found) return py::none();
        const auto [time, x, y, z] = *found;
        return py::make_tuple(time, 0.0 - x, 0.0 - y, z);
    }
    py::list state() const { return list_of_state(march_.state()); }
    py::list works() const { return list_of(std::span(march_.works()).first(std::tuple_size_v<WorkDone>)); }
    py::tuple counts() const
    {
        const Counts counts = march_.counts();
        return py::make_tuple(counts.steps, counts.rejected, counts.evaluations);
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

    // Of `samples` instants, which `whole` has room for.
    Profiles profiles_for(const Numbers& whole, std::size_t samples, bool wrench, bool load) const
    {
        const Swimmer& swimmer = march_.swimmer();
        const Profiles profiles(samples, swimmer.stations, wrench, load, swimmer.fins.size());
        whole.check_size(profiles.begin[Profiles::quantities], "whole");
        return profiles;
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

}  // namespace eel_core
