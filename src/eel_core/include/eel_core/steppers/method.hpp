// SPDX-License-Identifier: Apache-2.0
// The methods for steps in time. The last rate of a step is the first of the next.
//
// Adams and Bashforth's of orders 1 to 6 (`adams.hpp`); the pair of Dormand and Prince of orders 5(4) (J. Comp. Appl.
// Math. 6 (1980)), with dense output of order 4 by Shampine (Math. Comp. 46 (1986)); the classical Runge-Kutta method.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace eel_core {

struct Method {
    static constexpr std::size_t most_stages = 7;
    using Weights = std::array<double, most_stages>;

    std::size_t stages;
    std::array<Weights, most_stages> a;                    // a[i][j], weight of rate j in the state of stage i
    Weights c;                                             // time of the stages, as fractions of the step
    Weights error;                                         // weights of the error estimate
    std::array<std::array<double, 4>, most_stages> dense;  // y(theta) = y + h sum_i k_i sum_j dense[i][j] theta^(j+1)
    bool adaptive;
    int order;          // of the error as a power of the step's length
    std::size_t adams;  // order of Adams' method, whose rows are the first, the mean and the last rate; 0: Runge-Kutta

    // From the cubic that matches value and rate at both ends, with the weights of the mean rate.
    void set_hermite_output(const Weights& mean)
    {
        for (std::size_t i = 0; i < stages; ++i) dense[i] = {0.0, 3.0 * mean[i], -2.0 * mean[i], 0.0};
        dense[0][0] += 1.0, dense[0][1] -= 2.0, dense[0][2] += 1.0;
        dense[stages - 1][1] -= 1.0, dense[stages - 1][2] += 1.0;
    }

    static Method adams_bashforth(std::size_t order)
    {
        Method m{};
        m.stages = 3, m.c = {0.0, 0.5, 1.0}, m.adaptive = true, m.order = static_cast<int>(order) + 1, m.adams = order;
        m.set_hermite_output({0.0, 1.0, 0.0});
        return m;
    }
    static Method classical()
    {
        Method m{};
        m.stages = 5, m.c = {0.0, 0.5, 0.5, 1.0, 1.0}, m.order = 4;
        m.a[1] = {0.5}, m.a[2] = {0.0, 0.5}, m.a[3] = {0.0, 0.0, 1.0};
        m.a[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
        m.set_hermite_output(m.a[4]);
        return m;
    }
    static Method dormand_prince()
    {
        Method m{};
        m.stages = 7, m.c = {0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0}, m.adaptive = true, m.order = 5;
        m.a[1] = {1.0 / 5.0};
        m.a[2] = {3.0 / 40.0, 9.0 / 40.0};
        m.a[3] = {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0};
        m.a[4] = {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0};
        m.a[5] = {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0};
        m.a[6] = {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0};
        m.error = {71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
        m.dense = {
            {{1.0, -8048581381.0 / 2820520608.0, 8663915743.0 / 2820520608.0, -12715105075.0 / 11282082432.0},
             {0.0, 0.0, 0.0, 0.0},
             {0.0, 131558114200.0 / 32700410799.0, -68118460800.0 / 10900136933.0, 87487479700.0 / 32700410799.0},
             {0.0, -1754552775.0 / 470086768.0, 14199869525.0 / 1410260304.0, -10690763975.0 / 1880347072.0},
             {0.0, 127303824393.0 / 49829197408.0, -318862633887.0 / 49829197408.0, 701980252875.0 / 199316789632.0},
             {0.0, -282668133.0 / 205662961.0, 2019193451.0 / 616988883.0, -1453857185.0 / 822651844.0},
             {0.0, 40617522.0 / 29380423.0, -110615467.0 / 29380423.0, 69997945.0 / 29380423.0}}};
        return m;
    }
    static Method of(const std::string& name, std::size_t order)
    {
        if (name == "adams") return adams_bashforth(order);
        if (name == "classical") return classical();
        if (name == "dormand_prince") return dormand_prince();
        throw std::invalid_argument("method must be 'adams', 'dormand_prince' or 'classical', got '" + name + "'");
    }
};

}  // namespace eel_core
