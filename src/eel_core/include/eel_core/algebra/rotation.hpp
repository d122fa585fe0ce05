// SPDX-License-Identifier: Apache-2.0
// Rotations of neighbouring sections: R' = R hat(K) by a Magnus series, and the product of quaternions.
#pragma once

#include "eel_core/algebra/motion.hpp"

namespace eel_core {

template <Number T>
struct Quaternion {
    T x, y, z, w;

    // This rotation followed by `next` in the rotated axes.
    friend Quaternion operator*(const Quaternion& a, const Quaternion& next)
    {
        return {(a.w * next.x + a.x * next.w) + (a.y * next.z - a.z * next.y),
                (a.w * next.y - a.x * next.z) + (a.y * next.w + a.z * next.x),
                (a.w * next.z + a.x * next.y) + (a.z * next.w - a.y * next.x),
                (a.w * next.w - a.x * next.x) - (a.y * next.y + a.z * next.z)};
    }

    // Columns of the rotation matrix of a unit quaternion.
    Frame3<T> frame() const
    {
        const T xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
        const T wx = w * x, wy = w * y, wz = w * z;
        return {{1.0 - 2.0 * (yy + zz), 2.0 * (xy + wz), 2.0 * (xz - wy)},
                {2.0 * (xy - wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz + wx)},
                {2.0 * (xz + wy), 2.0 * (yz - wx), 1.0 - 2.0 * (xx + yy)}};
    }
};

template <Number T>
struct Components<Quaternion<T>> {
    static constexpr std::size_t count = 4;
    template <class Make>
    static Quaternion<T> make(Make component, std::size_t first = 0)
    {
        return {component(first), component(first + 1), component(first + 2), component(first + 3)};
    }
    template <class Take>
    static void each(const Quaternion<T>& q, Take take, std::size_t first = 0)
    {
        take(first, q.x), take(first + 1, q.y), take(first + 2, q.z), take(first + 3, q.w);
    }
};

// The quaternion of a rotation by a vector [rad] of any length.
inline Quaternion<double> rotation_by(const Vector3<double>& vector)
{
    const double angle = std::sqrt(dot(vector, vector));
    const double s = angle > 1e-8 ? std::sin(0.5 * angle) / angle : 0.5;
    return {s * vector.x, s * vector.y, s * vector.z, std::cos(0.5 * angle)};
}
inline Quaternion<Lanes> rotation_by(const Vector3<Lanes>& vector)
{
    constexpr double series_ends = 0.25;  // square of half an angle
    const Lanes square = 0.25 * dot(vector, vector);
    if ((square > series_ends).any()) {
        std::array<std::array<double, width>, 4> far;
        for (std::size_t lane = 0; lane < width; ++lane)
            Components<Quaternion<double>>::each(rotation_by(Vector3{vector.x[lane], vector.y[lane], vector.z[lane]}),
                                                 [&](std::size_t c, double component) { far[c][lane] = component; });
        return Components<Quaternion<Lanes>>::make([&](std::size_t c) { return Lanes::load(far[c].data()); });
    }
    const auto [s, c] = sine_and_cosine_series(square);
    const Lanes half = 0.5 * s;
    return {half * vector.x, half * vector.y, half * vector.z, c};
}

// Rotations over the intervals between nodes, by the sixth-order Magnus series (Blanes, Casas and Ros, BIT 40 (2000)).
// b0, b1, b2: the moments B0, alpha2, alpha3 [rad] of (K2, K3) over each interval, from its first three Legendre
// moments. Exact where K keeps its direction.
inline Quaternion<Lanes> magnus(const Vector2<Lanes>& b0, const Vector2<Lanes>& b1, const Vector2<Lanes>& b2)
{
    const Vector2<Lanes> a = b0 - Lanes(1.0 / 12.0) * b2, u = Lanes(20.0) * a + b2;
    const Lanes c = cross(a, b1);
    const Lanes w1 = Lanes(-1.0 / 30.0) * cross(a, b2);
    const Lanes w2 = a.y * c * (1.0 / 60.0) - b1.x, w3 = -(a.x * c) * (1.0 / 60.0) - b1.y;
    return rotation_by(Vector3<Lanes>{Lanes(-1.0 / 240.0) * (u.x * w3 - u.y * w2),
                                      b0.x - (u.y * w1 - c * w3) * (1.0 / 240.0),
                                      b0.y - (c * w2 - u.x * w1) * (1.0 / 240.0)});
}

// Each quaternion of a block times all previous ones in the block: products of 2, 4, 8 successive ones.
template <std::size_t Steps = 1>
Quaternion<Lanes> successive_products(const Quaternion<Lanes>& q)
{
    if constexpr (Steps == width)
        return q;
    else
        return successive_products<2 * Steps>(Quaternion<Lanes>{moved<Steps>(q.x, 0.0), moved<Steps>(q.y, 0.0),
                                                                moved<Steps>(q.z, 0.0), moved<Steps>(q.w, 1.0)} *
                                              q);
}

}  // namespace eel_core
