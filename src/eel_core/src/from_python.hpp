// SPDX-License-Identifier: Apache-2.0
// What Python hands over: arrays and tables as objects with arrays for attributes, copied into the structs of the core.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "eel_core/algebra/cubics.hpp"
#include "eel_core/law.hpp"
#include "eel_core/march/axes.hpp"
#include "eel_core/model/swimmer.hpp"

namespace eel_core {

namespace py = pybind11;

// A contiguous array of numbers of type T, in the byte order of this machine, which Python keeps alive as long as this
// lives.
template <class T>
class Array {
  public:
    Array(const py::handle& object, const std::string& name, bool writable = false)
        : info_(buffer_of(object, name)), name_(name)
    {
        if (!is_of_type())
            throw py::value_error(name + " must hold numbers of " + std::to_string(8 * sizeof(T)) + " bits like '" +
                                  py::format_descriptor<T>::format() + "', got '" + info_.format + "'");
        if (writable && info_.readonly) throw py::value_error(name + " must be writable");
        std::size_t step = sizeof(T);
        for (std::size_t axis = info_.size > 0 ? info_.shape.size() : 0; axis-- > 0; step *= length(axis))
            if (length(axis) > 1 && static_cast<std::size_t>(info_.strides[axis]) != step)
                throw py::value_error(name + " must be contiguous");
        if (std::bit_cast<std::uintptr_t>(info_.ptr) % alignof(T) != 0)
            throw py::value_error(name + " must begin at a multiple of " + std::to_string(alignof(T)) + " bytes");
    }

    static Array sized(const py::handle& object, const std::string& name, std::size_t size, bool writable = false)
    {
        Array array(object, name, writable);
        if (array.size() != size)
            throw py::value_error(name + " must have " + std::to_string(size) + " numbers, got " +
                                  std::to_string(array.size()));
        return array;
    }

    std::size_t length(std::size_t axis) const
    {
        if (axis >= info_.shape.size())
            throw py::value_error(name_ + " must have more axes than " + std::to_string(info_.shape.size()));
        return static_cast<std::size_t>(info_.shape[axis]);
    }
    std::size_t size() const { return static_cast<std::size_t>(info_.size); }
    T* data() const { return static_cast<T*>(info_.ptr); }
    std::span<const T> span() const { return {data(), size()}; }
    // A copy, of the same numbers or of others.
    template <class Number = T>
    std::vector<Number> vector() const
    {
        return std::vector<Number>(data(), data() + size());
    }

  private:
    static py::buffer_info buffer_of(const py::handle& object, const std::string& name)
    {
        if (!object || PyObject_CheckBuffer(object.ptr()) == 0)
            throw py::value_error(name + " must be an array, got " +
                                  (object ? Py_TYPE(object.ptr())->tp_name : "none"));
        return py::reinterpret_borrow<py::buffer>(object).request();
    }
    bool is_of_type()
        const  // 'l' and 'q', 'L' and 'Q' are the same numbers; '@', '=' and one more mean: of this machine
    {
        constexpr char own_order = std::endian::native == std::endian::little ? '<' : '>';
        std::string_view kind = info_.format;
        if (kind.size() == 2 && (kind[0] == '@' || kind[0] == '=' || kind[0] == own_order)) kind.remove_prefix(1);
        if (static_cast<std::size_t>(info_.itemsize) != sizeof(T)) return false;
        if (std::is_floating_point_v<T>) return kind == "d";
        return std::is_signed_v<T> ? kind == "l" || kind == "q" : kind == "L" || kind == "Q";
    }

