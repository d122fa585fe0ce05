// SPDX-License-Identifier: Apache-2.0
// The two kinds of motion: in space, and in the plane of axes 1 and 2, where rotations are angles about axis 3.
//
// Vectors have three components in space and two in the plane. Angular quantities (angular velocity, torque, angular
// momentum) are vectors in space and numbers in the plane. Every formula of the mechanics is written once for both.
#pragma once

#include <tuple>

#include "eel_core/algebra/numbers.hpp"

namespace eel_core {

// Inlined first, so that members of compounds stay in registers.
#define EEL_CORE_INLINE __attribute__((always_inline))

// Compounds of numbers, or of further compounds, list their members in order. Addition, sums and stores go through this
// list.
template <class T>
concept Compound = requires { T::members; };

// The same compound with another number type.
// clang-format off
template <class C, Number B> struct Rebound;
template <Number T, Number B> struct Rebound<T, B> { using Type = B; };
template <template <Number> class C, Number T, Number B> struct Rebound<C<T>, B> { using Type = C<B>; };
template <template <class, Number> class C, class M, Number T, Number B> struct Rebound<C<M, T>, B> { using Type = C<M, B>; };
// clang-format on
template <class C, Number B>
using With = typename Rebound<C, B>::Type;

// Components of a compound, one after the other.
template <class T>
struct Components;
template <Number T>
struct Components<T> {
    static constexpr std::size_t count = 1;
    EEL_CORE_INLINE static T make(const auto& component, std::size_t first = 0) { return component(first); }
    EEL_CORE_INLINE static void each(const T& value, const auto& take, std::size_t first = 0) { take(first, value); }
};
template <Compound C, std::size_t K>
inline constexpr auto member = std::get<K>(C::members);
template <Compound C>
using Members = std::make_index_sequence<std::tuple_size_v<decltype(C::members)>>;
template <Compound C>
struct Components<C> {
    template <std::size_t K>
    using Member = Components<std::decay_t<decltype(std::declval<C>().*member<C, K>)>>;
    static constexpr std::size_t count = []<std::size_t... K>(std::index_sequence<K...>) {
        return (Member<K>::count + ...);
    }(Members<C>());
    EEL_CORE_INLINE static C make(const auto& component, std::size_t first = 0)
    {
        return [&]<std::size_t... K>(std::index_sequence<K...>) EEL_CORE_INLINE {
            return C{Member<K>::make(component, std::exchange(first, first + Member<K>::count))...};
        }(Members<C>());
    }
    EEL_CORE_INLINE static void each(const C& value, const auto& take, std::size_t first = 0)
    {
        [&]<std::size_t... K>(std::index_sequence<K...>) EEL_CORE_INLINE {
            ((Member<K>::each(value.*member<C, K>, take, first), first += Member<K>::count), ...);
        }(Members<C>());
    }
};

template <Compound C>
EEL_CORE_INLINE inline C& operator+=(C& a, const C& b)
{
    [&]<std::size_t... K>(std::index_sequence<K...>)
        EEL_CORE_INLINE { ((a.*member<C, K> += b.*member<C, K>), ...); }(Members<C>());
    return a;
}

template <Number T>
struct Vector2 {
    T x, y;
    static constexpr std::tuple members{&Vector2::x, &Vector2::y};
};
template <Number T>
struct Vector3 {
    T x, y, z;
    static constexpr std::tuple members{&Vector3::x, &Vector3::y, &Vector3::z};
};
template <Number T>
Vector2(T, T) -> Vector2<T>;  // Clang deduces an aggregate's arguments from version 17 on only
template <Number T>
Vector3(T, T, T) -> Vector3<T>;

// clang-format off
template <Number A, Number B> auto operator+(Vector2<A> a, Vector2<B> b) { return Vector2{a.x + b.x, a.y + b.y}; }
template <Number A, Number B> auto operator+(Vector3<A> a, Vector3<B> b) { return Vector3{a.x + b.x, a.y + b.y, a.z + b.z}; }
template <Number A, Number B> auto operator-(Vector2<A> a, Vector2<B> b) { return Vector2{a.x - b.x, a.y - b.y}; }
template <Number A, Number B> auto operator-(Vector3<A> a, Vector3<B> b) { return Vector3{a.x - b.x, a.y - b.y, a.z - b.z}; }
template <Number A> auto operator-(Vector2<A> a) { return Vector2{-a.x, -a.y}; }
template <Number A> auto operator-(Vector3<A> a) { return Vector3{-a.x, -a.y, -a.z}; }
template <Number A, Number B> auto operator*(A a, Vector2<B> b) { return Vector2{a * b.x, a * b.y}; }
template <Number A, Number B> auto operator*(A a, Vector3<B> b) { return Vector3{a * b.x, a * b.y, a * b.z}; }

template <Number A, Number B> auto dot(A a, B b) { return a * b; }
template <Number A, Number B> auto dot(Vector2<A> a, Vector2<B> b) { return a.x * b.x + a.y * b.y; }
template <Number A, Number B> auto dot(Vector3<A> a, Vector3<B> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

template <Number A, Number B> auto cross(Vector3<A> a, Vector3<B> b)
{
    return Vector3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <Number A, Number B> auto cross(Vector2<A> a, Vector2<B> b) { return a.x * b.y - a.y * b.x; }
template <Number A, Number B> auto cross(A turning, Vector2<B> b) { return Vector2{-turning * b.y, turning * b.x}; }
template <Number A, Number B> auto cross(A, B) { return decltype(A() * B())(0.0); }  // both along axis 3
// clang-format on

// Axes of a section, or of the head, in its parent's axes: t1, t2, t3 are the columns of a rotation.
template <Number T>
struct Frame3 {
    Vector3<T> axis1, axis2, axis3;
    static constexpr std::tuple members{&Frame3::axis1, &Frame3::axis2, &Frame3::axis3};

    Vector3<T> t1() const { return axis1; }
    // From components in the parent's axes to components in these axes; and the inverse.
    auto local(auto v) const { return Vector3{dot(axis1, v), dot(axis2, v), dot(axis3, v)}; }
    auto parent(auto v) const { return v.x * axis1 + v.y * axis2 + v.z * axis3; }
};

template <Number T>
struct Frame2 {
    T cosine, sine;
    static constexpr std::tuple members{&Frame2::cosine, &Frame2::sine};

    Vector2<T> t1() const { return {cosine, sine}; }
    auto local(auto v) const { return Vector2{cosine * v.x + sine * v.y, cosine * v.y - sine * v.x}; }
    auto parent(auto v) const { return Vector2{cosine * v.x - sine * v.y, sine * v.x + cosine * v.y}; }
    auto local(Number auto turning) const { return turning; }
    auto parent(Number auto turning) const { return turning; }
};

// Symmetric matrices.
template <Number T>
struct Symmetric2 {
    T xx, xy, yy;
    static constexpr std::tuple members{&Symmetric2::xx, &Symmetric2::xy, &Symmetric2::yy};
};
template <Number T>
struct Symmetric3 {
    T xx, xy, xz, yy, yz, zz;
    static constexpr std::tuple members{&Symmetric3::xx, &Symmetric3::xy, &Symmetric3::xz,
                                        &Symmetric3::yy, &Symmetric3::yz, &Symmetric3::zz};
};
template <Number T>
Vector2<T> operator*(const Symmetric2<T>& a, const Vector2<T>& v)
{
    return {a.xx * v.x + a.xy * v.y, a.xy * v.x + a.yy * v.y};
}
template <Number T>
Vector3<T> operator*(const Symmetric3<T>& a, const Vector3<T>& v)
{
    return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
            a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

struct Space {
    template <Number T>
    using Vector = Vector3<T>;
    template <Number T>
    using Angular = Vector3<T>;
    template <Number T>
    using Frame = Frame3<T>;
    static constexpr bool planar = false;
    static constexpr std::size_t freedoms = 6;
};

struct Plane {
    template <Number T>
    using Vector = Vector2<T>;
    template <Number T>
    using Angular = T;
    template <Number T>
    using Frame = Frame2<T>;
    static constexpr bool planar = true;
    static constexpr std::size_t freedoms = 3;
};

template <class M, Number T>
using Vector = typename M::template Vector<T>;
template <class M, Number T>
using Angular = typename M::template Angular<T>;
template <class M, Number T>
using Frame = typename M::template Frame<T>;

// An angular and a linear part; about the head and in its axes, unless stated otherwise.
template <class M, Number T>
struct Spatial {
    Angular<M, T> angular;
    Vector<M, T> linear;
    static constexpr std::tuple members{&Spatial::angular, &Spatial::linear};

    template <Number B>
    friend auto operator+(const Spatial& a, const Spatial<M, B>& b)
    {
        return Spatial<M, decltype(T() + B())>{a.angular + b.angular, a.linear + b.linear};
    }
    template <Number B>
    friend auto operator-(const Spatial& a, const Spatial<M, B>& b)
    {
        return Spatial<M, decltype(T() - B())>{a.angular - b.angular, a.linear - b.linear};
    }
    friend Spatial operator-(const Spatial& a) { return {-a.angular, -a.linear}; }
    template <Number B>
    friend auto operator*(B factor, const Spatial& a)
    {
        return Spatial<M, decltype(B() * T())>{factor * a.angular, factor * a.linear};
    }
};
template <class M, Number T>
using Twist = Spatial<M, T>;  // Omega [rad/s], V [m/s]; or its rate
template <class M, Number T>
using Wrench = Spatial<M, T>;  // torque [N m], force [N]; or per length
template <class M, Number T>
using Momentum = Spatial<M, T>;  // [kg m^2/s], [kg m/s]

// The wrench about the head, from torque and force in the axes of a section at `position` with axes `frame`: Ad*.
template <class M>
EEL_CORE_INLINE inline auto about_head(const auto& frame, const auto& position, const auto& in_section)
{
    const auto force = frame.parent(in_section.linear);
    return Wrench<M, decltype(force.x)>{frame.parent(in_section.angular) + cross(position, force), force};
}

// The `wrench` plus a force along axis 1.
template <class M, Number T>
Wrench<M, T> plus_axial(Wrench<M, T> wrench, T force)
{
    wrench.linear.x += force;
    return wrench;
}

// Sum of the lanes of each component.
template <class S>
With<S, double> total_of(const S& value)
{
    std::array<double, Components<S>::count> sums;
    Components<S>::each(value, [&](std::size_t k, Lanes lanes) { sums[k] = total(lanes); });
    return Components<With<S, double>>::make([&](std::size_t k) { return sums[k]; });
}

// Components of `value` by index.
template <class S>
auto components_of(const S& value)
{
    std::array<double, Components<S>::count> result;
    Components<S>::each(value, [&](std::size_t k, double component) { result[k] = component; });
    return result;
}

}  // namespace eel_core
