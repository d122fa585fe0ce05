// SPDX-License-Identifier: Apache-2.0
// Where the numbers of samples lie: T instants, M stations, S sensors, one block of doubles for each quantity, all in
// one array.
#pragma once

#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace eel_core {

struct Profiles {
    enum Quantity : std::size_t {
        position,             // (T, 3) m, head, world
        orientation,          // (T, 4) x y z w, world from head
        twist,                // (T, 6) rad/s, m/s, over ground, axes of the head
        head_acceleration,    // (T, 6) rad/s^2, m/s^2, true acceleration of the head, its axes
        center_of_mass,       // (T, 3) m, world
        energies,             // (T, 3) J, kinetic of body and of water, potential
        powers,               // (T, 8) W, actuators, wake, nose, drag, flow, fins, appendages, wrenches from outside
        closure,              // (T, 2) N m, N: what is left of the internal wrench at the nose
        backbone,             // (T, M, 3) m, world
        section_orientation,  // (T, M, 4) x y z w, world from section
        curvature,            // (T, M, 3) rad/m
        curvature_rate,       // (T, M, 3) rad/m/s
        torque,               // (T, M, 3) N m, section axes; as `force` where the wrench is asked for
        force,                // (T, M, 3) N
        fluid_force,      // (T, M, 3) N/m, of the water on the body, section axes; as the next three where the load is
        resistive_force,  // (T, M, 3) N/m, its resistive part
        tail_force,       // (T, 3) N, axes of the tail's section
        nose_force,       // (T, 3) N, axes of the nose's section
        wake_momentum_rate,  // (T, 3) N, axes of the tail's section: momentum given to the wake per time
        fin_angle,           // (T, F) rad
        fin_force,           // (T, F, 3) N, of the water on each fin, axes of its section
        sensor_position,     // (T, S, 3) m, world
        sensor_orientation,  // (T, S, 4) x y z w, world from section
        sensor_twist,  // (T, S, 6) rad/s, m/s, over ground; as the next two in axes of the section, as REP-103 has
        sensor_acceleration,  // (T, S, 6) rad/s^2, m/s^2, angular and true acceleration
        sensor_water,         // (T, S, 3) m/s, velocity of the water over ground, without the swimmer
        quantities
    };
    struct Described {
        Quantity quantity;
        const char* name;   // in Python
        std::size_t width;  // numbers at one instant, of one station, fin or sensor
    };
    static constexpr Described described[] = {
        {position, "position", 3},
        {orientation, "orientation", 4},
        {twist, "twist", 6},
        {head_acceleration, "head_acceleration", 6},
        {center_of_mass, "center_of_mass", 3},
        {energies, "energies", 3},
        {powers, "powers", 8},
        {closure, "closure", 2},
        {backbone, "backbone", 3},
        {section_orientation, "section_orientation", 4},
        {curvature, "curvature", 3},
        {curvature_rate, "curvature_rate", 3},
        {torque, "torque", 3},
        {force, "force", 3},
        {fluid_force, "fluid_force", 3},
        {resistive_force, "resistive_force", 3},
        {tail_force, "tail_force", 3},
        {nose_force, "nose_force", 3},
        {wake_momentum_rate, "wake_momentum_rate", 3},
        {fin_angle, "fin_angle", 1},
        {fin_force, "fin_force", 3},
        {sensor_position, "sensor_position", 3},
        {sensor_orientation, "sensor_orientation", 4},
        {sensor_twist, "sensor_twist", 6},
        {sensor_acceleration, "sensor_acceleration", 6},
        {sensor_water, "sensor_water", 3},
    };

    std::size_t samples, stations, fins, sensors;
    bool wrench, load;
    std::size_t begin[quantities + 1];  // of each quantity in the array; the last: its size

    Profiles(std::size_t instants_wanted, std::size_t points, bool wrench_wanted, bool load_wanted,
             std::size_t fin_count = 0, std::size_t sensor_count = 0)
        : samples(instants_wanted),
          stations(points),
          fins(fin_count),
          sensors(sensor_count),
          wrench(wrench_wanted),
          load(load_wanted)
    {
        begin[0] = 0;
        for (std::size_t q = 0; q < quantities; ++q) begin[q + 1] = begin[q] + instants(q) * numbers(q);
    }

    bool along_body(std::size_t q) const { return backbone <= q && q <= resistive_force; }
    bool of_fins(std::size_t q) const { return q == fin_angle || q == fin_force; }
    bool of_sensors(std::size_t q) const { return sensor_position <= q && q < quantities; }
    std::size_t instants(std::size_t q) const
    {
        if (of_fins(q)) return fins > 0 ? samples : 0;
        if (of_sensors(q)) return sensors > 0 ? samples : 0;
        if (q == torque || q == force) return wrench ? samples : 0;
        if (q == fluid_force || q == resistive_force) return load ? samples : 0;
        return samples;
    }
    // Of one instant.
    std::size_t numbers(std::size_t q) const
    {
        return described[q].width * (along_body(q) ? stations : of_fins(q) ? fins : of_sensors(q) ? sensors : 1);
    }

    double* at(double* whole, Quantity q, std::size_t sample) const { return whole + begin[q] + sample * numbers(q); }
};

static_assert([] {
    for (std::size_t q = 0; q < Profiles::quantities; ++q)
        if (Profiles::described[q].quantity != q) return false;
    return std::size(Profiles::described) == Profiles::quantities;
}());

}  // namespace eel_core
