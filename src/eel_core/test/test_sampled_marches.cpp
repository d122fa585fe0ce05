// SPDX-License-Identifier: Apache-2.0
// Swimmers that march together under samples swim alike for any number of threads, again and again.
#include <gtest/gtest.h>

#include "eel_core/march/sampled_march.hpp"
#include "straight_body.hpp"

using namespace eel_core;

namespace {

constexpr std::size_t swimmers = 17, steps = 40;

std::vector<double> swum(std::size_t threads)
{
    const auto swimmer = straight_body();
    swimmer->nose_mass = 0.3;
    std::vector<double> weights(4 * panel_nodes, 0.0);  // of one point: a constant curvature
    const PanelOfOne panel;
    for (std::size_t i = 0; i < panel_nodes; ++i) {
        weights[i] = 1.0;
        weights[panel_nodes + i] = panel.fraction[i] - (i > 0 ? panel.fraction[i - 1] : 0.0);
    }
    const auto kind = std::make_shared<const SampledKind>(
        SampledKind{swimmer, Method::adams_bashforth(5), true, true, {}, {1, 4 * panel_nodes, weights}, 0.3});
    SampledMarches marches(kind, swimmers, threads);
    const StepBounds bounds{1e-7, 1.0, 1e-11, 1.0, 0.01, 1.0, 1e5, 1e5};
    const auto sample = [](std::size_t i, double time, double* values) {
        const double frequency = 4.0 + 0.1 * static_cast<double>(i), angle = frequency * time;
        std::fill_n(values, 3, 0.0);
        values[3] = std::sin(angle), values[4] = frequency * std::cos(angle);
        values[5] = -frequency * frequency * std::sin(angle);
    };
    std::vector<double> values(sample_rows * swimmers), heads(13 * swimmers), times(swimmers), found;
    for (std::size_t i = 0; i < swimmers; ++i) {
        sample(i, 0.0, values.data());
        marches[i].start(bounds, {0.0, static_cast<double>(i), 0.0}, {0.0, 0.0, 0.0, 1.0}, {}, values.data());
    }
    for (std::size_t step = 1; step <= steps; ++step) {
        std::vector<std::int64_t> status(swimmers, 0);
        status[3] = -1;  // this one is left out
        for (std::size_t i = 0; i < swimmers; ++i) {
            times[i] = 0.02 * static_cast<double>(step);
            sample(i, times[i], values.data() + sample_rows * i);
        }
        marches.advance(times.data(), values.data(), status.data(), heads.data());
        for (std::size_t i = 0; i < swimmers; ++i) EXPECT_EQ(status[i], i == 3 ? -1 : 0);
        found.insert(found.end(), heads.begin(), heads.end());
    }
    return found;
}

}  // namespace

TEST(SampledMarches, NumberOfThreadsChangesNoBit)
{
    const std::vector<double> one = swum(1);
    EXPECT_EQ(one, swum(4));
    EXPECT_EQ(one, swum(2 * swimmers));
    double moved = 0.0;
    for (std::size_t i = 0; i < swimmers; ++i) moved = std::max(moved, std::abs(one[one.size() - 13 * swimmers + i]));
    EXPECT_GT(moved, 1e-3);  // [m]
}

TEST(SampledMarches, ThreadsDoEachItemOnceWhetherTheyAreAwakeOrNot)
{
    for (const std::size_t count : {1u, 2u, 3u, 7u}) {
        Threads threads(count);
        std::vector<int> done(40, 0);  // not atomic: two threads at one item would be found
        for (std::size_t round = 0; round < 200; ++round) {
            if (round % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // helpers fall asleep
            if (round % 3 == 0) threads.wake();                                              // at times in vain
            if (round % 60 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            threads.run(round % 41, [&](std::size_t item) { ++done[item]; });
        }
        for (std::size_t item = 0; item < done.size(); ++item) {
            int expected = 0;
            for (std::size_t round = 0; round < 200; ++round) expected += item < round % 41;
            EXPECT_EQ(done[item], expected);
        }
    }
}
