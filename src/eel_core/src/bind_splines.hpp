// SPDX-License-Identifier: Apache-2.0
// Splines through samples, and their peaks, for Python: arrays of any shape by their first axis.
#pragma once

#include <limits>

#include "eel_core/algebra/peaks.hpp"
#include "from_python.hpp"

namespace eel_core {

inline py::object numpy(const char* function, const py::object& argument)
{
    return py::module_::import("numpy").attr(function)(argument, py::arg("dtype") = "d", py::arg("order") = "C");
}

// Points and the values at them. Throws for what no spline goes through.
struct Samples {
    Samples(const py::object& x, const py::object& values)
        : own_x(numpy("asarray", x)), own_values(numpy("asarray", values)), x(own_x, "x"), values(own_values, "values")
    {
        const std::size_t n = this->x.size();
        if (n < 1 || this->values.size() % n != 0 || this->values.length(0) != n)
            throw py::value_error("values must have a row for each of the " + std::to_string(n) + " points");
        const auto finite = [](const Numbers& numbers) {
            return std::ranges::all_of(numbers.span(), [](double number) { return std::isfinite(number); });
        };
        if (!finite(this->x) || !finite(this->values)) throw py::value_error("samples must be finite");
        if (std::ranges::adjacent_find(this->x.span(), std::greater_equal{}) != this->x.span().end())
            throw py::value_error("points must rise");
    }
    py::object own_x, own_values;
    Numbers x, values;
};

inline std::size_t checked_degree(std::size_t degree)
{
    if (degree > Spline::highest || degree % 2 == 0)
        throw py::value_error("degree must be 1, 3 or 5, got " + std::to_string(degree));
    return degree;
}

class PySpline {
  public:
    PySpline(const Samples& samples, std::size_t degree)
        : spline_(samples.x.span(), samples.values.vector(), checked_degree(degree)),
          shape_(samples.own_values.attr("shape")[py::slice(1, std::nullopt, std::nullopt)])
    {
    }
    py::object at(const py::object& x) const
    {
        return rows(x, [&](double place, double* into) { spline_.at(place, into); });
    }
    py::object integral(const py::object& x) const
    {
        const auto sums = spline_.integrals();
        return rows(x, [&](double place, double* into) { spline_.integral(sums, place, into); });
    }

  private:
    template <class Row>
    py::object rows(const py::object& x, const Row& row) const
    {
        const py::object places = numpy("asarray", x), shape = places.attr("shape");
        const py::object result = numpy("empty", shape + shape_);
        const Numbers from(places, "x"), into(result, "values", true);
        for (std::size_t k = 0; k < from.size(); ++k) row(from.data()[k], into.data() + k * spline_.columns());
        return result;
    }

    Spline spline_;
    py::object shape_;
};

inline void bind_splines(py::module_& module)
{
    py::class_<PySpline>(module, "Spline")
        .def(py::init([](const py::object& x, const py::object& values, std::size_t degree) {
                 return PySpline(Samples(x, values), degree);
             }),
             py::arg("x"), py::arg("values"), py::arg("degree") = 3)
        .def("at", &PySpline::at, py::arg("x"))
        .def("integral", &PySpline::integral, py::arg("x"));

    constexpr double infinity = std::numeric_limits<double>::infinity();
    module.def(
        "peaks",
        [](const py::object& x, const py::object& values, std::size_t width, bool with_sign, const py::object& weights,
           double start, double end, double near, std::size_t beside) {
            const Samples samples(x, values);
            const py::object by = numpy("asarray", weights);
            Size size{width, with_sign, Numbers(by, "weights").vector()};
            const std::size_t columns = samples.values.size() / samples.x.size();
            if (width < 1 || columns % width != 0 || (!size.weights.empty() && size.weights.size() != width))
                throw py::value_error("width must fit the values and weights, got " + std::to_string(width));
            std::vector<Peak> found;
            {
                const py::gil_scoped_release unlocked;
                found =
                    peaks(samples.x.span(), samples.values.data(), columns / width, size, {start, end, near, beside});
            }
            const py::object result = numpy("empty", py::make_tuple(2, found.size()));
            double* into = Numbers(result, "peaks", true).data();
            for (const Peak& peak : found) into[0] = peak.size, into++ [found.size()] = peak.place;
            return result;
        },
        py::arg("x"), py::arg("values"), py::kw_only(), py::arg("width") = 1, py::arg("with_sign") = false,
        py::arg("weights") = py::tuple(), py::arg("start") = -infinity, py::arg("end") = infinity,
        py::arg("near") = 0.0, py::arg("beside") = 0);
}

}  // namespace eel_core