    py::buffer_info info_;
    std::string name_;
};

using Numbers = Array<double>;

template <class T>
Array<T> array_of(const py::handle& object, const char* name)
{
    return Array<T>(object.attr(name), name);
}

// Throws unless the numbers rise, or stay; one that is no number does not.
inline void check_rises(std::span<const double> numbers, const char* name)
{
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (!(numbers[i] >= (i > 0 ? numbers[i - 1] : numbers[i])))
            throw py::value_error(std::string(name) + " must rise, got " + std::to_string(numbers[i]) + " at index " +
                                  std::to_string(i));
}
inline void check_finite(std::span<const double> numbers, const char* name)
{
    for (const double number : numbers)
        if (!std::isfinite(number))
            throw py::value_error(std::string(name) + " must be finite, got " + std::to_string(number));
}
inline void check_count(std::size_t count, std::size_t least, std::size_t most, const char* name)
{
    if (count < least || count > most)
        throw py::value_error(std::string(name) + " must be " + std::to_string(least) + " to " + std::to_string(most) +
                              ", got " + std::to_string(count));
}

// The law's rows, tabulated on the nodes and stations of a swimmer.
inline void check_fits(const LawOnGrid& law, const Swimmer& swimmer)
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

template <std::size_t N>
std::array<double, N> row_from(const py::handle& object, const std::string& name)
{
    const auto numbers = Numbers::sized(object, name, N);
    std::array<double, N> result;
    std::copy_n(numbers.data(), N, result.begin());
    return result;
}
inline Vector3<double> vector_from(const py::handle& object, const std::string& name)
{
    const auto v = row_from<3>(object, name);
    return half_turn(Vector3{v[0], v[1], v[2]});
}
inline Quaternion<double> orientation_from(const py::handle& object)
{
    const auto q = row_from<4>(object, "orientation");
    return half_turn(Quaternion<double>{q[0], q[1], q[2], q[3]});
}
inline Twist<Space, double> twist_of(const double* v)
{
    return half_turn(Twist<Space, double>{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
}
inline Twist<Space, double> twist_from(const py::handle& object, const std::string& name)
{
    return twist_of(row_from<6>(object, name).data());
}

// Knots (n,) [s], and the coefficients (n - 1, 4) of cubics from the constant on, of numbers or of vectors.
template <class Value>
Cubics<Value> cubics_from(const py::handle& knots, const py::handle& coefficients)
{
    using Parts = Components<Value>;
    const Numbers times(knots, "knots");
    if (times.size() < 2) throw py::value_error("knots must be two or more, got " + std::to_string(times.size()));
    const auto numbers = Numbers::sized(coefficients, "coefficients", 4 * Parts::count * (times.size() - 1));
    check_rises(times.span(), "knots");
    Cubics<Value> cubics{times.vector(), {}};
    for (const double* next = numbers.data(); cubics.pieces.size() + 1 < times.size();)
        for (Value& coefficient : cubics.pieces.emplace_back()) {
            coefficient = Parts::make([&](std::size_t k) { return next[k]; });
            next += Parts::count;
        }
    return cubics;
}

// A wrench from outside: (node or None at X = 0, first station there or behind, whether in the axes of the world, and
// torque and force as a function of the time that gives six numbers, or as knots and coefficients (n - 1, 4, 6)).
inline ExternalWrench wrench_from(const py::tuple& given, std::size_t nodes)
{
    if (given.size() != 4 && given.size() != 5) throw py::value_error("a wrench must have four parts or five");
    const auto node = given[0].cast<std::optional<std::size_t>>();
    if (node && *node >= nodes) throw py::value_error("wrenches must have a node of the grid");
    ExternalWrench wrench{node.value_or(Appendage::nose), given[1].cast<std::size_t>(), given[2].cast<bool>(), {}};
    if (given.size() == 4)
        wrench.at = [function = py::object(given[3])](double time) {
            const py::gil_scoped_acquire locked;
            return twist_of(function(time).cast<std::array<double, 6>>().data());
        };
    else
        wrench.at = [cubics = cubics_from<Wrench<Space, double>>(given[3], given[4])](double time) {
            return half_turn(cubics.at(time)[0]);
        };
    return wrench;
}

inline std::vector<Ramp> ramps_from(const py::handle& ramps)
{
    std::vector<Ramp> result;
    for (const auto& [start, end, delta] : ramps.cast<std::vector<std::tuple<double, double, double>>>())
        result.push_back({start, end, delta});
    return result;
}

// The names in a table of names and values.
template <class Value, std::size_t Count>
py::tuple names_of(const std::pair<const char*, Value> (&table)[Count])
{
    py::tuple names(Count);
    for (std::size_t i = 0; i < Count; ++i) names[i] = table[i].first;
    return names;
}

// The value of this `name` in the table; `argument`: whose name it is.
template <class Value, std::size_t Count>
Value value_named(const std::pair<const char*, Value> (&table)[Count], const std::string& name, const char* argument)
{
    for (const auto& [known, value] : table)
        if (name == known) return value;
    const py::object known = names_of(table);
    const auto names = py::repr(known).template cast<std::string>();
    throw py::value_error(std::string(argument) + " must be one of " + names + ", got '" + name + "'");
}

// A method for Python. It refuses an object that is none, or was made without its constructor: it has no holder then.
template <class Class, class Result, class... Given>
auto method(Result (Class::*function)(Given...))
{
    return [function](const std::shared_ptr<Class>& self, Given... given) -> Result {
        if (!self) throw py::type_error("the object must not be None");
        return (self.get()->*function)(std::forward<Given>(given)...);
    };
}
template <class Class, class Result, class... Given>
auto method(Result (Class::*function)(Given...) const)
{
    return [function](const std::shared_ptr<Class>& self, Given... given) -> Result {
        if (!self) throw py::type_error("the object must not be None");
        return (self.get()->*function)(std::forward<Given>(given)...);
    };
}

// An argument that must not be none: a pointer to nothing.
inline py::arg needed(const char* name) { return py::arg(name).none(false); }

// Lets copies in Python share the object, which never changes.
template <class Class>
void share_in_copies(Class& bound)
{
    bound.def("__copy__", [](const py::object& self) { return self; })
        .def("__deepcopy__", [](const py::object& self, const py::dict&) { return self; }, py::arg("memo"));
}

}  // namespace eel_core
