// SPDX-License-Identifier: Apache-2.0
// The Python class of many swimmers, each driven by a controller's samples.
#pragma once

#include <memory>

#include "bound_march.hpp"
#include "eel_core/march/sampled_march.hpp"

namespace eel_core {

inline SampleWeights weights_from(const py::object& weights)
{
    const Numbers numbers(weights, "weights");
    const std::size_t points = numbers.length(0), columns = numbers.length(1);
    return {points, columns, std::vector<double>(numbers.data(), numbers.data() + points * columns)};
}

// As `SampledMarches`, for Python: one thread at a time, without Python's lock.
class PySampledMarches {
  public:
    PySampledMarches(const std::shared_ptr<const Swimmer>& swimmer, const std::string& method, std::size_t order,
                     bool planar, bool ledger, const py::object& current, const py::object& weights, double transition,
                     std::size_t count, std::size_t threads)
        : marches_(kind_of(swimmer, Method::of(method, order), planar, ledger, current, weights, transition),
                   checked(count, most_swimmers, "count"), checked(threads, most_threads, "threads"))
    {
    }

    double start(std::size_t index, const std::shared_ptr<StepBounds>& bounds, const py::object& position,
                 const py::object& orientation, const py::object& twist, const py::object& values,
                 std::shared_ptr<Flow> flow)
    {
        const Numbers sample = Numbers::sized(values, "values", sample_rows * marches_.points());
        const InUse in_use(in_use_, these);
        check_flow(flow.get());
        return marches_[index].start(*bounds, vector_from(position, "position"), orientation_from(orientation),
                                     twist_from(twist, "twist"), sample.data(), std::move(flow));
    }
    void wake() { marches_.wake(); }
    // Whether all that are not left out have marched.
    bool advance(const py::object& times, const py::object& values, const py::object& status, const py::object& heads)
    {
        const std::size_t n = marches_.size();
        const Numbers instants = Numbers::sized(times, "times", n), into = Numbers::sized(heads, "heads", 13 * n, true),
                      samples = Numbers::sized(values, "values", n * sample_rows * marches_.points());
        const auto found = Array<std::int64_t>::sized(status, "status", n, true);
        const InUse in_use(in_use_, these);
        for (std::size_t i = 0; i < n; ++i)
            if (found.data()[i] >= 0) begun(i), check_finite({instants.data() + i, 1}, "times");
        const py::gil_scoped_release unlocked;
        marches_.advance(instants.data(), samples.data(), found.data(), into.data());
        return std::all_of(found.data(), found.data() + n, [](std::int64_t each) { return each <= 0; });
    }
    bool put_head(std::size_t index, const py::object& heads)
    {
        const Numbers into = Numbers::sized(heads, "heads", 13 * marches_.size(), true);
        const InUse in_use(in_use_, these);
        begun(index);
        return marches_.put_head(index, into.data());
    }
    bool observe(std::size_t index, const py::object& whole, bool wrench, bool load)
    {
        const InUse in_use(in_use_, these);
        March& march = begun(index);
        const Swimmer& swimmer = march.swimmer();
        const Profiles profiles(1, swimmer.shown, wrench, load, 0, swimmer.sensors());
        const Numbers into = Numbers::sized(whole, "whole", profiles.begin[Profiles::quantities], true);
        return march.observe(profiles, into.data(), 0, nullptr);
    }
    // All that goes on, as bytes.
    py::bytes state_as_bytes()
    {
        const InUse in_use(in_use_, these);
        Writer writer;
        marches_.pass(writer);
        return writer.finished();
    }
    // `flows`: as those of the starts.
    void set_state_from_bytes(const py::bytes& state, const std::vector<std::shared_ptr<Flow>>& flows)
    {
        const InUse in_use(in_use_, these);
        for (const std::shared_ptr<Flow>& flow : flows) check_flow(flow.get());
        Reader reader{std::string_view(state)};
        marches_.pass(reader, flows);
    }
    // Of one swimmer: time, works, and counts as of `March`.
    std::tuple<double, WorkDone, std::tuple<std::int64_t, std::int64_t, std::int64_t>> present(std::size_t index)
    {
        const InUse in_use(in_use_, these);
        const March& march = marches_[index].march();
        return std::tuple(march.now().time, march.now().works, tuple_of(march.counts()));
    }

