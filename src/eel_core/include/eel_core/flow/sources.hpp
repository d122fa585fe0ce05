// SPDX-License-Identifier: Apache-2.0
// Flows of the undisturbed water, in the axes of the paper's world. Each source, at an instant and seen from the head,
// is a function of the place r about the head; place and result are in the head's axes. So a source rotates its own
// vectors once, not the water's at each place. The function is a template over the number type, for nose and nodes.
#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "eel_core/flow/gridded.hpp"
#include "eel_core/flow/sample.hpp"
#include "eel_core/law.hpp"

namespace eel_core {

template <Number T>
using WaterAt = FlowSample<Space, T>;

// The view of the water: the head's place [m] in the world, its axes, and the current [m/s]. Rates are those at a place
// that moves with the current.
template <class M>
struct View {
    Vector3<double> nose;
    Frame<M, double> head;
    Vector3<double> current;

    // A world vector, or its part in the plane, in the axes of the head.
    Vector<M, double> local(const Vector3<double>& v) const
    {
        if constexpr (M::planar)
            return head.local(Vector2{v.x, v.y});
        else
            return head.local(v);
    }
};

// A uniform velocity and rate, in the head's axes.
template <class M>
auto everywhere(const Vector<M, double>& u, const Vector<M, double>& u_t)
{
    return [=]<Number T>(const Vector<M, T>& r) {
        FlowSample<M, T> water{};
        water.u = 0.0 * r + u, water.u_t = 0.0 * r + u_t;
        return water;
    };
}

// `velocity` [m/s] times the sum of the ramps f_r of eq. (64), or times 1 without ramps.
struct RampedFlow {
    Vector3<double> velocity;
    std::vector<Ramp> ramps;

    template <class M>
    auto at(double time, const View<M>& view) const
    {
        Jet factor{ramps.empty() ? 1.0 : 0.0};
        for (const Ramp& ramp : ramps) ramp.add_to(factor, time);
        const Vector<M, double> along = view.local(velocity);
        return everywhere<M>(factor[0] * along, factor[1] * along);
    }
};

// Uniform, as a function of time.
struct SplineFlow {
    Cubics<Vector3<double>> velocity;

    template <class M>
    auto at(double time, const View<M>& view) const
    {
        const auto [u, rate] = velocity.at(time);
        return everywhere<M>(view.local(u), view.local(rate));
    }
};

// velocity tanh(d / width), or velocity d / width if `linear`. d: distance along the unit vector `across` from the
// place whose component along that vector is `middle` [m].
struct ShearFlow {
    Vector3<double> velocity, across;
    double middle, width;
    bool linear;

    template <class M>
    auto at(double, const View<M>& view) const
    {
        const double inverse = 1.0 / width, middle_by_width = inverse * (middle - dot(across, view.nose)),
                     passed = inverse * dot(across, view.current);  // rate of d / width due to the current
        return [=, along = view.local(velocity), by_width = inverse * view.local(across),
                linear = linear]<Number T>(const Vector<M, T>& r) {
            const T s = dot(by_width, r) - middle_by_width;
            T value = s, slope(1.0);
            if (!linear) {
                const T e = exponential(-2.0 * abs(s)), part = 1.0 / (1.0 + e);
                value = with_sign_of((1.0 - e) * part, s), slope = 4.0 * e * (part * part);
            }
            return FlowSample<M, T>{value * along, (passed * slope) * along, outer(along, slope * by_width)};
        };
    }
};

// Lamb-Oseen vortices about vertical axes, with a common drift:
//
//     u = Gamma / (2 pi r^2) (1 - exp(-r^2 / r_c^2)) (-y, x)
struct VortexFlow {
    struct Vortex {
        double x, y, strength;  // [m], [m], Gamma / 2 pi [m^2/s]
    };
    std::vector<Vortex> vortices;  // at time 0
    double core;                   // [m], r_c
    Vector3<double> drift;         // [m/s]

    template <class M>
    auto at(double time, const View<M>& view) const
    {
        const Vector<M, double> axis_x = view.local({1.0, 0.0, 0.0}), axis_y = view.local({0.0, 1.0, 0.0});
        const Vector2 nose{view.nose.x - time * drift.x, view.nose.y - time * drift.y};  // minus the drift
        const Vector2 passing{drift.x - view.current.x, drift.y - view.current.y};
        return [=, this, by_core = 1.0 / (core * core)]<Number T>(const Vector<M, T>& r) {
            const T place_x = dot(axis_x, r) + nose.x, place_y = dot(axis_y, r) + nose.y;
            T u(0.0), v(0.0), shear(0.0), along(0.0), across(0.0);
            for (const Vortex& vortex : vortices) {
                const T x = place_x - vortex.x, y = place_y - vortex.y;
                const T square = x * x + y * y;
                const auto [swirl, slope] = swirl_and_slope(square * by_core);
                const T turn = (vortex.strength * by_core) * swirl;
                const T bend = (2.0 * vortex.strength * by_core * by_core) * slope, bend_y = bend * y;
                u -= turn * y, v += turn * x;
                shear += bend_y * x, along += turn + bend * (x * x), across += turn + bend_y * y;
            }
            const Vector<M, T> of_u = -(shear * axis_x + across * axis_y), of_v = along * axis_x + shear * axis_y;
            FlowSample<M, T> water{
                u * axis_x + v * axis_y,
                (shear * passing.x + across * passing.y) * axis_x - (along * passing.x + shear * passing.y) * axis_y,
                outer(axis_x, of_u)};
            water.g += outer(axis_y, of_v);
            return water;
        };
    }

