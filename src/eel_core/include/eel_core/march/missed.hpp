// SPDX-License-Identifier: Apache-2.0
// Correction of the balance's integral up to the stations, for sections that are smooth only between a body's data.
//
// The wrench of a section is a sum of its numbers (`SectionPart`), each times its wrench per unit in the
// motion. These unit wrenches are as smooth as the motion. So their values at the nodes, with the rows of
// `Swimmer::missed`, give the correction of each number's part.
#pragma once

#include "eel_core/internal_wrench.hpp"

namespace eel_core {

class MissedWrench {
    using Part = SectionPart;

  public:
    explicit MissedWrench(const Swimmer& swimmer)
    {
        if (swimmer.missed.empty()) return;
        for (auto& field : unit_) field = Field<Wrench<Space, double>>(swimmer.grid.blocks);
        for (Row& row : factor_) row = Row(blocks_of(swimmer.stations));
    }

    // Adds it to `integral`. The drag has the signs of the speeds at each station, as if none changed within its panel.
    // omega, velocity: of the stations, the latter through the water; flow: there, where the water moves by itself.
    void add(const Swimmer& swimmer, const Workspace<Space>& work, const Field<Frame3<double>>& frame,
             const Field<Vector3<double>>& omega, const Field<Vector3<double>>& velocity, const FlowValues<Space>& flow,
             Field<Wrench<Space, double>>& integral)
    {
        set_inertial_units(swimmer, work);
        if (swimmer.resistive) set_drag_units(swimmer, work);
        set_factors(swimmer, frame, omega, velocity);
        if (work.flowing) add_flow(swimmer, work, frame, omega, flow);
        const std::size_t used = swimmer.resistive ? Part::count : Part::drag2;
        for (std::size_t part = 0; part < used; ++part)
            if ((part == Part::displaced && !work.flowing) || (part == Part::net && swimmer.gravity == 0.0) ||
                (part == Part::lever && swimmer.righting == 0.0 && !swimmer.offset) ||
                (part == Part::segment && !swimmer.segmented))
                continue;
            else if ((Part::inertia1 <= part && part < Part::displaced) || part == Part::drag_roll)  // without a force
                swimmer.missed[part].add<Vector3<double>>(unit_[part], factor_[part], integral);
            else
                swimmer.missed[part].add<Wrench<Space, double>>(unit_[part], factor_[part], integral);
    }

