// SPDX-License-Identifier: Apache-2.0
// The greatest values of splines through samples.
#pragma once

#include <cmath>
#include <utility>

#include "eel_core/algebra/spline.hpp"

namespace eel_core {

// The size of a group of numbers: the sum of their positive parts by the weights, where there are any; else that of a
// vector, or of a number, with its sign if wanted.
struct Size {
    std::size_t width;
    bool with_sign;
    std::vector<double> weights;

    double operator()(const double* numbers) const
    {
        double sum = 0.0;
        if (!weights.empty()) {
            for (std::size_t k = 0; k < width; ++k) sum += weights[k] * std::max(numbers[k], 0.0);
            return sum;
        }
        if (width == 1) return with_sign ? numbers[0] : std::abs(numbers[0]);
        for (std::size_t k = 0; k < width; ++k) sum += numbers[k] * numbers[k];
        return std::sqrt(sum);
    }
};

// Where peaks are looked for: from `start` to `end`; only of groups with a sample of `near` of the greatest size or
// more, and then by a spline through these samples and so many `beside` them, before the first and after the last.
struct PeakSearch {
    double start, end, near;
    std::size_t beside;
};

// Instants in a sample period, among which the greatest is looked for.
constexpr int instants_between = 8;

struct Peak {
    double size = 0.0, place = 0.0;
};

// The greatest of sizes at places that rise, by a parabola through it and its neighbours.
class Greatest {
  public:
    void add(double place, double size)
    {
        const Peak here{size, place};
        if (count_ == 0 || size > peak_.size)
            before_ = last_, peak_ = here, at_ = count_;
        else if (count_ == at_ + 1)
            after_ = here;
        last_ = here, ++count_;
    }
    Peak peak() const
    {
        if (at_ == 0 || at_ + 1 == count_) return peak_;
        const auto [size, place] = peak_;
        const double left = place - before_.place, right = after_.place - place;
        const double up = (size - before_.size) / left, down = (after_.size - size) / right;
        const double bend = (down - up) / (left + right), slope = (up * right + down * left) / (left + right);
        if (!(bend < 0.0)) return peak_;
        const double step = std::clamp(-0.5 * slope / bend, -left, right);
        return {size + step * (slope + step * bend), place + step};
    }

  private:
    std::size_t count_ = 0, at_ = 0;
    Peak before_, peak_, after_, last_;
};

// The peak of each group of `size.width` columns of the values at x; 0 for a group that is left out.
inline std::vector<Peak> peaks(std::span<const double> x, const double* values, std::size_t groups, const Size& size,
                               const PeakSearch& search)
{
    std::vector<bool> counts(groups, true);
    std::size_t begin = 0, end = x.size();
    if (search.near > 0.0) {
        std::vector<double> sizes(x.size() * groups);
        for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k] = size(values + k * size.width);
        const double least = search.near * *std::max_element(sizes.begin(), sizes.end());
        counts.assign(groups, false), begin = end, end = 0;
        for (std::size_t k = 0; k < sizes.size(); ++k)
            if (sizes[k] >= least) counts[k % groups] = true, begin = std::min(begin, k / groups), end = k / groups + 1;
        begin -= std::min(begin, search.beside), end = std::min(x.size(), end + search.beside);
    }
    std::vector<double> used;
    for (std::size_t k = begin * groups; k < end * groups; ++k)
        if (counts[k % groups]) used.insert(used.end(), values + k * size.width, values + (k + 1) * size.width);
    const Spline spline(x.subspan(begin, end - begin), std::move(used), Spline::highest);

    std::vector<double> row(spline.columns());
    std::vector<Greatest> greatest(spline.columns() / size.width);
    const auto look_at = [&](double place) {
        spline.at(place, row.data());
        for (std::size_t g = 0; g < greatest.size(); ++g) greatest[g].add(place, size(row.data() + g * size.width));
    };
    double here = std::clamp(x[begin], search.start, search.end);
    look_at(here);
    for (std::size_t k = begin + 1; k < end; ++k) {
        const double next = std::clamp(x[k], search.start, search.end), step = next - here;
        if (!(step > 0.0)) continue;
        for (int s = 1; s < instants_between; ++s) look_at(here + static_cast<double>(s) / instants_between * step);
        look_at(here = next);
    }
    std::vector<Peak> result(groups);
    auto found = greatest.begin();
    for (std::size_t g = 0; g < groups; ++g)
        if (counts[g]) result[g] = (found++)->peak();
    return result;
}

}  // namespace eel_core
