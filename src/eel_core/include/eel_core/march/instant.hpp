// SPDX-License-Identifier: Apache-2.0
// Single instants, for studies and tests: loads and inertia for a given motion of the head, in space.
#pragma once

#include <memory>

#include "eel_core/algorithm.hpp"

namespace eel_core {

class Instant {
  public:
    explicit Instant(std::shared_ptr<const Swimmer> swimmer) : swimmer_(std::move(swimmer)), work_(*swimmer_) {}

    // Inertia of the body about the head, nose included, as the law bends it.
    Factored<6> inertia(const LawOnGrid& law, double time)
    {
        configure(*swimmer_, law, time, work_);
        inertia_and_momentum(*swimmer_, work_);
        return work_.inertia;
    }

    // Wrenches of wake and drag, appendages included, on the body for a given twist of the head, in still water.
    std::array<Wrench<Space, double>, 2> loads(const LawOnGrid& law, double time, const Twist<Space, double>& twist)
    {
        move(law, time, twist);
        return {work_.tail, work_.drag + work_.appendage_load};
    }

    // Powers of the axial friction, the lateral and vertical drag, the roll drag, the drag of the links, and that of
    // the base of the tail, for a given twist of the head in the state y, whose momentum is not read. `modes`: of the
    // last rows of the law, their factors, then the rates.
    std::array<double, 6> drag_powers(const LawOnGrid& law, double time, const Twist<Space, double>& twist,
                                      const Water& water, const State& y, std::span<const double> modes)
    {
        const std::size_t rows = law.tables->rows(), count = modes.size() / 2;
        work_.factor.resize(rows);
        for (std::size_t m = 0; m < count; ++m) work_.factor[rows - count + m] = {modes[m], modes[count + m], 0.0};
        move(law, time, twist, water, y);
        std::array<Lanes, 5> sum;
        sum.fill(Lanes(0.0));
        for (std::size_t k = 0; swimmer_->resistive && k < swimmer_->grid.blocks; ++k) {
            auto v = speeds_from(work_, width * k);
            Lanes turning = roll_from(work_, width * k);
            const auto load = weighed_load(*swimmer_, work_, k);
            if (work_.flowing) {  // the power is that of the true velocities
                const auto frame = work_.frame[k];
                v += frame.local(work_.flow[k].u);
                turning += 0.5 * work_.flow[k].g.curl_along(frame.t1());
            }
            if (swimmer_->segmented) {
                const auto w = speeds_from(work_, width * k);
                const Lanes weight = swimmer_->grid.weight[k] * swimmer_->sections.drag(k).segment;
                sum[4] -= weight * sqrt(dot(w, w)) * w.x * v.x;
            }
            sum[0] += load.linear.x * v.x;
            sum[1] += load.linear.y * v.y;
            sum[2] += load.linear.z * v.z;
            sum[3] += roll_torque(load) * turning;
        }
        const double links = total(sum[4]),
                     base = work_.appendages.empty() ? 0.0 : appendage_powers(*swimmer_, work_)[1];
        return {total(sum[0]) - links, total(sum[1]), total(sum[2]), total(sum[3]), links, base};
    }

    // Rate of the momentum along the body for a given twist and acceleration of the head.
    Wrench<Space, double> momentum_rate(const LawOnGrid& law, double time, const Twist<Space, double>& twist,
                                        const Twist<Space, double>& acceleration)
    {
        move(law, time, twist);
        find_shape_accelerations(*swimmer_, law, work_);
        add_head_motion(*swimmer_, acceleration, work_.position, work_.shape_acceleration.angular,
                        work_.shape_acceleration.linear, work_.acceleration.angular, work_.acceleration.linear);
        return set_inertial_density(*swimmer_, work_.acceleration, work_);
    }

  private:
    static constexpr State origin{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};

    void move(const LawOnGrid& law, double time, const Twist<Space, double>& twist, const Water& water = {},
              const State& y = origin)
    {
        configure(*swimmer_, law, time, work_);
        work_.head = head_frame(y, Space());
        set_flow(*swimmer_, water, time, Vector3{y[0], y[1], y[2]}, work_);
        set_velocities(*swimmer_, twist, work_);
        if (work_.flowing) set_flow_load(*swimmer_, work_);
        find_loads(*swimmer_, work_);
    }

    std::shared_ptr<const Swimmer> swimmer_;
    Workspace<Space> work_;
};

}  // namespace eel_core
