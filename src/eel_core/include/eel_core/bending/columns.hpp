// SPDX-License-Identifier: Apache-2.0
// Columns of the modes: the motion of the sections per unit rate of a coordinate; and the mass matrix of head and
// coordinates.
//
//     omega_m' = R B_m      v_m' = omega_m x t1
//
// in the axes of the head, zero at the nose and ahead of the support. Behind the support a column is a rigid motion.
// M_ab = integral (omega_a . s_b + v_a . p_b) dX with the momentum (s, p) of a column; plus the fins' added masses
// m_a y_a y_b, y = e_n . (v + omega x x_f), the nose's m_o and the coordinates' armature.
#pragma once

#include "eel_core/algorithm.hpp"
#include "eel_core/bending/modes.hpp"

namespace eel_core {

template <class M>
struct Column {
    std::size_t first_stretch, last_stretch;  // of the support; the latter is the one behind it
    std::size_t first_block, first_node, last_node;
    Field<Angular<M, double>> omega;  // per unit of rate
    Field<Vector<M, double>> velocity;
    Field<Wrench<M, double>> momentum;  // of each section, about it and weighted by its length
};

// Momentum of body and water of a block of sections, each about itself and in the axes of the head, from its angular
// velocity and its velocity. `section` and `lever` may be weighted.
template <class M>
Momentum<M, Lanes> momentum_of_sections(const Swimmer& swimmer, const Section<Lanes>& section, Lanes lever,
                                        const Frame<M, Lanes>& frame, const Angular<M, Lanes>& omega,
                                        const Vector<M, Lanes>& velocity)
{
    Momentum<M, Lanes> sum{frame.parent(section.angular_momentum(frame.local(omega))),
                           frame.parent(section.linear_momentum(frame.local(velocity)))};
    if constexpr (!M::planar)
        if (swimmer.offset) {
            const Vector3<Lanes> moment = mass_moment(lever, frame.axis3);
            sum += {cross(moment, velocity), cross(omega, moment)};
        }
    return sum;
}

template <class M>
class Columns {
  public:
    static constexpr std::size_t head = M::freedoms;

    Columns(const Swimmer& swimmer, const Modes& modes)
        : mass(head + modes.coordinates), momentum(head + modes.coordinates), along_normal_(modes.modes)
    {
        const std::size_t n = swimmer.grid.blocks;
        for (std::size_t m = 0; m < modes.modes; ++m) {
            const std::size_t begin = modes.first[m] / filled, end = (modes.last[m] + filled - 1) / filled;
            column.push_back({begin, end, begin * FromNose::parts, modes.first[m], modes.last[m],
                              Field<Angular<M, double>>(n), Field<Vector<M, double>>(n), Field<Wrench<M, double>>(n)});
        }
    }

    std::vector<Column<M>> column;
    Definite mass;                 // of head and coordinates
    std::vector<double> momentum;  // of only the imposed change of shape, in the direction of each of them
    std::vector<double> at_rest;   // the same minus the water's own motion: with head and coordinates at rest

    // B_m for a block.
    static Lanes shape(const BentSettings& settings, std::size_t m, std::size_t k)
    {
        return settings.law.tables->node.at(settings.first_mode + m, k)[0];
    }

    // Sets all columns for a body configured with the velocities of the imposed change of shape.
    void set(const Swimmer& swimmer, const Modes& modes, const BentSettings& settings, Workspace<M>& work)
    {
        const auto of_shape = components_of(inertia_and_momentum(swimmer, work));
        for (std::size_t i = 0; i < head; ++i) {
            momentum[i] = of_shape[i];
            for (std::size_t j = 0; j <= i; ++j) mass.at(i, j) = work.inertia.lower[work.inertia.at(i, j)];
        }
        for (std::size_t m = 0; m < modes.modes; ++m) {
            set_column(swimmer, modes, settings, m, work);
            set_momentum(swimmer, m, work);
            for (std::size_t other = 0; other <= m; ++other) mass.at(head + m, head + other) = product(m, other);
        }
        for (std::size_t i = modes.modes; i < modes.coordinates; ++i)
            for (std::size_t j = 0; j < head + i; ++j) mass.at(head + i, j) = 0.0;
        for (std::size_t i = 0; i < modes.coordinates; ++i) {
            double& own = mass.at(head + i, head + i);
            own = (i < modes.modes ? own : 0.0) + modes.armature[i];
        }
        if constexpr (!M::planar)
            if (!work.fins.empty()) add_fins(swimmer, work);
        at_rest = momentum;
        if (work.flowing) take_flow(swimmer, work);
    }

    // Sum of a column's fields times these, over blocks: integral (omega_m . c + v_m . n), with (c, n) weighted,
    // about the sections and in the axes of the head.
    double work_of(std::size_t m, const Field<Wrench<M, double>>& load) const
    {
        const Column<M>& own = column[m];
        Lanes sum(0.0);
        for (std::size_t k = own.first_block; k < blocks_; ++k) {
            const Wrench<M, Lanes> here = load[k];
            sum += dot(own.omega[k], here.angular) + dot(own.velocity[k], here.linear);
        }
        return total(sum);
    }
    // A wrench on the section of a `node`, about it, times the column's motion there.
    double work_at(std::size_t node, std::size_t m, const Wrench<M, double>& wrench) const
    {
        return dot(column[m].omega.node(node), wrench.angular) + dot(column[m].velocity.node(node), wrench.linear);
    }

