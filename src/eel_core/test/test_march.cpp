// SPDX-License-Identifier: Apache-2.0
// A march of a body with one mode: its copies, a change of the grid, and the plane against space.
#include <gtest/gtest.h>

#include "eel_core/march/march.hpp"
#include "straight_body.hpp"

using namespace eel_core;

namespace {

std::shared_ptr<const Modes> bend_with_spring()
{
    auto modes = std::make_shared<Modes>();
    modes->modes = modes->coordinates = 1;
    modes->axis = {LawOnGrid::yaw}, modes->first = {0}, modes->last = {panel_nodes}, modes->continuous = {true};
    modes->span = modes->moment = {1.0};
    modes->armature = {0.01}, modes->rest = {0.2}, modes->stiffness = {2.0}, modes->damping = {0.1};
    modes->servos.push_back({0, 1.0, 0.1, 5.0, 20.0});
    return modes;
}

// With a bend of 0.5 rad/m at rest.
March begun(bool planar)
{
    const auto swimmer = straight_body();
    const auto tables = std::make_shared<LawTables>(std::vector<std::size_t>{1}, panel_nodes, swimmer->stations);
    tables->set(0, constant_curvature(1.0).data());
    March march(swimmer, Method{}, planar, bend_with_spring());
    march.follow({{{tables, 0.0, {}, {}, {}, {}, {}}, {}, {1e-6, 0.1, 1e-11, 1.0, 0.01, 1.0, 1e5, 1e5, 1e-3}, true, {}},
                  0,
                  {},
                  {}},
                 false);
    EXPECT_NEAR(march.start({}, {0.0, 0.0, 0.0, 1.0}, {}, {0.5}, {0.0}), 0.5 * 2.0 * 0.3 * 0.3, 1e-12);
    return march;
}

}  // namespace

TEST(March, CopyGoesOnToTheSameBits)
{
    March march = begun(false);
    EXPECT_EQ(march.advance(0.1), Status::marched);
    March copy = march;
    march.advance(0.4), copy.advance(0.4);
    EXPECT_EQ(march.now().x, copy.now().x);
    EXPECT_EQ(march.now().state, copy.now().state);
    EXPECT_NE(march.now().x[0], 0.5);
}

TEST(March, BendsInThePlaneAsInSpace)
{
    March space = begun(false), plane = begun(true);
    space.advance(0.5), plane.advance(0.5);
    EXPECT_NEAR(space.now().x[0], plane.now().x[0], 1e-9);
    EXPECT_NEAR(space.now().rate[0], plane.now().rate[0], 1e-9);
}

TEST(March, CommandedServoTurnsTheModeAgainstItsSpring)
{
    March march = begun(true);
    march.set_slice(1'000'000'000'000);
    march.command(0, {Command::position, 1.0});
    EXPECT_EQ(march.advance(30.0), Status::marched);
    EXPECT_NEAR(march.now().x[0], (2.0 * 0.2 + 1.0 * 1.0) / 3.0, 1e-3);  // stiffness and gain share
}
