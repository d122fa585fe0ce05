// SPDX-License-Identifier: Apache-2.0
// The work space of one evaluation: no data survive from one instant to the next.
#pragma once

#include <cmath>

#include "eel_core/algebra/rotation.hpp"
#include "eel_core/algebra/solve.hpp"
#include "eel_core/flow/values.hpp"
#include "eel_core/law.hpp"
#include "eel_core/model/swimmer.hpp"

namespace eel_core {

// A jump of a load along the body, where a speed changes sign within a panel (`drag_kinks`).
struct Kink {
    Speed speed;
    std::size_t first;            // first node of the panel
    double fraction;              // of the panel
    double jump;                  // of the load's sign: 2 or -2; 1 or -1 of the friction law
    std::vector<double> weights;  // [m], of the panel's nodes, for the integral from its start to the kink
};

// Numbers of a state, padded for lanes: `momentum_balance.hpp`.
inline constexpr std::size_t state_space = 16;

// Accelerations of the sections.
template <class M>
struct Accelerations {
    Field<Angular<M, double>> angular;  // [rad/s^2]
    Field<Vector<M, double>> linear;    // [m/s^2]
};

template <class M>
struct Workspace {
    explicit Workspace(const Swimmer& swimmer)
    {
        const std::size_t n = swimmer.grid.blocks;
        frame = Field<Frame<M, double>>(n), turn = orientation = Field<Quaternion<double>>(n),
        position = Field<Vector<M, double>>(n);
        shape_omega = omega = Field<Angular<M, double>>(n), shape_velocity = velocity = Field<Vector<M, double>>(n),
        curvature_rate = Field<Vector2<double>>(n);
        shape_acceleration = acceleration = {omega, velocity};
        integrand = Field<Wrench<M, double>>(n), density = Field<Wrench<M, double>>(n);
        friction_laminar = friction_excess = turbulent_share = turbulent_weight = Row(n);
        for (Row& row : speed) row = Row(n);
        for (const Speed each : {lateral, vertical, roll}) load_weight[each] = Row(n);
        fins.resize(swimmer.fins.size()), appendages.resize(swimmer.appendages.size());
        if (!fins.empty()) fin_places = Field<Vector3<double>>(blocks_of(fins.size()));
    }

    std::vector<Jet> factor;  // of the law's rows

    // Along the body, in the axes of the head, about the head:
    Field<Frame<M, double>> frame;            // t1, t2, t3 of the sections
    Field<Quaternion<double>> orientation;    // the same orientation, only in space
    Field<Quaternion<double>> turn;           // rotation from the previous node to this one, only in space
    Field<Vector<M, double>> position;        // r [m]
    Field<Angular<M, double>> shape_omega;    // [rad/s], due only to the change of shape
    Field<Vector<M, double>> shape_velocity;  // [m/s], likewise
    Field<Angular<M, double>> omega;          // [rad/s], including the head's motion, like the next
    Field<Vector<M, double>> velocity;        // [m/s]
    Field<Vector2<double>> curvature_rate;    // Kdot [rad/m/s], pitch and yaw; with modes the imposed part alone until
                                              // the accelerations are known
    Field<Wrench<M, double>> integrand;
    Accelerations<M> shape_acceleration, acceleration;  // without and with the head's acceleration
    // The balance: wrench needed for the motion minus loads, per length, about the head; without the jumps at kinks.
    Field<Wrench<M, double>> density;

    // With moving water (`flowing`); otherwise without memory:
    bool flowing = false;
    FlowValues<M> flow;                 // in the axes of the head
    Field<Vector<M, double>> relative;  // [m/s], velocity through the water
    Wrench<M, double> flow_load{};      // the flow's part of the rate of the momentum

    const Field<Vector<M, double>>& velocity_through_water() const { return flowing ? relative : velocity; }
    Vector<M, double> nose_through_water() const { return flowing ? twist.linear - flow.nose().u : twist.linear; }

    // Fins, only in space:
    std::vector<FinMotion> fins;
    Field<Vector3<double>> fin_places;             // [m], about the head
    FlowValues<Space> fin_flow;                    // at these places, with moving water
    std::array<double, state_space> servo_rate{};  // [rad/s], in their slots of the state
    Wrench<Space, double> fin_load{};              // the fins' part of the rate of the momentum

    std::vector<AppendageMotion<M>> appendages;
    Wrench<M, double> appendage_load{};  // their sum

    // Drag, in section axes:
    std::array<Row, speeds> speed;          // see `Speed`
    Row friction_laminar, friction_excess;  // [kg/m/s], friction per V1 from the laminar law, with the drag of the
                                            // links; and the turbulent excess
    Row turbulent_share;                    // of the friction, 0 to 1
    Row turbulent_weight;                   // [m], integration weights of the excess
    std::array<Row, 4> load_weight;         // [m], of the other loads, with signs; none for `axial`
    std::vector<Kink> kinks;                // the first `kink_count` are valid
    std::size_t kink_count = 0;

    // Where wrenches act from outside (`has_external`):
    bool has_external = false;
    std::vector<ExternalLoad<M>> external;
    Wrench<M, double> external_load{};  // their sum

    // Of the whole body:
    Frame<M, double> head;                    // axes of the head in the world
    Factored<M::freedoms> inertia, factored;  // about the head; the latter is factored in place
    Twist<M, double> twist;                   // of the head, relative to the water
    Momentum<M, double> momentum;             // of body, water and nose
    Momentum<M, double> shape_momentum;       // of only the change of shape
    Wrench<M, double> tail, drag;             // on the body
    Vector3<double> up{};                     // of the world; like the next two, if the body has weight
    double height = 0.0;                      // of the nose [m], above zero potential energy
    Wrench<M, double> weight{};               // of weight and buoyancy
    double drag_power = 0.0;                  // [W]
    double tail_speed = 0.0;                  // V1 at the tail [m/s]
    double tail_energy = 0.0;                 // T_f there [J/m]
    Twist<M, double> head_acceleration;
    Wrench<M, double> balance;  // integral over the body of the density, as in the head's equation
    double nose_force = 0.0;    // [N], along t1(0)
};

}  // namespace eel_core
