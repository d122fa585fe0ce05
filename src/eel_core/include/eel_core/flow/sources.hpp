// SPDX-License-Identifier: Apache-2.0
// Flows of the water without the swimmer, in the axes of the paper's world. Each source, at an instant, is a function
// of the place: a template over the number, so that it serves the nose and the nodes.
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

// The same everywhere.
struct EverywhereAlike {
    Vector3<double> u, u_t;

    template <Number T>
    WaterAt<T> operator()(const Vector3<T>&) const
    {
        WaterAt<T> water{};
        water.u = {T(u.x), T(u.y), T(u.z)}, water.u_t = {T(u_t.x), T(u_t.y), T(u_t.z)};
        return water;
    }
};

// `velocity` [m/s], times the sum of the ramps f_r of eq. (64), or times 1 where there are none.
struct RampedFlow {
    Vector3<double> velocity;
    std::vector<Ramp> ramps;

    EverywhereAlike at(double time) const
    {
        Jet factor{ramps.empty() ? 1.0 : 0.0};
        for (const Ramp& ramp : ramps) ramp.add_to(factor, time);
        return {factor[0] * velocity, factor[1] * velocity};
    }
};

// Cubics in time between knots [s], ascending; held before the first and after the last.
struct SplineFlow {
    std::vector<double> knots;
    std::vector<std::array<Vector3<double>, 4>> pieces;  // by powers of the time since the knot, from the constant on

    EverywhereAlike at(double time) const
    {
        const double within = std::clamp(time, knots.front(), knots.back());
        const auto behind = std::upper_bound(knots.begin() + 1, knots.end() - 1, within);
        const auto piece = static_cast<std::size_t>(behind - knots.begin()) - 1;
        const double s = within - knots[piece];
        const auto& c = pieces[piece];
        const Vector3<double> rate = c[1] + s * (2.0 * c[2] + 3.0 * s * c[3]);
        return {c[0] + s * (c[1] + s * (c[2] + s * c[3])), within == time ? rate : Vector3<double>{}};
    }
};

// velocity tanh(d / width), or velocity d / width where it is `linear`; d: distance along the unit vector `across` from
// the place where its part along that vector is `middle` [m].
struct ShearFlow {
    Vector3<double> velocity, across;
    double middle, width;
    bool linear;

    const ShearFlow& at(double) const { return *this; }
    template <Number T>
    WaterAt<T> operator()(const Vector3<T>& x) const
    {
        const T s = (dot(across, x) - middle) * (1.0 / width);
        T value = s, slope(1.0);
        if (!linear) {
            const T e = exponential(-2.0 * abs(s)), sum = 1.0 + e;
            value = with_sign_of((1.0 - e) / sum, s), slope = 4.0 * e / (sum * sum);
        }
        WaterAt<T> water{};
        water.u = value * velocity;
        const Vector3<T> gradient = (slope * (1.0 / width)) * across;
        water.g = {velocity.x * gradient, velocity.y * gradient, velocity.z * gradient};
        return water;
    }
};

// Vortices of Lamb and Oseen about vertical axes, which drift alike:
//
//     u = Gamma / (2 pi r^2) (1 - exp(-r^2 / r_c^2)) (-y, x)
struct VortexFlow {
    struct Vortex {
        double x, y, strength;  // [m], [m], Gamma / 2 pi [m^2/s]
    };
    std::vector<Vortex> vortices;  // at time 0
    double core;                   // [m], r_c
    Vector3<double> drift;         // [m/s]

    struct Now {
        const VortexFlow& flow;
        double time;

        template <Number T>
        WaterAt<T> operator()(const Vector3<T>& place) const
        {
            const double by_core = 1.0 / (flow.core * flow.core);
            T u(0.0), v(0.0), shear(0.0), along(0.0), across(0.0);
            for (const Vortex& vortex : flow.vortices) {
                const T x = place.x - (vortex.x + time * flow.drift.x), y = place.y - (vortex.y + time * flow.drift.y);
                const T square = x * x + y * y;
                const auto [swirl, slope] = swirl_and_slope(square * by_core);
                const T turn = vortex.strength * by_core * swirl;
                const T bend = 2.0 * vortex.strength * by_core * by_core * slope;
                u -= turn * y, v += turn * x;
                shear += bend * x * y, along += turn + bend * x * x, across += turn + bend * y * y;
            }
            WaterAt<T> water{};
            water.u = {u, v, T(0.0)};
            water.g = {{-shear, -across, T(0.0)}, {along, shear, T(0.0)}, {T(0.0), T(0.0), T(0.0)}};
            water.u_t = -water.g.times(flow.drift);
            return water;
        }
    };
    Now at(double time) const { return {*this, time}; }

    // f = (1 - exp(-s)) / s and its derivative: by the series where s is small, and without the exponential where that
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

    struct Now {
        const WaveFlow& flow;
        double phase;

        template <Number T>
        WaterAt<T> operator()(const Vector3<T>& x) const
        {
            const double k = flow.wavenumber, w = flow.frequency;
            const Vector3<double>&d = flow.direction, up{0.0, 0.0, 1.0};
            const auto [s, c] = sine_and_cosine(k * dot(d, x) + phase);
            const T size = flow.amplitude * w * exponential(k * (x.z - flow.surface)), slope = k * size;
            WaterAt<T> water{};
            water.u = (size * c) * d + (size * s) * up;
            water.u_t = (w * size * s) * d - (w * size * c) * up;
            const Vector3<T> of_along = (-(slope * s)) * d + (slope * c) * up;
            water.g = {d.x * of_along, d.y * of_along, (slope * c) * d + (slope * s) * up};
            return water;
        }
    };
    Now at(double time) const
    {
        constexpr double turn = 2.0 * std::numbers::pi;
        return {*this, std::fmod(start - frequency * time, turn)};
    }
};

// A function of the user: `rows` (n, 18) of which it reads the place x (3) and writes u (3), u_t (3) and the Jacobian
// (3, 3), row by row.
struct FunctionFlow {
    static constexpr std::size_t columns = 18;
    std::function<void(double time, std::vector<double>& rows)> function;
};

struct Flow {
    std::vector<std::variant<RampedFlow, SplineFlow, ShearFlow, VortexFlow, WaveFlow, GriddedFlow, FunctionFlow>>
        sources;
};

// Writes u, u_t and the Jacobian at the places of `rows` (count, 18), as those of `FunctionFlow`, into them.
inline void flow_at(const Flow& flow, double time, double* rows, std::size_t count)
{
    constexpr std::size_t columns = FunctionFlow::columns;
    std::vector<WaterAt<double>> sum(count);
    for (const auto& source : flow.sources) {
        if (const auto* const function = std::get_if<FunctionFlow>(&source)) {
            std::vector<double> own(rows, rows + columns * count);
            function->function(time, own);
            for (std::size_t i = 0; i < count; ++i)
                sum[i] += Components<WaterAt<double>>::make([&](std::size_t c) { return own[columns * i + 3 + c]; });
            continue;
        }
        std::visit(
            [&]<class Source>(const Source& each) {
                if constexpr (!std::same_as<Source, FunctionFlow>) {
                    const auto& now = each.at(time);
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

// The water of a run: it moves with the `current` [m/s], in the world's axes, and with the flow besides. Motions are
// those in the frame of the current: an exact shift of frame.
struct Water {
    Vector3<double> current{0.0, 0.0, 0.0};
    std::shared_ptr<const Flow> flow{};  // none: at rest in that frame
};

}  // namespace eel_core
