// SPDX-License-Identifier: Apache-2.0
// Motion, accelerations and internal wrench of bodies whose answers are known in closed form.
#include <gtest/gtest.h>

#include "reference_table.hpp"
#include "straight_body.hpp"

using namespace eel_core;

namespace {

// State of the straight or bent body with a twist of the head, which lies at the origin along the world's axes.
template <class M>
State state_with(const Swimmer& swimmer, const LawOnGrid& law, double time, const Twist<M, double>& twist,
                 Workspace<M>& work)
{
    State y{};
    y[6] = 1.0;
    configure(swimmer, law, time, work);
    put_momentum(momentum_of(swimmer, twist, work), head_frame(y, M()), y);
    return y;
}

double place(const Swimmer& swimmer, std::size_t i) { return swimmer.grid.fraction.node(i); }

template <class M>
Wrench<M, double> wrench_at(const Swimmer& swimmer, const Workspace<M>& work, std::size_t node)
{
    Field<Wrench<M, double>> integral(swimmer.grid.blocks), wrench(swimmer.grid.blocks);
    swimmer.grid.from_nose.integrate(work.density, integral);
    const std::size_t k = node / width;
    wrench.store(k, wrench_behind<M>(work, integral[k], work.frame[k], work.position[k]));
    return wrench.node(node);
}

constexpr double v1 = -0.4, v2 = 0.3, v3 = -0.25;

}  // namespace

TEST(Algorithm, ArcHasThePlaceAndVelocityOfACircle)
{
    const auto swimmer = straight_body();
    const double bend = 1.5, time = 0.6;
    const LawOnGrid law = arc(bend);
    Jet jet{};
    Ramp{0.0, 1.0, bend}.add_to(jet, time);
    const auto check = [&](auto& work) {
        configure(*swimmer, law, time, work);
        for (std::size_t i = 0; i < panel_nodes; ++i) {
            const double x = place(*swimmer, i), k = jet[0], angle = k * x;
            EXPECT_NEAR(work.position.node(i).x, std::sin(angle) / k, 1e-9);
            EXPECT_NEAR(work.position.node(i).y, (1.0 - std::cos(angle)) / k, 1e-9);
            const double by_k = (x * std::cos(angle) - std::sin(angle) / k) / k;  // of sin(k x) / k
            EXPECT_NEAR(work.shape_velocity.node(i).x, jet[1] * by_k, 1e-8);
        }
    };
    Workspace<Space> space(*swimmer);
    Workspace<Plane> plane(*swimmer);
    check(space), check(plane);
}

// The wake's force at the tail, mu V1 V2, turns and pushes the body; of a body of constant sections Munk's moment and
// the wake's balance: model as in a rigid beam.
TEST(Algorithm, RigidStraightBodyHasTheAccelerationsAndTheShearOfABeam)
{
    const auto swimmer = straight_body();
    const LawOnGrid law = arc(0.0);
    Workspace<Plane> work(*swimmer);
    const State y = state_with<Plane>(*swimmer, law, 0.0, {0.0, {v1, v2}}, work);
    State rate{};
    ASSERT_TRUE(rate_of_state(*swimmer, law, {}, 0.0, y, work, rate));
    EXPECT_NEAR(work.twist.linear.x, v1, 1e-14);
    EXPECT_NEAR(work.twist.linear.y, v2, 1e-14);
    const double wake = added_mass * v1 * v2;
    EXPECT_NEAR(rate[10], -0.5 * added_mass * v2 * v2, 1e-13);  // -T_f t1
    EXPECT_NEAR(rate[11], wake, 1e-13);
    EXPECT_NEAR(rate[9], 0.0, 1e-13);  // Munk's moment is the wake's

    const Powers powers = find_powers(*swimmer, law, work);
    find_accelerations(*swimmer, work);
    const double m = body_mass + added_mass;
    // m (a + alpha / 2) = wake; J alpha + m (a / 2 + alpha / 3) = 0
    const double alpha = -wake / 2.0 / (inertia3 + m / 12.0), a = wake / m - 0.5 * alpha;
    EXPECT_NEAR(work.head_acceleration.angular, alpha, 1e-11);
    EXPECT_NEAR(work.head_acceleration.linear.y, a, 1e-11);
    EXPECT_NEAR(work.head_acceleration.linear.x, -0.5 * added_mass * v2 * v2 / body_mass, 1e-11);
    for (std::size_t i = 0; i < panel_nodes; ++i) {
        const double x = place(*swimmer, i);
        const auto wrench = wrench_at(*swimmer, work, i);
        EXPECT_NEAR(wrench.linear.y, wake - m * (a * (1.0 - x) + 0.5 * alpha * (1.0 - x * x)), 1e-11);
        EXPECT_NEAR(wrench.linear.x, -0.5 * added_mass * v2 * v2 * x, 1e-11);
    }
    EXPECT_NEAR(powers[0], 0.0, 1e-14);  // a rigid body's actuators do no work
    EXPECT_NEAR(powers[1], v1 * 0.5 * added_mass * v2 * v2, 1e-14);
}