    // Motion of a column at the centre of pressure of a fin.
    Vector3<double> at(const FinMotion& fin, std::size_t node, std::size_t m) const
    {
        return column[m].velocity.node(node) + cross(column[m].omega.node(node), fin.arm);
    }

  private:
    // Added masses of the fins; the head's own part is in its inertia.
    EEL_CORE_APART void add_fins(const Swimmer& swimmer, const Workspace<Space>& work)
    {
        for (std::size_t i = 0; i < swimmer.fins.size(); ++i) {
            const FinMotion& now = work.fins[i];
            const std::size_t node = swimmer.fins[i].node;
            const auto row = components_of(at_fin(now, now.normal));
            const double imposed =
                dot(now.normal, work.shape_velocity.node(node) + cross(work.shape_omega.node(node), now.arm));
            for (std::size_t m = 0; m < column.size(); ++m) {
                along_normal_[m] = dot(now.normal, at(now, node, m));
                const double share = swimmer.fins[i].added_mass * along_normal_[m];
                for (std::size_t j = 0; j < head; ++j) mass.at(head + m, j) += share * row[j];
                for (std::size_t j = 0; j <= m; ++j) mass.at(head + m, head + j) += share * along_normal_[j];
                momentum[head + m] += share * imposed;
            }
        }
    }

    EEL_CORE_APART void take_flow(const Swimmer& swimmer, Workspace<M>& work)
    {
        const auto whole = components_of(momentum_of_flow(swimmer, work));
        for (std::size_t i = 0; i < head; ++i) at_rest[i] -= whole[i];
        for (std::size_t k = 0; k < blocks_; ++k) {
            const auto section = swimmer.sections[k].weighed(swimmer.grid.weight[k]);
            const auto frame = work.frame[k];
            work.integrand.store(k, {{}, frame.parent(section.water_momentum(frame.local(work.flow[k].u)))});
        }
        for (std::size_t m = 0; m < column.size(); ++m) at_rest[head + m] -= work_of(m, work.integrand);
    }

    void set_column(const Swimmer& swimmer, const Modes& modes, const BentSettings& settings, std::size_t m,
                    Workspace<M>& work)
    {
        Column<M>& own = column[m];
        blocks_ = swimmer.grid.blocks;
        const auto stretches = swimmer.grid.from_nose.stretches();
        const std::size_t begin = stretches[own.first_stretch].begin / width,
                          end = (stretches[own.last_stretch - 1].end + width - 1) / width;
        const std::size_t behind = own.last_stretch * FromNose::parts;
        const auto integrate = [&]<class Value>(std::size_t first_row, Field<Value>& result) {
            swimmer.grid.from_nose.integrate(work.integrand, first_row, Value{}, result, result, own.first_stretch,
                                             own.last_stretch);
        };
        if constexpr (M::planar) {
            for (std::size_t k = own.first_block; k < blocks_; ++k)
                own.omega.store(k, settings.law.tables->angle.at(settings.first_mode + m, k)[0]);
        } else {
            for (std::size_t k = begin; k < end; ++k) {
                const auto frame = work.frame[k];
                const Lanes b = shape(settings, m, k);
                const auto turned = modes.axis[m] == LawOnGrid::pitch ? b * frame.axis2 : b * frame.axis3;
                work.integrand.store(k, {turned, Vector<M, Lanes>{}});
            }
            integrate(0, own.omega);
        }
        constexpr std::size_t linear = Components<Angular<M, Lanes>>::count;
        for (std::size_t k = begin; k < end; ++k)
            work.integrand.store(k, {own.omega[k], cross(own.omega[k], work.frame[k].t1())});
        integrate(linear, own.velocity);
        if (behind >= blocks_) return;
        const std::size_t last = behind * width - 1;
        const auto omega = own.omega.node(last);
        const auto at_head = own.velocity.node(last) - cross(omega, work.position.node(last));
        for (std::size_t k = behind; k < blocks_; ++k) {
            if constexpr (!M::planar) own.omega.store(k, omega + Vector<M, Lanes>{});
            own.velocity.store(k, at_head + cross(omega, work.position[k]));
        }
    }

    // The column's momentum, also in the direction of the head's motions and of the imposed change of shape.
    void set_momentum(const Swimmer& swimmer, std::size_t m, const Workspace<M>& work)
    {
        Column<M>& own = column[m];
        Momentum<M, Lanes> whole{};
        Lanes imposed(0.0);
        for (std::size_t k = own.first_block; k < blocks_; ++k) {
            const auto section = swimmer.sections[k].weighed(swimmer.grid.weight[k]);
            const auto frame = work.frame[k];
            const auto [angular, linear] =
                momentum_of_sections<M>(swimmer, section, swimmer.grid.weight[k] * swimmer.sections.lever[k], frame,
                                        own.omega[k], own.velocity[k]);
            own.momentum.store(k, {angular, linear});
            whole += {angular + cross(work.position[k], linear), linear};
            imposed += dot(work.shape_omega[k], angular) + dot(work.shape_velocity[k], linear);
        }
        const auto by_head = components_of(total_of(whole));
        for (std::size_t j = 0; j < head; ++j) mass.at(head + m, j) = by_head[j];
        momentum[head + m] = total(imposed);
    }

    double product(std::size_t m, std::size_t other) const
    {
        const std::size_t later = column[m].first_block >= column[other].first_block ? m : other;
        return work_of(later, column[later == m ? other : m].momentum);
    }

    std::size_t blocks_ = 0;
    std::vector<double> along_normal_;  // y of a fin, for each mode
};

}  // namespace eel_core
