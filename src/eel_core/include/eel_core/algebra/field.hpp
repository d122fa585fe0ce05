// SPDX-License-Identifier: Apache-2.0
// Fields along the body: numbers, vectors or frames at the nodes, with each component in a row of its own.
#pragma once

#include <vector>

#include "eel_core/algebra/motion.hpp"

namespace eel_core {

inline std::size_t blocks_of(std::size_t nodes) { return (nodes + filled - 1) / filled * (filled / width); }

// A field of numbers, of vectors, ...: `Value` is the value at one node, `Block` the values at `width` neighbouring
// nodes. There is padding after the last node, so that a block can be read from any node on.
template <class Value>
class Field {
  public:
    using Block = With<Value, Lanes>;

    Field() = default;
    explicit Field(std::size_t blocks) : stride_(width * (blocks + 1)), rows_(Components<Block>::count * stride_) {}

    EEL_CORE_INLINE Block operator[](std::size_t block) const { return from(width * block); }
    EEL_CORE_INLINE Block from(std::size_t node) const
    {
        return Components<Block>::make([&](std::size_t k) { return Lanes::load(row(k) + node); });
    }
    Value node(std::size_t node) const
    {
        return Components<Value>::make([&](std::size_t k) { return row(k)[node]; });
    }
    void store(std::size_t block, const Block& value) { store_from(width * block, value); }
    void store_from(std::size_t node, const Block& value)
    {
        Components<Block>::each(value, [&](std::size_t k, Lanes lanes) { lanes.store(row(k) + node); });
    }
    double* row(std::size_t component) { return rows_.data() + component * stride_; }
    const double* row(std::size_t component) const { return rows_.data() + component * stride_; }
    std::size_t stride() const { return stride_; }

  private:
    std::size_t stride_ = 0;
    std::vector<double, Aligned<double>> rows_;
};

using Row = Field<double>;

}  // namespace eel_core
