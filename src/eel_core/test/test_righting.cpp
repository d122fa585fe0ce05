// SPDX-License-Identifier: Apache-2.0
// The righting torque is what the potential energy loses as the body turns, and what the balance takes out again.
#include <gtest/gtest.h>

#include "eel_core/algebra/rotation.hpp"
#include "eel_core/righting.hpp"

using namespace eel_core;

namespace {

constexpr std::size_t nodes = 11;  // not a multiple of the lanes

Swimmer swimmer()
{
    Swimmer swimmer;
    swimmer.grid.nodes = nodes, swimmer.grid.blocks = blocks_of(nodes), swimmer.grid.widest = nodes;
    swimmer.grid.weight = swimmer.sections.mass = Row(swimmer.grid.blocks);
    for (std::size_t i = 0; i < nodes; ++i) {
        swimmer.grid.weight.row(0)[i] = 0.1 + 0.01 * static_cast<double>(i);
        swimmer.sections.mass.row(0)[i] = 2.0 - 0.1 * static_cast<double>(i);
    }
    swimmer.righting = 0.3;
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
    }
    return work;
}

double energy(const Swimmer& swimmer, const Frame3<double>& head, Workspace<Space>& work)
{
    work.head = head;
    set_righting_torque(swimmer, work);
    return potential_energy(swimmer, work);
}

}  // namespace

TEST(Righting, TorqueIsMinusTheSlopeOfThePotentialEnergy)
{
    const Swimmer body = swimmer();
    Workspace<Space> work = bent(body);
    const Quaternion<double> head = turn(0.3, 0.5, -0.2);
    const double step = 1e-5;
    std::array<double, 3> slope{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto moved = [&](double half) {
            const std::array<double, 3> by{axis == 0 ? half : 0.0, axis == 1 ? half : 0.0, axis == 2 ? half : 0.0};
            return energy(body, (head * turn(by[0], by[1], by[2])).frame(), work);
        };
        slope[axis] = (moved(0.5 * step) - moved(-0.5 * step)) / (2.0 * step);
    }
    energy(body, head.frame(), work);
    const auto torque = components_of(work.righting);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(torque[axis], -slope[axis], 1e-9) << axis;
    EXPECT_GT(potential_energy(body, work), 0.0);
}

TEST(Righting, UprightBodyHasNeitherTorqueNorEnergy)
{
    const Swimmer body = swimmer();
    Workspace<Space> work(body);
    for (std::size_t i = 0; i < nodes; ++i) work.frame.row(0)[i] = work.frame.row(4)[i] = work.frame.row(8)[i] = 1.0;
    EXPECT_EQ(energy(body, turn(0.0, 0.0, 0.7).frame(), work), 0.0);
    for (const double torque : components_of(work.righting)) EXPECT_EQ(torque, 0.0);
}

TEST(Righting, BalanceLosesTheTorqueAndItsDensityAsMuch)
{
    const Swimmer body = swimmer();
    Workspace<Space> work = bent(body);
    energy(body, turn(0.3, 0.5, -0.2).frame(), work);
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
    take_righting_torque(body, work);
    const auto integral_after = integral(), balance_after = components_of(work.balance);
    const auto torque = components_of(work.righting);
    for (std::size_t c = 0; c < 6; ++c) {
        const double taken = c < 3 ? torque[c] : 0.0;
        EXPECT_NEAR(balance_before[c] - balance_after[c], taken, 1e-14) << c;
        EXPECT_NEAR(integral_before[c] - integral_after[c], taken, 1e-14) << c;
    }
    EXPECT_GT(std::abs(torque[0]), 0.1);
}
