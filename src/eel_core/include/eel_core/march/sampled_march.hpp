// SPDX-License-Identifier: Apache-2.0
// Many swimmers of one kind, marched in one call over threads, each with its own controller's samples.
//
// A control step takes one sample: the curvature at its end. Between two samples the curvature is the quintic that
// meets value, rate and acceleration at both. At the start a swimmer is straight and at rest: its difference from
// the first sample dies out in a blend. Swimmers share no mutable state, so the number of threads changes no result.
#pragma once

#include <unistd.h>

#include "eel_core/march/march.hpp"
#include "eel_core/march/threads.hpp"

namespace eel_core {

inline constexpr std::size_t rows_of_axis = 3;  // of a sample: the curvature, its rate and its acceleration
inline constexpr std::size_t sample_rows = 2 * rows_of_axis;  // pitch, then yaw

// Takes values at the points of a sample to the columns of a law's tables.
struct SampleWeights {
    std::size_t points, columns;
    std::vector<double> weight;  // (points, columns)
};

// result (rows_of_axis, columns) of the values (rows_of_axis, points), by the weights (points, columns), summed from
// the first point to the last. The sums of the rows are independent.
inline void tabulate(const double* weights, std::size_t points, std::size_t columns, const double* values,
                     double* result)
{
    const auto put_sums = [&]<class T>(std::size_t k, T zero, const auto& load, const auto& store) {
        std::array<T, rows_of_axis> total{zero, zero, zero};
        for (std::size_t point = 0; point < points; ++point) {
            const T weight = load(weights + point * columns + k);
            for (std::size_t row = 0; row < rows_of_axis; ++row) total[row] += values[row * points + point] * weight;
        }
        for (std::size_t row = 0; row < rows_of_axis; ++row) store(total[row], result + row * columns + k);
    };
    std::size_t k = 0;
    for (; k + width <= columns; k += width)
        put_sums(
            k, Lanes(0.0), [](const double* from) { return Lanes::load(from); },
            [](Lanes sum, double* to) { sum.store(to); });
    for (; k < columns; ++k)
        put_sums(k, 0.0, [](const double* from) { return *from; }, [](double sum, double* to) { *to = sum; });
}

// Data common to all swimmers.
struct SampledKind {
    std::shared_ptr<const Swimmer> swimmer;
    Method method;
    bool planar, ledger;
    Vector3<double> current;  // [m/s]
    SampleWeights weights;
    double transition;  // [s], of the blend
};

class SampledMarch {
  public:
    explicit SampledMarch(std::shared_ptr<const SampledKind> kind)
        : kind_(std::move(kind)), march_(kind_->swimmer, kind_->method, kind_->planar), rows_(columns() * sample_rows)
    {
    }

    March& march() { return march_; }
    bool begun() const { return tables_ != nullptr; }

    // Hands over all that goes on; the `flow` is that of the start (`march/archive.hpp`).
    template <class Archive>
    void pass(Archive& archive, const std::shared_ptr<const Flow>& flow = {})
    {
        bool begins = begun();
        archive(begins);
        if constexpr (Archive::reads) {
            flow_ = flow, tables_ = nullptr;
            if (begins) begin_law();
        }
        if (!begins) return;
        std::vector<double> breakpoints = march_.settings().breakpoints;
        archive(bounds_, rows_, still_, under_way_, unfinished_, law_.segment, law_.blend, breakpoints, *tables_);
        if constexpr (Archive::reads) follow(std::move(breakpoints), false);
        archive(march_);
    }

    // Stands at the start, straight, with the head's twist relative to the water; `values`: the sample at time 0;
    // `flow`: by which its water moves, no function of Python; none: not by itself. Returns the kinetic and potential
    // energy [J].
    double start(const StepBounds& bounds, const Vector3<double>& position, const Quaternion<double>& orientation,
                 const Twist<Space, double>& twist, const double* values, std::shared_ptr<const Flow> flow = {})
    {
        flow_ = std::move(flow);
        begin_law();
        still_ = {true, true}, rows_.assign(rows_.size(), 0.0);
        bounds_ = bounds, under_way_ = unfinished_ = false;
        tabulate_sample(values);
        follow({}, false);
        return march_.start(position, orientation, twist);
    }

    // Marches to `time` [s], at which the sample has these `values`; or continues an unfinished march.
    Status advance(double time, const double* values)
    {
        if (!unfinished_) take_sample(time, values);
        const Status status = march_.advance(time);
        unfinished_ = status == Status::unfinished;
        return status;
    }

  private:
    static constexpr std::size_t axes_rows = 6, blend_row = 12;

    std::size_t columns() const { return kind_->weights.columns; }

    void begin_law()
    {
        static const std::vector<std::size_t> axes{0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 1, 1, 1};
        tables_ = std::make_shared<LawTables>(axes, kind_->swimmer->grid.nodes, kind_->swimmer->stations);
        law_ = {tables_, 0.0, {}, {}, {}, {}, {}};
    }

    void take_sample(double time, const double* values)
    {
        const double start = march_.now().time;
        const bool begins = !under_way_;
        law_.segment.row = 0, law_.segment.start = start, law_.segment.end = time;
        if (begins) {
            set_ends(law_.segment.of_start);
            begin_blend(start);
        } else {  // the old end is the new start
            std::swap(law_.segment.of_start, law_.segment.of_end);
            for (auto& rows : tables_->rows_of)
                std::rotate(rows.begin(), rows.begin() + rows_of_axis, rows.begin() + axes_rows);
        }
        tabulate_sample(values);
        set_ends(law_.segment.of_end);
        if (law_.blend.row != Quintic::none && start >= law_.blend.end) end_blend();
        std::vector<double> breakpoints{start, time};
        if (law_.blend.row != Quintic::none) breakpoints.push_back(law_.blend.end);
        std::sort(breakpoints.begin(), breakpoints.end());
        follow(std::move(breakpoints), !begins);
        under_way_ = true;
    }

