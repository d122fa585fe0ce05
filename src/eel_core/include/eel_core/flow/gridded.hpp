// SPDX-License-Identifier: Apache-2.0
// A flow given at the points of a grid in time and space, with Catmull-Rom cubics in between. The velocity has one
// continuous derivative in space and in time: at each point of an axis that of the parabola through the point and its
// two neighbours, and at the ends of the axis that of the parabola through the last three points.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "eel_core/flow/sample.hpp"

namespace eel_core {

// The weights of up to four neighbouring points of an axis, for the value at a place, and for its derivative.
struct AxisWeights {
    std::size_t first = 0, count = 0;
    std::array<double, 4> value{}, slope{};
};

// The points of an axis, ascending. With a single point the flow is uniform along the axis.
struct GridAxis {
    std::vector<double> points;

    bool covers(double place) const { return points.size() == 1 || !(place < points.front() || place > points.back()); }
    AxisWeights at(double place) const
    {
        const std::size_t size = points.size();
        if (size == 1) return {0, 1, {1.0}, {}};
        const auto behind = std::upper_bound(points.begin() + 1, points.end() - 1, place);
        const auto cell = static_cast<std::size_t>(behind - points.begin()) - 1;
        AxisWeights weights;
        weights.count = std::min<std::size_t>(size, 4);
        weights.first = std::min(cell - std::min<std::size_t>(cell, 1), size - weights.count);
        const double length = points[cell + 1] - points[cell], s = (place - points[cell]) / length, t = 1.0 - s;
        const auto add = [&](std::size_t point, double value, double slope) {
            weights.value[point - weights.first] += value, weights.slope[point - weights.first] += slope;
        };
        add(cell, t * t * (1.0 + 2.0 * s), -6.0 * s * t / length);  // Hermite's cubics
        add(cell + 1, s * s * (1.0 + 2.0 * t), 6.0 * s * t / length);
        add_tangent(cell, length * s * t * t, t * (1.0 - 3.0 * s), add);
        add_tangent(cell + 1, -length * s * s * t, s * (3.0 * s - 2.0), add);
        return weights;
    }

  private:
    // Adds the derivative at a point times these factors.
    void add_tangent(std::size_t point, double value, double slope, const auto& add) const
    {
        if (points.size() == 2) {
            const double inverse = 1.0 / (points[1] - points[0]);
            add(0, -inverse * value, -inverse * slope), add(1, inverse * value, inverse * slope);
            return;
        }
        const std::size_t middle = std::clamp<std::size_t>(point, 1, points.size() - 2);
        for (std::size_t i = middle - 1; i <= middle + 1; ++i) {  // Lagrange's parabolas through three points
            const std::size_t j = i == middle - 1 ? middle : middle - 1, k = i == middle + 1 ? middle : middle + 1;
            const double x = points[point], factor = (2.0 * x - points[j] - points[k]) /
                                                     ((points[i] - points[j]) * (points[i] - points[k]));
            add(i, factor * value, factor * slope);
        }
    }
};

struct GriddedFlow {
    using Point = std::array<double, 4>;  // u [m/s], and padding

    std::array<GridAxis, 4> axes;                      // t [s], x, y, z [m]
    std::shared_ptr<const std::vector<Point>> points;  // in that order, the last axis fastest

    struct Now {
        const GriddedFlow& flow;
        AxisWeights time;

        // NaN outside the grid.
        FlowSample<Space, double> operator()(const Vector3<double>& place) const
        {
            const auto& [t_axis, x_axis, y_axis, z_axis] = flow.axes;
            Point u{}, rate{}, by_x{}, by_y{}, by_z{};
            if (time.count == 0 || !x_axis.covers(place.x) || !y_axis.covers(place.y) || !z_axis.covers(place.z)) {
                u.fill(std::numeric_limits<double>::quiet_NaN());
                return sample(u, u, u, u, u);
            }
            const AxisWeights x = x_axis.at(place.x), y = y_axis.at(place.y), z = z_axis.at(place.z);
            for (std::size_t i = 0; i < time.count * x.count * y.count; ++i) {
                const std::size_t a = i / (x.count * y.count), b = i / y.count % x.count, c = i % y.count;
                const std::size_t row = ((time.first + a) * x_axis.points.size() + x.first + b) * y_axis.points.size();
                const Point* const line = flow.points->data() + (row + y.first + c) * z_axis.points.size() + z.first;
                Point value{}, slope{};
                for (std::size_t k = 0; k < z.count; ++k)
                    add(z.value[k], line[k], value), add(z.slope[k], line[k], slope);
                const double in_plane = x.value[b] * y.value[c];
                add(time.value[a] * in_plane, value, u);
                add(time.slope[a] * in_plane, value, rate);
                add(time.value[a] * x.slope[b] * y.value[c], value, by_x);
                add(time.value[a] * x.value[b] * y.slope[c], value, by_y);
                add(time.value[a] * in_plane, slope, by_z);
            }
            return sample(u, rate, by_x, by_y, by_z);
        }

      private:
        static void add(double factor, const Point& value, Point& sum)
        {
            for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += factor * value[c];
        }
        static FlowSample<Space, double> sample(const Point& u, const Point& rate, const Point& by_x, const Point& by_y,
                                                const Point& by_z)
        {
            const auto row = [&](std::size_t c) { return Vector3{by_x[c], by_y[c], by_z[c]}; };
            return {{u[0], u[1], u[2]}, {rate[0], rate[1], rate[2]}, {row(0), row(1), row(2)}};
        }
    };
    // At places in the world, for any view.
    Now at(double time, const auto&) const { return {*this, axes[0].covers(time) ? axes[0].at(time) : AxisWeights{}}; }
};

}  // namespace eel_core
