// SPDX-License-Identifier: Apache-2.0
// Drag of the water along the body, section 7.2.1:
//
//     n = -1/2 rho_f (k1 V1|V1| + k5 |V| V1, k2 V2|V2|, k3 V3|V3|)        c1 = -1/2 rho_f k4 Omega1|Omega1|
//
// k1 is a friction law: model/friction.hpp. k5 is the drag of a robot's links, each a blunt body in oblique flow; ours,
// not the paper's. |V| V1 has no kink where one component of V changes its sign, so it is added to the laminar part
// of the friction. Another law of cross flow (k2, k3) or of roll (k4) is a change of
// `resistive_load` here, of its kinks (drag_kinks.hpp), and of `sections_of` in
// eel_dynamics/model/section_data.py. Where a speed changes its sign within a panel, the load has a kink there;
// `drag_kinks` integrates it exactly. The nose's drag stands in tail_and_nose.hpp, that of fins in fins.hpp;
// march/missed.hpp knows the coefficient of each part of the drag.
#pragma once

#include "eel_core/model/workspace.hpp"

namespace eel_core {

// Friction of sections with the drag of their links, by their velocity v through the water, in their axes.
inline AxialFriction axial_drag(const Swimmer& swimmer, const DragSection<Lanes>& section, const auto& v)
{
    AxialFriction friction = axial_friction(section, swimmer.friction, v);
    if (swimmer.segmented) friction.laminar += section.segment * sqrt(dot(v, v));
    return friction;
}

// Signs (+-1), or signs times quadrature weights [m].
template <Number T>
struct LoadSigns {
    T laminar;  // 1: the friction by the laminar law, and the drag of the links, always oppose V1
    T excess;   // part of the turbulent law in the friction
    T lateral, vertical, roll;

    // The sign of the load that changes with the sign of a speed.
    T& of(Speed speed)
    {
        if (speed == Speed::lateral) return lateral;
        if (speed == Speed::vertical) return vertical;
        return speed == Speed::roll ? roll : excess;
    }
};

// THE resistive load, in section axes: per length, or integrated if the signs are multiplied by quadrature weights.
EEL_CORE_INLINE inline Wrench<Space, Lanes> resistive_load(const DragSection<Lanes>& section, Lanes laminar,
                                                           Lanes excess, const LoadSigns<Lanes>& sign,
                                                           const Vector3<Lanes>& v, Lanes roll)
{
    return {{-(sign.roll * section.drag_roll * roll * roll), 0.0, 0.0},
            {-((sign.laminar * laminar + sign.excess * excess) * v.x), -(sign.lateral * section.drag2 * v.y * v.y),
             -(sign.vertical * section.drag3 * v.z * v.z)}};
}
inline Wrench<Plane, Lanes> resistive_load(const DragSection<Lanes>& section, Lanes laminar, Lanes excess,
                                           const LoadSigns<Lanes>& sign, const Vector2<Lanes>& v, Lanes)
{
    return {0.0,
            {-((sign.laminar * laminar + sign.excess * excess) * v.x), -(sign.lateral * section.drag2 * v.y * v.y)}};
}

// Speeds of the sections from a node on, found by `set_speeds`.
inline Vector3<Lanes> speeds_from(const Workspace<Space>& work, std::size_t node)
{
    return {work.speed[axial].from(node), work.speed[lateral].from(node), work.speed[vertical].from(node)};
}
inline Vector2<Lanes> speeds_from(const Workspace<Plane>& work, std::size_t node)
{
    return {work.speed[axial].from(node), work.speed[lateral].from(node)};
}

inline Lanes roll_from(const Workspace<Space>& work, std::size_t node) { return work.speed[roll].from(node); }
inline Lanes roll_from(const Workspace<Plane>&, std::size_t) { return 0.0; }

// The signs of the speeds at a node; `share`: of turbulence.
template <class M>
LoadSigns<Lanes> local_signs(Lanes share, const Vector<M, Lanes>& v, Lanes roll)
{
    LoadSigns<Lanes> sign{1.0, share, with_sign_of(1.0, v.y), 0.0, with_sign_of(1.0, roll)};
    if constexpr (!M::planar) sign.vertical = with_sign_of(1.0, v.z);
    return sign;
}

// V and Omega1 of the sections through the water, from their true velocities.
template <class M>
void set_speeds(const Swimmer& swimmer, Workspace<M>& work)
{
    const auto& through_water = work.velocity_through_water();
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto frame = work.frame[k];
        const auto v = frame.local(through_water[k]);
        work.speed[axial].store(k, v.x);
        work.speed[lateral].store(k, v.y);
        if constexpr (!M::planar) {
            work.speed[vertical].store(k, v.z);
            Lanes turning = dot(frame.axis1, work.omega[k]);
            if (work.flowing) turning -= 0.5 * work.flow[k].g.curl_along(frame.axis1);
            work.speed[roll].store(k, turning);
        }
    }
}

// Friction of the nodes, and integration weights with the signs of the loads, as if no sign changed within a panel.
template <class M>
void set_load_weights(const Swimmer& swimmer, Workspace<M>& work)
{
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const Lanes weight = swimmer.grid.weight[k];
        const AxialFriction friction = axial_drag(swimmer, swimmer.sections.drag(k), speeds_from(work, width * k));
        work.friction_laminar.store(k, friction.laminar);
        work.friction_excess.store(k, friction.excess);
        work.turbulent_share.store(k, friction.turbulent_share);
        work.speed[above_critical].store(k, friction.above_critical);
        work.turbulent_weight.store(k, weight * friction.turbulent_share);
        for (const Speed speed : {lateral, vertical, roll})
            if (!M::planar || speed == lateral)
                work.load_weight[speed].store(k, with_sign_of(weight, work.speed[speed][k]));
    }
}

inline Lanes roll_torque(const Wrench<Space, Lanes>& load) { return load.angular.x; }
inline Lanes roll_torque(const Wrench<Plane, Lanes>&) { return 0.0; }

// The load of a block in section axes, integrated over the length by the weights with their signs.
template <class M>
EEL_CORE_INLINE inline Wrench<M, Lanes> weighed_load(const Swimmer& swimmer, const Workspace<M>& work, std::size_t k)
{
    LoadSigns<Lanes> sign{swimmer.grid.weight[k], work.turbulent_weight[k], work.load_weight[lateral][k], 0.0, 0.0};
    if constexpr (!M::planar) sign.vertical = work.load_weight[vertical][k], sign.roll = work.load_weight[roll][k];
    return resistive_load(swimmer.sections.drag(k), work.friction_laminar[k], work.friction_excess[k], sign,
                          speeds_from(work, width * k), roll_from(work, width * k));
}

// Wrench of the drag along the body about the head, and its power, by the weights.
template <class M>
void integrate_resistive_load(const Swimmer& swimmer, Workspace<M>& work)
{
    Wrench<M, Lanes> wrench{};
    Lanes power(0.0);
    for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
        const auto load = weighed_load(swimmer, work, k);
        power += dot(load.linear, speeds_from(work, width * k)) + roll_torque(load) * roll_from(work, width * k);
        wrench += about_head<M>(work.frame[k], work.position[k], load);
    }
    work.drag = total_of(wrench);
    work.drag_power = total(power);
}

}  // namespace eel_core
