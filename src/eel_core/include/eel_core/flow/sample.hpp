// SPDX-License-Identifier: Apache-2.0
// The undisturbed water at a point: its velocity u, the rate u_t of u at the fixed point, and the Jacobian of u.
#pragma once

#include "eel_core/algebra/motion.hpp"

namespace eel_core {

// g_ij = du_i/dx_j [1/s]: each row is the gradient of a component of u.
template <class M, Number T>
struct Jacobian;

template <Number T>
struct Jacobian<Space, T> {
    Vector3<T> x, y, z;
    static constexpr std::tuple members{&Jacobian::x, &Jacobian::y, &Jacobian::z};

    auto times(const auto& v) const { return Vector3{dot(x, v), dot(y, v), dot(z, v)}; }  // g v
    auto transposed_times(const auto& v) const { return v.x * x + v.y * y + v.z * z; }    // g^T v
    // Component of the curl of u along `axis`.
    auto curl_along(const auto& axis) const
    {
        return axis.x * (z.y - y.z) + axis.y * (x.z - z.x) + axis.z * (y.x - x.y);
    }
    // R^T g R: the same tensor in the axes of `frame`.
    Jacobian in(const Frame3<double>& frame) const
    {
        const Vector3<T> a = frame.local(x), b = frame.local(y), c = frame.local(z);
        const auto row = [&](const Vector3<double>& axis) { return axis.x * a + axis.y * b + axis.z * c; };
        return {row(frame.axis1), row(frame.axis2), row(frame.axis3)};
    }
};

template <Number T>
struct Jacobian<Plane, T> {
    Vector2<T> x, y;
    static constexpr std::tuple members{&Jacobian::x, &Jacobian::y};

    auto times(const auto& v) const { return Vector2{dot(x, v), dot(y, v)}; }
    auto transposed_times(const auto& v) const { return v.x * x + v.y * y; }
    T curl_along(const auto&) const { return T(0.0); }  // the curl is along axis 3
    Jacobian in(const Frame2<double>& frame) const
    {
        const Vector2<T> a = frame.local(x), b = frame.local(y);
        return {frame.cosine * a + frame.sine * b, frame.cosine * b - frame.sine * a};
    }
};

// The Jacobian of a velocity along `along` with the gradient `gradient`.
template <Number T>
Jacobian<Space, T> outer(const Vector3<double>& along, const Vector3<T>& gradient)
{
    return {along.x * gradient, along.y * gradient, along.z * gradient};
}
template <Number T>
Jacobian<Plane, T> outer(const Vector2<double>& along, const Vector2<T>& gradient)
{
    return {along.x * gradient, along.y * gradient};
}

template <class M, Number T>
struct FlowSample {
    Vector<M, T> u;    // [m/s]
    Vector<M, T> u_t;  // [m/s^2]
    Jacobian<M, T> g;  // [1/s]
    static constexpr std::tuple members{&FlowSample::u, &FlowSample::u_t, &FlowSample::g};

    // Acceleration [m/s^2] of the water, a_u = u_t + g u.
    Vector<M, T> acceleration() const { return u_t + g.times(u); }
};

// The part of a sample in the plane of axes 1 and 2, or the whole sample.
template <Number T>
FlowSample<Plane, T> part_in(Plane, const FlowSample<Space, T>& s)
{
    return {{s.u.x, s.u.y}, {s.u_t.x, s.u_t.y}, {{s.g.x.x, s.g.x.y}, {s.g.y.x, s.g.y.y}}};
}
template <Number T>
FlowSample<Space, T> part_in(Space, const FlowSample<Space, T>& s)
{
    return s;
}

}  // namespace eel_core
