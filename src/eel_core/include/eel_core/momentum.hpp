// SPDX-License-Identifier: Apache-2.0
// Inertia and momentum of body and water about the head, and the twist for a given momentum: section 6.
//
//     momentum = I_o twist + momentum of the change of shape
#pragma once

#include "eel_core/kinematics.hpp"
#include "eel_core/loads/fins.hpp"
#include "eel_core/loads/moving_water.hpp"
#include "eel_core/loads/weight.hpp"

namespace eel_core {

// I_o in three parts: angular momentum per Omega, per V (column by column), linear momentum per V.
template <class M, Number T>
struct Inertia;

template <Number T>
struct Inertia<Space, T> {
    Symmetric3<T> angular;
    Vector3<T> by_v1, by_v2, by_v3;
    Symmetric3<T> linear;
    static constexpr std::tuple members{&Inertia::angular, &Inertia::by_v1, &Inertia::by_v2, &Inertia::by_v3,
                                        &Inertia::linear};

    // For a section at r with mass matrix A and inertia matrix about the head's axes: r x A, and r x A x r^T.
    EEL_CORE_INLINE static Inertia of(const Symmetric3<T>& turning, const Symmetric3<T>& a, const Vector3<T>& r)
    {
        const Vector3<T> c1 = cross(r, Vector3<T>{a.xx, a.xy, a.xz}), c2 = cross(r, Vector3<T>{a.xy, a.yy, a.yz}),
                         c3 = cross(r, Vector3<T>{a.xz, a.yz, a.zz});
        return {{turning.xx + (r.y * c3.x - r.z * c2.x), turning.xy + (r.y * c3.y - r.z * c2.y),
                 turning.xz + (r.y * c3.z - r.z * c2.z), turning.yy + (r.z * c1.y - r.x * c3.y),
                 turning.yz + (r.z * c1.z - r.x * c3.z), turning.zz + (r.x * c2.z - r.y * c1.z)},
                c1,
                c2,
                c3,
                a};
    }
    // For the whole body, with the nose's m_o, which acts on V1.
    Factored<6> whole(double nose_mass) const
    {
        const auto &w = angular, &v = linear;
        const auto &a = by_v1, &b = by_v2, &c = by_v3;
        return {{total(w.xx), total(w.xy), total(w.yy), total(w.xz),
                 total(w.yz), total(w.zz),                                        //
                 total(a.x),  total(a.y),  total(a.z),  total(v.xx) + nose_mass,  //
                 total(b.x),  total(b.y),  total(b.z),  total(v.xy),
                 total(v.yy),  //
                 total(c.x),  total(c.y),  total(c.z),  total(v.xz),
                 total(v.yz), total(v.zz)}};
    }
};

template <Number T>
struct Inertia<Plane, T> {
    T angular, by_v1, by_v2;
    Symmetric2<T> linear;
    static constexpr std::tuple members{&Inertia::angular, &Inertia::by_v1, &Inertia::by_v2, &Inertia::linear};

    static Inertia of(T turning, const Symmetric2<T>& a, const Vector2<T>& r)
    {
        const T c1 = cross(r, Vector2<T>{a.xx, a.xy}), c2 = cross(r, Vector2<T>{a.xy, a.yy});
        return {turning + (r.x * c2 - r.y * c1), c1, c2, a};
    }
    Factored<3> whole(double nose_mass) const
    {
        return {{total(angular), total(by_v1), total(linear.xx) + nose_mass, total(by_v2), total(linear.xy),
                 total(linear.yy)}};
    }
};

// Adds the inertia of the sections' moments s = m e, and returns their momentum of the change of shape: Omega x s, with
// r x (Omega x s) + s x V about the head.
EEL_CORE_APART inline Momentum<Space, double> add_offset_inertia(const Swimmer& swimmer, Workspace<Space>& work)
{
    Inertia<Space, Lanes> inertia{};
    Momentum<Space, Lanes> momentum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Lanes lever = swimmer.grid.weight[k] * swimmer.sections.lever[k];
        const Vector3<Lanes> s = mass_moment(lever, work.frame[k].axis3), r = work.position[k];
        const Vector3<Lanes> linear = cross(work.shape_omega[k], s);
        momentum += {cross(r, linear) + cross(s, work.shape_velocity[k]), linear};
        const Lanes zero(0.0);
        inertia += {{2.0 * (r.y * s.y + r.z * s.z), -(r.x * s.y) - r.y * s.x, -(r.x * s.z) - r.z * s.x,
                     2.0 * (r.x * s.x + r.z * s.z), -(r.y * s.z) - r.z * s.y, 2.0 * (r.x * s.x + r.y * s.y)},
                    {zero, s.z, -s.y},
                    {-s.z, zero, s.x},
                    {s.y, -s.x, zero},
                    {}};
    }
    const auto added = inertia.whole(0.0).lower;
    for (std::size_t k = 0; k < added.size(); ++k) work.inertia.lower[k] += added[k];
    return total_of(momentum);
}

// Sets the inertia of a configured body. Returns the momentum of its change of shape, without the nose's.
template <class M>
Momentum<M, double> inertia_and_momentum(const Swimmer& swimmer, Workspace<M>& work)
{
    Inertia<M, Lanes> inertia{};
    Momentum<M, Lanes> momentum{};
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto section = swimmer.sections[k].weighed(swimmer.grid.weight[k]);
        const auto frame = work.frame[k];
        const auto position = work.position[k];
        const auto mass = section.mass_matrix(frame);
        const auto turning = section.inertia_matrix(frame);
        inertia += Inertia<M, Lanes>::of(turning, mass, position);
        const auto linear = mass * work.shape_velocity[k];
        momentum += {turning * work.shape_omega[k] + cross(position, linear), linear};
    }
    work.inertia = inertia.whole(swimmer.nose_mass);
    Momentum<M, double> whole = total_of(momentum);
    if constexpr (!M::planar) {
        if (swimmer.offset) whole += add_offset_inertia(swimmer, work);
        if (!work.fins.empty()) whole += add_fin_inertia(swimmer, work);
    }
    return whole;
}

// Sets the head's twist from `work.momentum` in a configured body, and factors the inertia. False if that is not
// positive definite.
template <class M>
EEL_CORE_APART bool find_twist(const Swimmer& swimmer, Workspace<M>& work)
{
    Momentum<M, double> shape = work.shape_momentum = inertia_and_momentum(swimmer, work);
    if (work.flowing) shape = shape - momentum_of_flow(swimmer, work);
    work.factored = work.inertia;
    const bool definite = work.factored.factor();
    auto solution = components_of(work.momentum - shape);
    work.factored.solve(solution);
    work.twist = Components<Twist<M, double>>::make([&](std::size_t k) { return solution[k]; });
    return definite;
}

// The momentum for a twist of the head, in a configured body.
template <class M>
Momentum<M, double> momentum_of(const Swimmer& swimmer, const Twist<M, double>& twist, Workspace<M>& work)
{
    Momentum<M, double> shape = inertia_and_momentum(swimmer, work);
    if (work.flowing) shape = shape - momentum_of_flow(swimmer, work);
    const auto moved = work.inertia.times(components_of(twist));
    return shape + Components<Momentum<M, double>>::make([&](std::size_t k) { return moved[k]; });
}

}  // namespace eel_core