    // To `rows_`; an axis that has not bent yet has rows of 0, here and in the tables.
    void tabulate_sample(const double* values)
    {
        const std::size_t points = kind_->weights.points;
        for (const std::size_t axis : {0u, 1u}) {
            const double* const given = values + rows_of_axis * points * axis;
            still_[axis] =
                still_[axis] && std::all_of(given, given + rows_of_axis * points, [](double x) { return x == 0.0; });
            if (!still_[axis]) tabulate(kind_->weights.weight.data(), points, columns(), given, rows_of(axis));
        }
    }

    double* rows_of(std::size_t axis) { return rows_.data() + rows_of_axis * axis * columns(); }

    // Sets the rows of one end of the quintic, `first` of each axis and the two behind it.
    void set_ends(std::size_t first)
    {
        for (const std::size_t axis : {0u, 1u})
            for (std::size_t row = 0; row < rows_of_axis && !still_[axis]; ++row)
                tables_->set(axes_rows * axis + first + row, rows_of(axis) + row * columns());
    }

    // Blends from the straight body to the first sample, whose rows are in `rows_`.
    // Other blends are made in Python: `LawFollower` in eel_dynamics/curvature/law_follower.py.
    void begin_blend(double start)
    {
        std::vector<Jet> factor(tables_->rows());
        law_.segment.set_segment(factor, start);
        bool differs = false;
        for (std::size_t row = 0; row < sample_rows; ++row) {
            double* const difference = rows_.data() + row * columns();
            for (std::size_t k = 0; k < columns(); ++k) {
                difference[k] = 0.0 - factor[row % 3][row % 3] * difference[k];
                differs |= difference[k] != 0.0;
            }
            tables_->set(blend_row + row, difference);
        }
        if (differs)
            law_.blend = {blend_row, start, start + kind_->transition};
        else
            end_blend();
    }

    // Removes the rows of the blend, so that they cost nothing.
    void end_blend()
    {
        law_.blend = {};
        for (auto& rows : tables_->rows_of) rows.resize(axes_rows);
    }

    void follow(std::vector<double> breakpoints, bool smoothly)
    {
        march_.follow({{law_, std::move(breakpoints), bounds_, kind_->ledger, {kind_->current, flow_}}, 0, {}, {}},
                      smoothly);
    }

    std::shared_ptr<const SampledKind> kind_;
    March march_;
    std::shared_ptr<const Flow> flow_;
    std::shared_ptr<LawTables> tables_;  // of the quintic, then of the blend
    LawOnGrid law_;
    StepBounds bounds_{};
    std::vector<double> rows_;     // (sample_rows, columns) of the last sample
    std::array<bool, 2> still_{};  // axes that have not bent since the start
    bool under_way_ = false, unfinished_ = false;
};

// A forked process has no threads: joining them would never return.
struct EndThreads {
    pid_t process = getpid();
    void operator()(Threads* threads) const
    {
        if (process == getpid()) delete threads;
    }
};

class SampledMarches {
  public:
    SampledMarches(const std::shared_ptr<const SampledKind>& kind, std::size_t count, std::size_t threads)
        : marches_(count, SampledMarch(kind)),
          threads_(new Threads(std::min(threads, count))),
          points_(kind->weights.points)
    {
    }

    std::size_t size() const { return marches_.size(); }
    std::size_t points() const { return points_; }
    SampledMarch& operator[](std::size_t index) { return marches_.at(index); }

    // Archives the whole state.
    void pass(Writer& writer)
    {
        writer.same(size());
        for (SampledMarch& march : marches_) march.pass(writer);
    }
    // Restores it; `flows`: of each swimmer, as at its start. Nothing changes if it does not fit.
    void pass(Reader& reader, const std::vector<std::shared_ptr<Flow>>& flows)
    {
        reader.same(size());
        std::vector<SampledMarch> there = marches_;
        for (std::size_t i = 0; i < size(); ++i) there[i].pass(reader, i < flows.size() ? flows[i] : nullptr);
        reader.finish();
        marches_ = std::move(there);
    }

    // Wakes the threads, as `advance` will be called soon.
    void wake() { threads_->wake(); }

    // Marches each swimmer to its own time in `times` (N,) [s], where its sample has the `values` (N, 6, points).
    // `status` (N,): those below 0 are left out; afterwards how each came back. `heads` (13, N): position [m],
    // orientation, twist over ground [rad/s, m/s] of each that marched.
    void advance(const double* times, const double* values, std::int64_t* status, double* heads)
    {
        threads_->run(size(), [&](std::size_t i) {
            if (status[i] < 0) return;
            Status found = marches_[i].advance(times[i], values + i * sample_rows * points_);
            if (found == Status::marched && !put_head(i, heads)) found = Status::singular;
            status[i] = static_cast<std::int64_t>(found);
        });
    }

    // Puts the head of a swimmer into its column of `heads`, in the axes of the outside; false where the inertia is not
    // positive definite.
    bool put_head(std::size_t index, double* heads)
    {
        const std::optional<HeadMotion> found = marches_[index].march().head();
        if (!found) return false;
        const HeadMotion head = half_turn(*found);
        for (std::size_t row = 0; row < head.size(); ++row) heads[row * size() + index] = head[row];
        return true;
    }

  private:
    std::vector<SampledMarch> marches_;
    std::unique_ptr<Threads, EndThreads> threads_;
    std::size_t points_;
};

}  // namespace eel_core