    // f = (1 - exp(-s)) / s and its derivative: from the series for small s, and without the exponential if that
    // is below round-off.
    template <Number T>
    static std::array<T, 2> swirl_and_slope(T s)
    {
        constexpr double small = 0.5, far = 40.0;
        const T divisor = select(s > T(small), s, T(1.0)), inverse = 1.0 / divisor;
        if (!any(s < T(far))) return {inverse, -inverse * inverse};
        const T e = exponential(-s), f = (1.0 - e) * inverse;
        if (!any(s < T(small))) return {f, (e - f) * inverse};
        constexpr int last = 14;
        double coefficient = 1.0;
        for (int n = 2; n <= last + 1; ++n) coefficient /= n;  // 1 / (n + 1)! at n = last
        T sum(coefficient), slope(0.0);
        for (int n = last; n > 0; --n) {  // of f = sum_n (-s)^n / (n + 1)!, by Horner
            coefficient *= n + 1;
            slope = sum - s * slope;
            sum = coefficient - s * sum;
        }
        return {select(s < T(small), sum, f), select(s < T(small), -slope, (e - f) * inverse)};
    }
};

// A wave on deep water, of `amplitude` [m] and wavenumber k [1/m], that runs along the horizontal unit vector d below
// the surface z = `surface` [m]:
//
//     u = amplitude w exp(k (z - surface)) (d cos(phase) + E3 sin(phase)), phase = k d . x - w t + `start`, w^2 = g k
struct WaveFlow {
    double amplitude, wavenumber, frequency, surface, start;
    Vector3<double> direction;

    template <class M>
    auto at(double time, const View<M>& view) const
    {
        constexpr double turn = 2.0 * std::numbers::pi;
        const double k = wavenumber, size = amplitude * frequency;
        const double phase = std::fmod(start - frequency * time, turn) + k * dot(direction, view.nose),
                     depth = k * (surface - view.nose.z);  // at the head
        const double rate = frequency - k * dot(direction, view.current), rise = k * view.current.z;
        return [=, along = view.local(direction), up = view.local({0.0, 0.0, 1.0})]<Number T>(const Vector<M, T>& r) {
            const auto [s, c] = sine_and_cosine(k * dot(along, r) + phase);
            const T speed = size * exponential(k * dot(up, r) - depth), us = speed * s, uc = speed * c;
            FlowSample<M, T> water{uc * along + us * up, (rate * us + rise * uc) * along + (rise * us - rate * uc) * up,
                                   outer(along, (k * uc) * up - (k * us) * along)};
            water.g += outer(up, (k * uc) * along + (k * us) * up);
            return water;
        };
    }
};

// A user's function. rows (n, 18): it reads the place x (3) and writes u (3), u_t (3) and the Jacobian (3, 3), row by
// row.
struct FunctionFlow {
    static constexpr std::size_t columns = 18;
    std::function<void(double time, std::vector<double>& rows)> function;
};
inline WaterAt<double> water_in(const double* row)
{
    return Components<WaterAt<double>>::make([&](std::size_t c) { return row[3 + c]; });
}

struct Flow {
    std::vector<std::variant<RampedFlow, SplineFlow, ShearFlow, VortexFlow, WaveFlow, GriddedFlow, FunctionFlow>>
        sources;
};

// Writes u, u_t and the Jacobian at the places of `rows` (count, 18) into them, like a `FunctionFlow`.
inline void flow_at(const Flow& flow, double time, double* rows, std::size_t count)
{
    constexpr std::size_t columns = FunctionFlow::columns;
    const View<Space> from_the_world{{}, {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, {}};
    std::vector<WaterAt<double>> sum(count);
    for (const auto& source : flow.sources) {
        std::visit(
            [&]<class Source>(const Source& each) {
                if constexpr (std::same_as<Source, FunctionFlow>) {
                    std::vector<double> own(rows, rows + columns * count);
                    each.function(time, own);
                    for (std::size_t i = 0; i < count; ++i) sum[i] += water_in(&own[columns * i]);
                } else {
                    const auto now = each.at(time, from_the_world);
                    for (std::size_t i = 0; i < count; ++i) {
                        const double* const x = rows + columns * i;
                        sum[i] += now(Vector3{x[0], x[1], x[2]});
                    }
                }
            },
            source);
    }
    for (std::size_t i = 0; i < count; ++i)
        Components<WaterAt<double>>::each(sum[i],
                                          [&](std::size_t c, double value) { rows[columns * i + 3 + c] = value; });
}

// The water of a run: it moves with the `current` [m/s], in the world's axes, plus the flow. Motions are relative to
// the frame of the current, which is an exact shift of frame.
struct Water {
    Vector3<double> current{0.0, 0.0, 0.0};
    std::shared_ptr<const Flow> flow{};  // none: at rest in that frame
};

}  // namespace eel_core