TEST(Algorithm, SinkingBodyOfEqualSectionsIsBrakedAlikeEverywhereAndBearsNoWrench)
{
    const auto swimmer = straight_body();
    swimmer->resistive = true;
    const LawOnGrid law = arc(0.0);
    Workspace<Space> work(*swimmer);
    const State y = state_with<Space>(*swimmer, law, 0.0, {{}, {0.0, 0.0, v3}}, work);
    ASSERT_TRUE(find_motion(*swimmer, law, {}, 0.0, y, work));
    swimmer->wake = 0.0;
    const Powers powers = find_powers(*swimmer, law, work);
    find_accelerations(*swimmer, work);
    const double drag = -drag3 * v3 * std::abs(v3);
    EXPECT_NEAR(work.drag.linear.z, drag, 1e-13);
    EXPECT_NEAR(powers[3], drag * v3, 1e-13);
    // The lumped pressure -T_f t1 at the tail pulls along the body alone.
    EXPECT_NEAR(work.head_acceleration.linear.z, drag / (body_mass + added_mass3), 1e-11);
    EXPECT_NEAR(work.head_acceleration.angular.y, 0.0, 1e-11);
    for (std::size_t i = 0; i < panel_nodes; ++i) {
        const auto wrench = wrench_at(*swimmer, work, i);
        EXPECT_NEAR(wrench.linear.z, 0.0, 1e-11);
        EXPECT_NEAR(wrench.angular.y, 0.0, 1e-11);
    }
}

TEST(Algorithm, AccelerationsAreTheSlopesOfTheMarchedTwist)
{
    const auto swimmer = straight_body();
    swimmer->nose_mass = 0.3, swimmer->nose_drag = 0.2;
    const LawOnGrid law = arc(1.5);
    const double time = 0.4, step = 1e-6;
    Workspace<Plane> work(*swimmer);
    const State y = state_with<Plane>(*swimmer, law, time, {0.2, {v1, v2}}, work);
    State rate{};
    ASSERT_TRUE(rate_of_state(*swimmer, law, {}, time, y, work, rate));
    find_powers(*swimmer, law, work);
    const auto acceleration = work.head_acceleration;
    std::array<std::array<double, 3>, 2> twist{};
    for (std::size_t side = 0; side < 2; ++side) {
        const double moved = side == 0 ? -step : step;
        State there = y;
        for (std::size_t k = 0; k < state_size; ++k) there[k] += moved * rate[k];
        ASSERT_TRUE(find_motion(*swimmer, law, {}, time + moved, there, work));
        twist[side] = components_of(work.twist);
    }
    // The true acceleration is V' + Omega x V.
    EXPECT_NEAR(acceleration.angular, (twist[1][0] - twist[0][0]) / (2.0 * step), 1e-7);
    EXPECT_NEAR(acceleration.linear.x, (twist[1][1] - twist[0][1]) / (2.0 * step) - 0.2 * v2, 1e-7);
    EXPECT_NEAR(acceleration.linear.y, (twist[1][2] - twist[0][2]) / (2.0 * step) + 0.2 * v1, 1e-7);
}

TEST(Algorithm, WrenchAtTheNoseIsTheNosesLoad)
{
    const auto swimmer = straight_body();
    swimmer->nose_mass = 0.3, swimmer->nose_drag = 0.2, swimmer->resistive = true;
    const LawOnGrid law = arc(1.5);
    Workspace<Space> work(*swimmer);
    const State y = state_with<Space>(*swimmer, law, 0.4, {{0.1, -0.3, 0.2}, {v1, v2, v3}}, work);
    ASSERT_TRUE(find_motion(*swimmer, law, {}, 0.4, y, work));
    find_powers(*swimmer, law, work);
    find_accelerations(*swimmer, work);
    const auto left = components_of(plus_axial<Space>(work.tail - work.balance, work.nose_force));
    for (const double part : left) EXPECT_NEAR(part, 0.0, 1e-13);
    EXPECT_GT(std::abs(work.nose_force), 1e-3);
}

// The whole algorithm in space against a table that the Python reference wrote: it shares no code with it, and writes
// no acceleration of a section.
TEST(Algorithm, AccelerationsAndWrenchAreThoseOfTheReference)
{
    const auto swimmer = straight_body();
    const auto& [mass, added2, added3, inertia1, inertia2, inertia3_, added_roll] = reference::section;
    const Section<double> section{mass, added2, added3, inertia1, inertia2, inertia3_, added_roll};
    const auto& [drag2, drag3_, drag_roll] = reference::drag;
    swimmer->sections.inertial = constant(section), swimmer->tail = section;
    swimmer->sections.resistance = constant(DragSection<double>{drag2, drag3_, drag_roll, 0.0, 0.0, 0.0, 0.0});
    swimmer->resistive = true;
    const LawOnGrid law = bending(reference::bend);
    const auto& t = reference::twist;
    Workspace<Space> work(*swimmer);
    const State y = state_with<Space>(*swimmer, law, 0.0, {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}}, work);
    ASSERT_TRUE(find_motion(*swimmer, law, {}, 0.0, y, work));
    EXPECT_NEAR(find_powers(*swimmer, law, work)[0], reference::actuator_power,
                1e-5 * std::abs(reference::actuator_power));
    find_accelerations(*swimmer, work);
    const auto acceleration = components_of(work.head_acceleration);
    for (std::size_t k = 0; k < acceleration.size(); ++k)
        EXPECT_NEAR(acceleration[k], reference::acceleration[k], 1e-6 * std::abs(reference::acceleration[0])) << k;
    for (std::size_t i = 0; i < panel_nodes; ++i) {
        const Vector3<double> v = work.frame.node(i).local(work.velocity.node(i)),
                              omega = work.frame.node(i).local(work.omega.node(i));
        const auto wrench =
            components_of(wrench_at(*swimmer, work, i) - momentum_flux<Space, double>(section, v, omega));
        for (std::size_t k = 0; k < wrench.size(); ++k)
            EXPECT_NEAR(wrench[k], reference::wrench[i][k], 1e-5 * std::abs(reference::wrench[0][5])) << i << ", " << k;
    }
}