  private:
    void set_inertial_units(const Swimmer& swimmer, const Workspace<Space>& work)
    {
        for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
            const auto of = [&](const Section<Lanes>& one) {
                return inertial_wrench<Space>(one, work, work.acceleration, k);
            };
            unit_[Part::mass].store(k, of({1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
            unit_[Part::added2].store(k, of({0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
            unit_[Part::added3].store(k, of({0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0}));
            unit_[Part::inertia1].store(k, of({0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}));
            unit_[Part::inertia2].store(k, of({0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0}));
            unit_[Part::inertia3].store(k, of({0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0}));
            if (!swimmer.weighs() && !swimmer.offset) continue;
            Wrench<Space, Lanes> hanging{};
            if (swimmer.offset) hanging = wrench_of_offset(Lanes(1.0), work, work.acceleration, k);
            hanging.angular = hanging.angular - righting_torque(Lanes(swimmer.righting), work.frame[k].axis3, work.up);
            unit_[Part::lever].store(k, hanging);
            unit_[Part::net].store(k, -net_weight(swimmer, work.up, work.position[k], Lanes(1.0)));
        }
    }

    void set_drag_units(const Swimmer& swimmer, const Workspace<Space>& work)
    {
        for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
            const DragSection<Lanes> rough{0.0, 0.0, 0.0, 1.0, 1.0, swimmer.sections.drag(k).by_critical_speed, 0.0};
            const auto v = speeds_from(work, width * k);
            const AxialFriction friction = axial_friction(rough, swimmer.friction, v);
            const Lanes turned = jumps(swimmer.friction) ? Lanes(1.0) : friction.turbulent_share;
            const Lanes kept = jumps(swimmer.friction) ? Lanes(1.0) : 1.0 - friction.turbulent_share;
            const LoadSigns<Lanes> sign{1.0, 0.0, 1.0, 1.0, 1.0};
            const auto store = [&](std::size_t part, const DragSection<Lanes>& one, Lanes friction_of_one) {
                const auto load = resistive_load(one, friction_of_one, 0.0, sign, speeds_from(work, width * k),
                                                 roll_from(work, width * k));
                unit_[part].store(k, -about_head<Space>(work.frame[k], work.position[k], load));
            };
            store(Part::drag2, {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0);
            store(Part::drag3, {0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0);
            store(Part::drag_roll, {0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0}, 0.0);
            if (swimmer.segmented) store(Part::segment, {}, sqrt(dot(v, v)));
            if (swimmer.friction == Friction::taylor) {  // a root of a sum of squares: derivatives with respect to both
                const DragSection<Lanes> own = swimmer.sections.drag(k);
                const Lanes all = axial_friction(own, swimmer.friction, v).laminar + 1e-300;
                store(Part::laminar, {}, own.laminar * abs(v.x) / all);
                store(Part::turbulent, {}, own.turbulent * speed_across(v) / all);
                continue;
            }
            store(Part::laminar, {}, kept * friction.laminar);
            store(Part::turbulent, {}, turned * (friction.excess + friction.laminar));
        }
    }

    EEL_CORE_APART void add_flow(const Swimmer& swimmer, const Workspace<Space>& work,
                                 const Field<Frame3<double>>& frame, const Field<Vector3<double>>& omega,
                                 const FlowValues<Space>& flow)
    {
        for (std::size_t k = 0; k < swimmer.grid.blocks; ++k) {
            const auto of_flow = [&](const Section<Lanes>& one, Lanes displaced) {
                const auto wrench = wrench_of_flow<Space>(one, displaced, work, k);
                return swimmer.flow_gradient ? wrench : wrench + load_of_gradient<Space>(one, displaced, work, k);
            };
            const auto added2 = unit_[Part::added2][k], added3 = unit_[Part::added3][k];
            unit_[Part::added2].store(k, added2 + of_flow({0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0));
            unit_[Part::added3].store(k, added3 + of_flow({0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0}, 0.0));
            unit_[Part::displaced].store(k, of_flow({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 1.0));
        }
        for (std::size_t k = 0; k < blocks_of(swimmer.stations); ++k) {
            const Vector3<Lanes> axis = frame[k].axis1;
            const Lanes turning = dot(axis, omega[k]) - 0.5 * flow[k].g.curl_along(axis);
            factor_[Part::drag_roll].store(k, with_sign_of(1.0, turning));
        }
    }

    void set_factors(const Swimmer& swimmer, const Field<Frame3<double>>& frame, const Field<Vector3<double>>& omega,
                     const Field<Vector3<double>>& velocity)
    {
        for (std::size_t k = 0; k < blocks_of(swimmer.stations); ++k) {
            const Frame3<Lanes> there = frame[k];
            const Vector3<Lanes> v = there.local(velocity[k]);
            const Lanes share = axial_friction(swimmer.at_station.drag(k), swimmer.friction, v).turbulent_share;
            for (std::size_t part = 0; part < Part::drag2; ++part) factor_[part].store(k, 1.0);
            factor_[Part::segment].store(k, 1.0);
            factor_[Part::drag2].store(k, with_sign_of(1.0, v.y));
            factor_[Part::drag3].store(k, with_sign_of(1.0, v.z));
            factor_[Part::drag_roll].store(k, with_sign_of(1.0, dot(there.axis1, omega[k])));
            factor_[Part::laminar].store(k, jumps(swimmer.friction) ? 1.0 - share : Lanes(1.0));
            factor_[Part::turbulent].store(k, jumps(swimmer.friction) ? share : Lanes(1.0));
        }
    }

    std::array<Field<Wrench<Space, double>>, Part::count> unit_;  // at the nodes, per length
    std::array<Row, Part::count> factor_;                         // at the stations
};

}  // namespace eel_core
