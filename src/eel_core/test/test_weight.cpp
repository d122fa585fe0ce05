// SPDX-License-Identifier: Apache-2.0
// The weight is what the potential energy loses as the body moves, and what the balance takes out again; the momentum
// of a centre of mass off the axis is the slope of the kinetic energy.
#include <gtest/gtest.h>

#include "eel_core/algebra/rotation.hpp"
#include "eel_core/march/observe.hpp"

using namespace eel_core;

namespace {

constexpr std::size_t nodes = 11;  // not a multiple of the lanes

Swimmer swimmer()
{
    Swimmer swimmer;
    swimmer.grid.nodes = nodes, swimmer.grid.blocks = blocks_of(nodes), swimmer.grid.widest = nodes;
    Sections& sections = swimmer.sections;
    sections.inertial = Field<Section<double>>(swimmer.grid.blocks);
    sections.lever = sections.net = swimmer.grid.weight = Row(swimmer.grid.blocks);
    for (std::size_t i = 0; i < nodes; ++i) {
        const double s = static_cast<double>(i);
        swimmer.grid.weight.row(0)[i] = 0.1 + 0.01 * s;
        sections.inertial.row(0)[i] = 2.0 - 0.1 * s;  // mass
        sections.lever.row(0)[i] = 0.02 - 0.003 * s;
        sections.net.row(0)[i] = 0.1 * s - 0.3;
        for (const std::size_t moment : {3u, 4u, 5u}) sections.inertial.row(moment)[i] = 0.01 + 0.002 * s;
    }
    swimmer.righting = swimmer.gravity = 9.8;
    swimmer.offset = true;
    return swimmer;
}

Quaternion<double> turn(double x, double y, double z)
{
    const double length = std::sqrt(1.0 + x * x + y * y + z * z);
    return {x / length, y / length, z / length, 1.0 / length};
}

// A body whose sections lean every which way, the more so the further back.
Workspace<Space> bent(const Swimmer& swimmer)
{
    Workspace<Space> work(swimmer);
    for (std::size_t i = 0; i < nodes; ++i) {
        const double s = static_cast<double>(i) / nodes;
        const Frame3<double> frame = turn(0.7 * s, -0.4 * s * s, 0.9 * s).frame();
        Components<Frame3<double>>::each(frame, [&](std::size_t c, double value) { work.frame.row(c)[i] = value; });
        const std::array<double, 3> r{s, 0.2 * s * s, -0.3 * s * s}, turn{0.4 * s, s, -2.0 * s}, move{-s, s * s, 0.5};
        for (std::size_t c = 0; c < 3; ++c) {
            work.position.row(c)[i] = r[c];
            work.shape_omega.row(c)[i] = turn[c], work.shape_velocity.row(c)[i] = move[c];
        }
    }
    return work;
}

double energy(const Swimmer& swimmer, const Frame3<double>& head, double height, Workspace<Space>& work)
{
    work.head = head;
    set_weight(swimmer, height, work);
    return potential_energy(swimmer, work);
}

double kinetic(const Swimmer& swimmer, const std::array<double, 6>& twist, Workspace<Space>& work)
{
    const Vector3 turn{twist[0], twist[1], twist[2]}, move{twist[3], twist[4], twist[5]};
    set_velocities(swimmer, {turn, move}, work);
    return energies_of(swimmer, work)[0];
}

}  // namespace

TEST(Weight, TorqueIsMinusTheSlopeOfThePotentialEnergy)
{
    const Swimmer body = swimmer();
    Workspace<Space> work = bent(body);
    const Quaternion<double> head = turn(0.3, 0.5, -0.2);
    const double step = 1e-5;
    std::array<double, 3> slope{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto moved = [&](double half) {
            const std::array<double, 3> by{axis == 0 ? half : 0.0, axis == 1 ? half : 0.0, axis == 2 ? half : 0.0};
            return energy(body, (head * turn(by[0], by[1], by[2])).frame(), 0.4, work);
        };
        slope[axis] = (moved(0.5 * step) - moved(-0.5 * step)) / (2.0 * step);
    }
    const double raised = energy(body, head.frame(), 1.4, work) - energy(body, head.frame(), 0.4, work);
    const auto torque = components_of(work.weight.angular);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(torque[axis], -slope[axis], 1e-9) << axis;
    EXPECT_NEAR(head.frame().parent(work.weight.linear).z, -raised, 1e-12);
}

TEST(Weight, UprightBodyHasNeitherTorqueNorEnergy)
{
    Swimmer body = swimmer();
    body.gravity = 0.0;
    Workspace<Space> work(body);
    for (std::size_t i = 0; i < nodes; ++i) work.frame.row(0)[i] = work.frame.row(4)[i] = work.frame.row(8)[i] = 1.0;
    EXPECT_EQ(energy(body, turn(0.0, 0.0, 0.7).frame(), 0.4, work), 0.0);
    for (const double part : components_of(work.weight)) EXPECT_EQ(part, 0.0);
}

TEST(Weight, BalanceLosesItAndItsDensityAsMuch)
{
    const Swimmer body = swimmer();
    Workspace<Space> work = bent(body);
    energy(body, turn(0.3, 0.5, -0.2).frame(), 0.4, work);
    work.balance = {{1.0, -2.0, 3.0}, {-4.0, 5.0, -6.0}};
    for (std::size_t k = 0; k < body.grid.blocks; ++k) {
        const Lanes some(0.7 + static_cast<double>(k));
        work.density.store(k, Wrench<Space, Lanes>{{some, some, some}, {some, some, some}});
    }
    const auto integral = [&] {
        Wrench<Space, Lanes> sum{};
        for (std::size_t k = 0; k < body.grid.blocks; ++k) sum += body.grid.weight[k] * work.density[k];
        return components_of(total_of(sum));
    };
    const auto integral_before = integral(), balance_before = components_of(work.balance);
    take_weight(body, work);
    const auto integral_after = integral(), balance_after = components_of(work.balance);
    const auto weight = components_of(work.weight);
    for (std::size_t c = 0; c < 6; ++c) {
        EXPECT_NEAR(balance_before[c] - balance_after[c], weight[c], 1e-14) << c;
        EXPECT_NEAR(integral_before[c] - integral_after[c], weight[c], 1e-14) << c;
        EXPECT_GT(std::abs(weight[c]), 1e-3) << c;
    }
}

TEST(Weight, MomentumIsTheSlopeOfTheKineticEnergyByTheTwist)
{
    const Swimmer body = swimmer();
    Workspace<Space> work = bent(body);
    std::array<double, 6> twist{0.4, -0.3, 0.7, -0.5, 0.2, 0.1};
    const auto momentum = components_of(
        momentum_of(body, Twist<Space, double>{{twist[0], twist[1], twist[2]}, {twist[3], twist[4], twist[5]}}, work));
    for (std::size_t c = 0; c < 6; ++c) {
        auto more = twist, less = twist;
        more[c] += 0.5, less[c] -= 0.5;  // exact: the energy is quadratic
        EXPECT_NEAR(kinetic(body, more, work) - kinetic(body, less, work), momentum[c], 1e-13) << c;
    }
}
