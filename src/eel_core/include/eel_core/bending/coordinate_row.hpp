// SPDX-License-Identifier: Apache-2.0
// Observed numbers of the coordinates of a body with modes at an instant, in one row.
#pragma once

#include <numeric>

#include "eel_core/bending/balance.hpp"

namespace eel_core {

// Places of the numbers in the row. Energies and works are in J, powers in W; the moment of a mode is the integral of
// B . C.
struct CoordinateRow {
    // clang-format off
    enum Quantity : std::size_t {
        x, rate, acceleration, moment, torque, pushing, elastic, rotors, motor_power, damping_power, damping_work, quantities
    };
    static constexpr std::array<const char*, quantities> names{
        "x", "rate", "acceleration", "moment", "torque", "pushing", "elastic", "rotors", "motor_power", "damping_power",
        "damping_work"};
    // clang-format on
    std::array<std::size_t, quantities + 1> begin{};  // of each quantity; the last: the size of the row

    CoordinateRow() = default;  // without modes: nothing
    explicit CoordinateRow(const Modes& modes)
    {
        const std::size_t c = modes.coordinates;
        const std::array<std::size_t, quantities> count{c, c, c, modes.modes, modes.servos.size(), c, 1, 1, 1, 1, 1};
        std::partial_sum(count.begin(), count.end(), begin.begin() + 1);
    }
    std::size_t size() const { return begin.back(); }

    // Fills the row with the present, which the body then holds. False if M is not positive definite.
    template <class M>
    bool put(const BentSettings& settings, const Modes& modes, const Present& now, BentBody<M>& body, double* row) const
    {
        if (!body.find_present(settings, now)) return false;
        body.find_rates(settings, now.state);
        body.find_accelerations_and_drift(settings);
        std::ranges::copy(now.x, row + begin[x]);
        std::ranges::copy(now.rate, row + begin[rate]);
        std::ranges::copy(body.acceleration, row + begin[acceleration]);
        for (std::size_t m = 0; m < modes.modes; ++m)
            row[begin[moment] + m] = body.forces.total[m] + modes.armature[m] * body.acceleration[m];
        std::ranges::copy(body.forces.torque, row + begin[torque]);
        std::ranges::copy(body.forces.pushing, row + begin[pushing]);
        row[begin[elastic]] = body.forces.elastic, row[begin[rotors]] = body.rotor_energy();
        row[begin[motor_power]] = body.forces.motor_power;
        row[begin[damping_power]] = body.forces.damping_power;
        row[begin[damping_work]] = now.damping_work;
        return true;
    }
};

}  // namespace eel_core
