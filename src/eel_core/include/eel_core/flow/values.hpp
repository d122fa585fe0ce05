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
    // Time [s] and place [m] in the world of the last evaluation where the flow is unknown: outside a grid.
    const std::optional<std::array<double, 4>>& outside() const { return outside_; }

    // Sets the values at the first `count` of the points at `position` [m], about the head and in its axes, which are
    // `head`; the head is at `nose` [m] in the world. Rates are those at a point that moves with the current.
    void set(const Water& water, double time, const Vector3<double>& nose, const Frame<M, double>& head,
             const Field<Vector<M, double>>& position, std::size_t count)
    {
        const std::size_t blocks = blocks_of(count);
        if (here_.stride() != position.stride()) here_ = Field<FlowSample<M, double>>(blocks);
        const View<M> view{nose, head, water.current};
        known_ = true;
        for (const auto& source : water.flow->sources) {
            const bool first = &source == &water.flow->sources.front();
            std::visit([&](const auto& each) { add(each, time, view, position, count, first); }, source);
        }
        if (known_) outside_.reset();
    }

  private:
    // Adds a source, or sets the values to it.
    void add(const auto& source, double time, const View<M>& view, const Field<Vector<M, double>>& position,
             std::size_t, bool first)
    {
        const auto now = source.at(time, view);
        put([&](std::size_t k) { return now(position[k]); }, now(Vector<M, double>{}), first);
    }
    void add(const GriddedFlow& source, double time, const View<M>& view, const Field<Vector<M, double>>& position,
             std::size_t count, bool first)
    {
        const auto now = source.at(time, view);
        find_places(view, position);
        const auto at = [&](const Vector3<double>& place) {
            const WaterAt<double> water = now(place);
            if (std::isnan(water.u.x)) {
                const bool first_unknown =
                    known_ && !std::isnan(place.x + place.y + place.z);  // otherwise the motion has diverged
                if (first_unknown) outside_ = {time, place.x, place.y, place.z};
                known_ = false;
            }
            return water;
        };
        put_each([&](std::size_t i) { return at(place_.node(i)); }, at(view.nose), view, count, first);
    }
    void add(const FunctionFlow& source, double time, const View<M>& view, const Field<Vector<M, double>>& position,
             std::size_t count, bool first)
    {
        constexpr std::size_t columns = FunctionFlow::columns;
        find_places(view, position);
        rows_.assign(columns * (count + 1), 0.0);
        for (std::size_t i = 0; i <= count; ++i)
            Components<Vector3<double>>::each(i < count ? place_.node(i) : view.nose,
                                              [&](std::size_t c, double value) { rows_[columns * i + c] = value; });
        source.function(time, rows_);
        const auto row = [&](std::size_t i) { return water_in(&rows_[columns * i]); };
        put_each(row, row(count), view, count, first);
    }

    // Adds the result of `block` for each block of points, and the water at the nose; or sets the values to them.
    void put(const auto& block, const FlowSample<M, double>& at_nose, bool first)
    {
        for (std::size_t k = 0; k < here_.stride() / width - 1; ++k) {
            FlowSample<M, Lanes> water = block(k);
            if (!first) water += here_[k];
            here_.store(k, water);
        }
        if (first)
            nose_ = at_nose;
        else
            nose_ += at_nose;
    }

    // The same with the result of `row` in the world at each of the `count` points; padding as the last point.
    void put_each(const auto& row, const WaterAt<double>& at_nose, const View<M>& view, std::size_t count, bool first)
    {
        for (std::size_t i = 0; i + width < place_.stride(); ++i)
            Components<WaterAt<double>>::each(row(std::min(i, count - 1)),
                                              [&](std::size_t c, double value) { in_world_.row(c)[i] = value; });
        put([&](std::size_t k) { return turned(in_world_[k], view); }, turned(at_nose, view), first);
    }

    template <Number T>
    static FlowSample<M, T> turned(WaterAt<T> s, const View<M>& view)
    {
        s.u_t += s.g.times(view.current);
        const FlowSample<M, T> part = part_in(M(), s);
        return {view.head.local(part.u), view.head.local(part.u_t), part.g.in(view.head)};
    }

    // The points in the world.
    void find_places(const View<M>& view, const Field<Vector<M, double>>& position)
    {
        if (place_.stride() != position.stride())
            place_ = Field<Vector3<double>>(position.stride() / width - 1),
            in_world_ = Field<WaterAt<double>>(position.stride() / width - 1);
        for (std::size_t k = 0; k < place_.stride() / width - 1; ++k) {
            const auto at = view.head.parent(position[k]);
            if constexpr (M::planar)
                place_.store(k, {view.nose.x + at.x, view.nose.y + at.y, Lanes(view.nose.z)});
            else
                place_.store(k, view.nose + at);
        }
    }

    Field<Vector3<double>> place_;     // [m], in the world, for sources evaluated point by point
    Field<WaterAt<double>> in_world_;  // of such a source
    Field<FlowSample<M, double>> here_;
    FlowSample<M, double> nose_{};
    std::vector<double> rows_;
    std::optional<std::array<double, 4>> outside_;
    bool known_ = true;
};

}  // namespace eel_core
