// SPDX-License-Identifier: Apache-2.0
// The laws of the axial friction c_f(Re), section 7.2.1.
//
// A new law is an entry of `Friction` and of `friction_laws` (swimmer_from.hpp), and a case of `axial_friction`;
// `Scene.friction` takes its name. Its coefficients come from `sections_of` in eel_dynamics/model/section_data.py. One
// that is not analytic along the body is named in `ROUGH_FRICTION` (eel_dynamics/model/scene.py), which demands more
// points. One that is no sum of a laminar and a turbulent part, as `taylor`, has a case in `set_drag_units`
// (march/missed.hpp) too.
//
// `taylor`: flow across a cylinder keeps its boundary layer thin, so the friction along it is
// 1/2 rho_f 5.4 (nu d)^(1/2) V1 |Vn|^(1/2), with the diameter d and the speed Vn across (Taylor, Proc. R. Soc. A 214
// (1952), doi:10.1098/rspa.1952.0159). For straight motion the laminar plate's friction remains: the squares add up.
#pragma once

#include "eel_core/model/section.hpp"

namespace eel_core {

enum class Friction : std::size_t { printed, laminar, blended, taylor };

// Whether the friction jumps at the critical Re, 8e4. The place of the jump is then integrated exactly (`find_kinks`).
inline bool jumps(Friction law) { return law == Friction::printed; }

// Axial friction of sections, per length and V1 [kg/m/s].
struct AxialFriction {
    Lanes laminar;          // from the laminar law
    Lanes excess;           // the turbulent law's excess
    Lanes turbulent_share;  // share of the excess, 0 to 1
    Lanes above_critical;   // Re / 8e4 - 1
};

// Share of the turbulent law for ratio = Re / 8e4: the ramp f_r of eq. (64) in ln Re, from Re = 4e4 to 1.6e5. Our own,
// not in the paper.
inline double turbulent_share(double ratio)
{
    if (ratio <= 0.5) return 0.0;
    if (ratio >= 2.0) return 1.0;
    return smooth_ramp(std::log(2.0 * ratio) / std::log(4.0));
}

// Speed across the section.
inline Lanes speed_across(const Vector2<Lanes>& v) { return abs(v.y); }
inline Lanes speed_across(const Vector3<Lanes>& v) { return sqrt(v.y * v.y + v.z * v.z); }

// From the velocity v of the section through the water, in its axes.
inline AxialFriction axial_friction(const DragSection<Lanes>& section, Friction law, const auto& v)
{
    const Lanes speed = abs(v.x);
    if (law == Friction::taylor) {
        const Lanes straight = section.laminar * section.laminar * speed;
        return {sqrt(straight + section.turbulent * section.turbulent * speed_across(v)), 0.0, 0.0, -1.0};
    }
    const Lanes laminar = section.laminar * sqrt(speed);
    if (law == Friction::laminar) return {laminar, 0.0, 0.0, -1.0};
    const Lanes ratio = speed * section.by_critical_speed;
    const Lanes turbulent = section.turbulent * ratio * inverse_fifth_root(ratio + 1e-30);
    Lanes share = select(ratio > Lanes(1.0), 1.0, 0.0);
    if (law == Friction::blended) share = lane_by_lane(ratio, turbulent_share);
    return {laminar, turbulent - laminar, share, ratio - 1.0};
}

}  // namespace eel_core
