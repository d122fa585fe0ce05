// SPDX-License-Identifier: Apache-2.0
// What Python hands over: arrays and tables as objects with arrays for attributes, copied into the structs of the core.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "eel_core/algebra/cubics.hpp"
#include "eel_core/march/axes.hpp"

namespace eel_core {

namespace py = pybind11;

// A contiguous array of numbers of type T, which Python keeps alive as long as this lives.
template <class T>
class Array {
  public:
    Array(const py::handle& object, const std::string& name, bool writable = false)
        : info_(py::cast<py::buffer>(object).request(writable))
    {
        std::size_t step = sizeof(T);
        for (std::size_t axis = info_.size > 0 ? info_.shape.size() : 0; axis-- > 0; step *= length(axis))
            if (length(axis) > 1 && static_cast<std::size_t>(info_.strides[axis]) != step)
                throw py::value_error(name + " must be contiguous");
        if (!is_of_type())
            throw py::value_error(name + " must hold numbers of " + std::to_string(8 * sizeof(T)) + " bits like '" +
                                  py::format_descriptor<T>::format() + "', got '" + info_.format + "'");
    }

    static Array sized(const py::handle& object, const std::string& name, std::size_t size, bool writable = false)
    {
        Array array(object, name, writable);
        if (array.size() != size)
            throw py::value_error(name + " must have " + std::to_string(size) + " numbers, got " +
                                  std::to_string(array.size()));
        return array;
    }

    std::size_t length(std::size_t axis) const { return static_cast<std::size_t>(info_.shape.at(axis)); }
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
    bool is_of_type() const  // 'l' and 'q', 'L' and 'Q' are the same numbers
    {
        const char kind = info_.format.empty() ? '?' : info_.format.back();
        const bool fits = static_cast<std::size_t>(info_.itemsize) == sizeof(T);
        if (std::is_floating_point_v<T>) return fits && kind == 'd';
        return fits && (std::is_signed_v<T> ? kind == 'l' || kind == 'q' : kind == 'L' || kind == 'Q');
    }

    py::buffer_info info_;
};

using Numbers = Array<double>;

template <class T>
Array<T> array_of(const py::handle& object, const char* name)
{
    return Array<T>(object.attr(name), name);
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
    Cubics<Value> cubics{times.vector(), {}};
    for (const double* next = numbers.data(); cubics.pieces.size() + 1 < times.size();)
        for (Value& coefficient : cubics.pieces.emplace_back()) {
            coefficient = Parts::make([&](std::size_t k) { return next[k]; });
            next += Parts::count;
        }
    return cubics;
}

inline std::vector<Ramp> ramps_from(const py::handle& ramps)
{
    std::vector<Ramp> result;
    for (const auto& [start, end, delta] : ramps.cast<std::vector<std::tuple<double, double, double>>>())
        result.push_back({start, end, delta});
    return result;
}

// Lets copies in Python share the object, which never changes.
template <class Class>
void share_in_copies(Class& bound)
{
    bound.def("__copy__", [](const py::object& self) { return self; })
        .def("__deepcopy__", [](const py::object& self, const py::dict&) { return self; }, py::arg("memo"));
}

}  // namespace eel_core
