// SPDX-License-Identifier: Apache-2.0
// The flow at the nodes, or at the stations, and at the nose, in the axes of the head.
#pragma once

#include <algorithm>
#include <optional>

#include "eel_core/algebra/field.hpp"
#include "eel_core/flow/sources.hpp"

namespace eel_core {

template <class M>
class FlowValues {
  public:
    FlowSample<M, Lanes> operator[](std::size_t block) const { return here_[block]; }
    FlowSample<M, double> node(std::size_t i) const { return here_.node(i); }
    const FlowSample<M, double>& nose() const { return nose_; }
    // Time [s] and place [m] in the world where the flow was asked for last and is not known: outside a grid.
    const std::optional<std::array<double, 4>>& outside() const { return outside_; }
    std::size_t bytes() const { return place_.bytes() + in_world_.bytes() + here_.bytes(); }

    // Sets the values at the first `count` of the points at `position` [m], about the head and in its axes, which are
    // `head`; the head is at `nose` [m] in the world. Rates are those at a point that moves with the current.
    void set(const Water& water, double time, const Vector3<double>& nose, const Frame<M, double>& head,
             const Field<Vector<M, double>>& position, std::size_t count)
    {
        const std::size_t blocks = blocks_of(count);
        if (place_.stride() != position.stride()) {
            place_ = Field<Vector3<double>>(blocks), in_world_ = Field<WaterAt<double>>(blocks);
            here_ = Field<FlowSample<M, double>>(blocks);
        }
        const auto alone = [&](const auto& each) { return set_alone(each, water, time, nose, head, position); };
        if (water.flow->sources.size() == 1 && std::visit(alone, water.flow->sources.front())) return;
        for (std::size_t k = 0; k < blocks; ++k) place_.store(k, placed(nose, head.parent(position[k])));
        WaterAt<double> at_nose{};
        bool first = true;
        known_ = true;
        for (const auto& source : water.flow->sources) {
            std::visit([&](const auto& each) { add(each, time, nose, count, first, at_nose); }, source);
            first = false;
        }
        for (std::size_t k = 0; k < blocks; ++k) here_.store(k, turned(in_world_[k], water.current, head));
        nose_ = turned(at_nose, water.current, head);
        if (known_) outside_.reset();
    }

  private:
    template <Number T>
    static Vector3<T> placed(const Vector3<double>& nose, const Vector3<T>& r)
    {
        return nose + r;
    }
    template <Number T>
    static Vector3<T> placed(const Vector3<double>& nose, const Vector2<T>& r)
    {
        return {nose.x + r.x, nose.y + r.y, T(nose.z)};
    }
    template <Number T>
    static FlowSample<M, T> turned(WaterAt<T> s, const Vector3<double>& current, const Frame<M, double>& head)
    {
        s.u_t += s.g.times(current);
        const FlowSample<M, T> part = part_in(M(), s);
        return {head.local(part.u), head.local(part.u_t), part.g.in(head)};
    }

    // Sets all at once from the only source; false where that is evaluated point by point.
    template <class Source>
    bool set_alone(const Source& source, const Water& water, double time, const Vector3<double>& nose,
                   const Frame<M, double>& head, const Field<Vector<M, double>>& position)
    {
        const auto& now = source.at(time);
        for (std::size_t k = 0; k < here_.stride() / width - 1; ++k)
            here_.store(k, turned(now(placed(nose, head.parent(position[k]))), water.current, head));
        nose_ = turned(now(nose), water.current, head);
        outside_.reset();
        return true;
    }
    bool set_alone(const GriddedFlow&, const Water&, double, const Vector3<double>&, const Frame<M, double>&,
                   const Field<Vector<M, double>>&)
    {
        return false;
    }
    bool set_alone(const FunctionFlow&, const Water&, double, const Vector3<double>&, const Frame<M, double>&,
                   const Field<Vector<M, double>>&)
    {
        return false;
    }

    template <class Source>
    void add(const Source& source, double time, const Vector3<double>& nose, std::size_t, bool first,
             WaterAt<double>& at_nose)
    {
        const auto& now = source.at(time);
        for (std::size_t k = 0; k < place_.stride() / width - 1; ++k) {
            WaterAt<Lanes> water = now(place_[k]);
            if (!first) water += in_world_[k];
            in_world_.store(k, water);
        }
        at_nose += now(nose);
    }
    void add(const GriddedFlow& source, double time, const Vector3<double>& nose, std::size_t count, bool first,
             WaterAt<double>& at_nose)
    {
        const auto now = source.at(time);
        const auto at = [&](const Vector3<double>& place) {
            const WaterAt<double> water = now(place);
            if (std::isnan(water.u.x)) {
                const bool first_unknown = known_ && !std::isnan(place.x + place.y + place.z);  // else it has diverged
                if (first_unknown) outside_ = {time, place.x, place.y, place.z};
                known_ = false;
            }
            return water;
        };
        add_each([&](std::size_t i) { return at(place_.node(i)); }, count, first);
        at_nose += at(nose);
    }
    void add(const FunctionFlow& source, double time, const Vector3<double>& nose, std::size_t count, bool first,
             WaterAt<double>& at_nose)
    {
        constexpr std::size_t columns = FunctionFlow::columns;
        rows_.assign(columns * (count + 1), 0.0);
        for (std::size_t i = 0; i <= count; ++i)
            Components<Vector3<double>>::each(i < count ? place_.node(i) : nose,
                                              [&](std::size_t c, double value) { rows_[columns * i + c] = value; });
        source.function(time, rows_);
        const auto row = [&](std::size_t i) {
            return Components<WaterAt<double>>::make([&](std::size_t c) { return rows_[columns * i + 3 + c]; });
        };
        add_each(row, count, first);
        at_nose += row(count);
    }

    // Adds the water that `row` gives at each of the `count` points, one by one; behind the last point as there.
    template <class Row>
    void add_each(const Row& row, std::size_t count, bool first)
    {
        for (std::size_t i = 0; i + width < place_.stride(); ++i)
            Components<WaterAt<double>>::each(row(std::min(i, count - 1)), [&](std::size_t c, double value) {
                double& sum = in_world_.row(c)[i];
                sum = first ? value : sum + value;
            });
    }

    Field<Vector3<double>> place_;  // [m], in the world
    Field<WaterAt<double>> in_world_;
    Field<FlowSample<M, double>> here_;
    FlowSample<M, double> nose_{};
    std::vector<double> rows_;
    std::optional<std::array<double, 4>> outside_;
    bool known_ = true;
};

}  // namespace eel_core