  private:
    static constexpr const char* these = "these marches are";
    static constexpr std::size_t most_swimmers = 100'000, most_threads = 1000;

    static std::size_t checked(std::size_t count, std::size_t most, const char* name)
    {
        check_count(count, 1, most, name);
        return count;
    }
    // The march of a swimmer that stands at its start, or swims.
    March& begun(std::size_t index)
    {
        if (index >= marches_.size())
            throw py::index_error("index must be below " + std::to_string(marches_.size()) + ", got " +
                                  std::to_string(index));
        if (!marches_[index].begun())
            throw std::runtime_error("swimmer " + std::to_string(index) + " has no start yet");
        return marches_[index].march();
    }
    static void check_flow(const Flow* flow)
    {
        for (std::size_t i = 0; flow && i < flow->sources.size(); ++i)
            if (std::holds_alternative<FunctionFlow>(flow->sources[i]))
                throw py::value_error("flow must have no function of Python");
    }

    static std::shared_ptr<const SampledKind> kind_of(const std::shared_ptr<const Swimmer>& swimmer,
                                                      const Method& method, bool planar, bool ledger,
                                                      const py::object& current, const py::object& weights,
                                                      double transition)
    {
        auto kind = std::make_shared<const SampledKind>(SampledKind{
            swimmer, method, planar, ledger, vector_from(current, "current"), weights_from(weights), transition});
        const std::size_t wanted = 4 * (swimmer->grid.nodes + swimmer->stations);
        if (kind->weights.columns != wanted)
            throw py::value_error("weights must have " + std::to_string(wanted) + " columns, got " +
                                  std::to_string(kind->weights.columns));
        return kind;
    }

    SampledMarches marches_;
    std::atomic<bool> in_use_{false};
};

inline void bind_sampled_marches(py::module_& module)
{
    module.def(
        "tabulate",
        [](const py::object& weights, const py::object& values, const py::object& rows) {
            const Numbers by_point(weights, "weights");
            const std::size_t points = by_point.length(0), columns = by_point.length(1);
            const Numbers from = Numbers::sized(values, "values", sample_rows * points),
                          into = Numbers::sized(rows, "rows", sample_rows * columns, true);
            for (const std::size_t row : {std::size_t{0}, rows_of_axis})
                tabulate(by_point.data(), points, columns, from.data() + row * points, into.data() + row * columns);
        },
        py::arg("weights"), py::arg("values"), py::arg("rows"));

    py::class_<PySampledMarches, std::shared_ptr<PySampledMarches>>(module, "SampledMarches")
        .def(py::init<std::shared_ptr<Swimmer>, const std::string&, std::size_t, bool, bool, const py::object&,
                      const py::object&, double, std::size_t, std::size_t>(),
             needed("swimmer"), py::kw_only(), py::arg("method"), py::arg("order"), py::arg("planar"),
             py::arg("ledger"), py::arg("current"), py::arg("weights"), py::arg("transition"), py::arg("count"),
             py::arg("threads"))
        .def("start", method(&PySampledMarches::start), py::arg("index"), needed("bounds"), py::arg("position"),
             py::arg("orientation"), py::arg("twist"), py::arg("values"), py::arg("flow") = py::none())
        .def("wake", method(&PySampledMarches::wake))
        .def("advance", method(&PySampledMarches::advance), py::arg("times"), py::arg("values"), py::arg("status"),
             py::arg("heads"))
        .def("put_head", method(&PySampledMarches::put_head), py::arg("index"), py::arg("heads"))
        .def("observe", method(&PySampledMarches::observe), py::arg("index"), py::arg("whole"), py::arg("wrench"),
             py::arg("load"))
        .def("state_as_bytes", method(&PySampledMarches::state_as_bytes))
        .def("set_state_from_bytes", method(&PySampledMarches::set_state_from_bytes), py::arg("state"),
             py::arg("flows"))
        .def("present", method(&PySampledMarches::present), py::arg("index"));
}

}  // namespace eel_core
