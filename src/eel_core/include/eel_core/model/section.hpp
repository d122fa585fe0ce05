// SPDX-License-Identifier: Apache-2.0
// Data of the elliptic sections of body and water, with their momentum and energy: eq. (37), section 7.2.1.
//
// They come from half-axes a along axis 3, b along axis 2, by the formulae in eel_dynamics/model/section_data.py.
#pragma once

#include "eel_core/algebra/field.hpp"

namespace eel_core {

// One section, or a block of them. SI units, per length of the body.
template <Number T>
struct Section {
    T mass;                          // [kg/m], of the body
    T added2, added3;                // [kg/m], of the water along axes 2 and 3
    T inertia1, inertia2, inertia3;  // [kg m], of body and water
    T added_roll;                    // [kg m], of the water about axis 1
    static constexpr std::tuple members{&Section::mass,     &Section::added2,   &Section::added3,    &Section::inertia1,
                                        &Section::inertia2, &Section::inertia3, &Section::added_roll};

    // Momentum of body and water, (M V; J Omega).
    template <Number B>
    Vector3<T> linear_momentum(const Vector3<B>& v) const
    {
        return {mass * v.x, (mass + added2) * v.y, (mass + added3) * v.z};
    }
    template <Number B>
    Vector2<T> linear_momentum(const Vector2<B>& v) const
    {
        return {mass * v.x, (mass + added2) * v.y};
    }
    template <Number B>
    Vector3<T> angular_momentum(const Vector3<B>& omega) const
    {
        return {inertia1 * omega.x, inertia2 * omega.y, inertia3 * omega.z};
    }
    T angular_momentum(T omega3) const { return inertia3 * omega3; }

    // Momentum of the water alone, (M_f V; J_f1 Omega1 E1).
    Vector3<T> water_momentum(const Vector3<T>& v) const { return {T(0.0), added2 * v.y, added3 * v.z}; }
    Vector2<T> water_momentum(const Vector2<T>& v) const { return {T(0.0), added2 * v.y}; }
    Vector3<T> water_roll(const Vector3<T>& omega) const { return {added_roll * omega.x, T(0.0), T(0.0)}; }
    T water_roll(T) const { return T(0.0); }

    // T_f, the kinetic energy of the water [J/m].
    T water_energy(const auto& v, const auto& omega) const
    {
        return 0.5 * (dot(v, water_momentum(v)) + dot(omega, water_roll(omega)));
    }

    // Kinetic energy of the body alone [J/m].
    T body_energy(const Vector3<T>& v, const Vector3<T>& omega) const
    {
        return 0.5 * (mass * dot(v, v) + (inertia1 - added_roll) * omega.x * omega.x + inertia2 * omega.y * omega.y +
                      inertia3 * omega.z * omega.z);
    }

    // Mass M along the axes of the head, and inertia J about them: M = m + m2 t2 t2^T + m3 t3 t3^T, J likewise.
    Symmetric3<T> mass_matrix(const Frame3<T>& frame) const { return matrix(frame, mass, added2, added3); }
    Symmetric2<T> mass_matrix(const Frame2<T>& frame) const
    {
        const T c = frame.cosine, s = frame.sine;
        return {mass + added2 * s * s, -(added2 * s * c), mass + added2 * c * c};
    }
    Symmetric3<T> inertia_matrix(const Frame3<T>& frame) const
    {
        return matrix(frame, inertia1, inertia2 - inertia1, inertia3 - inertia1);
    }
    T inertia_matrix(const Frame2<T>&) const { return inertia3; }

    // All fields times a weight [m].
    Section weighed(T weight) const
    {
        return {weight * mass,     weight * added2,   weight * added3,    weight * inertia1,
                weight * inertia2, weight * inertia3, weight * added_roll};
    }

  private:
    static Symmetric3<T> matrix(const Frame3<T>& frame, T all, T more2, T more3)
    {
        const Vector3<T>&b = frame.axis2, &c = frame.axis3;
        const Vector3<T> f = more2 * b, g = more3 * c;
        return {all + f.x * b.x + g.x * c.x, f.x * b.y + g.x * c.y, f.x * b.z + g.x * c.z,
                all + f.y * b.y + g.y * c.y, f.y * b.z + g.y * c.z, all + f.z * b.z + g.z * c.z};
    }
};

// Resistive coefficients of a section: n = -1/2 rho_f (k1 V1|V1| + k5 |V| V1, k2 V2|V2|, k3 V3|V3|), c1 = -1/2 rho_f k4
// Omega1|Omega1|.
template <Number T>
struct DragSection {
    T drag2, drag3;        // [kg/m^2], 1/2 rho_f k2 and k3
    T drag_roll;           // [kg], 1/2 rho_f k4
    T laminar, turbulent;  // friction per V1: laminar |V1|^(1/2), turbulent (Re / 8e4)^(4/5), or Taylor's, |Vn|^(1/2)
    T by_critical_speed;   // [s/m], Re / 8e4 per |V1|
    T segment;             // [kg/m^2], 1/2 rho_f k5, of a robot's links
    static constexpr std::tuple members{&DragSection::drag2,   &DragSection::drag3,     &DragSection::drag_roll,
                                        &DragSection::laminar, &DragSection::turbulent, &DragSection::by_critical_speed,
                                        &DragSection::segment};
};

// The sections at the nodes, or at the stations.
struct Sections {
    Field<Section<double>> inertial;
    Row lever;      // [kg], m h of the weight; see weight.hpp
    Row net;        // [kg/m], mass of displaced water minus body, if bodies have weight
    Row displaced;  // [kg/m], of the water that the section displaces
    Field<DragSection<double>> resistance;

    Section<Lanes> operator[](std::size_t k) const { return inertial[k]; }
    DragSection<Lanes> drag(std::size_t k) const { return resistance[k]; }
};

}  // namespace eel_core
