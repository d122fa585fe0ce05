"""The arrays of a NamedTuple in one piece of memory, which the compiled loops open by themselves.

To hand an array over to a compiled loop costs as much as a good part of an evaluation, and a run has more than a
hundred. Packed, they are two.

    layout = Layout(value)              # of a NamedTuple of arrays and numbers, nested or not
    space = layout.space()              # memory of its own, with the same numbers
    space.views.fields.r                # as Python sees it
    loop(space.packed)                  # what a compiled loop takes; it opens that by opener(lambda: value)
"""

from collections.abc import Callable
from functools import cached_property
from itertools import count
from typing import NamedTuple

import numpy as np
from numba import typeof, types
from numba.core import cgutils
from numba.core.cgutils import ir
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

from .lanes import ALIGNMENT, aligned_zeros

WORD = 8  # bytes, of every number in an array


class Packed(NamedTuple):
    """What a compiled loop takes."""

    memory: np.ndarray  # (w,) the arrays, one behind the other; whole numbers by their bits
    table: np.ndarray  # (.,) int64: of each array where it begins in the memory, and its shape; of each number its bits


class Layout:
    """Where the arrays of a NamedTuple `value` lie in one piece of memory; their numbers take eight bytes each."""

    def __init__(self, value):
        self._value, self._begins, table, words = value, [], [], 0
        for leaf in _leaves(value):
            if isinstance(leaf, np.ndarray):
                self._begins.append(words)
                table += [words, *leaf.shape]
                words += -(-leaf.size * WORD // ALIGNMENT) * ALIGNMENT // WORD
            elif isinstance(leaf, float):
                table.append(int(np.float64(leaf).view(np.int64)))
            elif isinstance(leaf, (int, np.integer)):
                table.append(int(leaf))
            else:
                raise TypeError(f"what is packed must be arrays, whole numbers or floats, got {leaf!r}")
        self.packed = Packed(aligned_zeros(words), np.array(table, dtype=np.int64))
        for leaf, begin in zip(_arrays(value), self._begins, strict=True):
            self.packed.memory[begin : begin + leaf.size] = leaf.ravel().view(np.float64)

    def space(self) -> "Space":
        """Memory of its own, with the numbers of the value."""
        memory = aligned_zeros(len(self.packed.memory))
        memory[:] = self.packed.memory
        return Space(self, Packed(memory, self.packed.table))

    def views(self, memory: np.ndarray):
        """The value, of views of such a `memory`."""
        arrays = (_view(memory, *each) for each in zip(_arrays(self._value), self._begins, strict=True))
        return _rebuilt(self._value, arrays)

    def view(self, memory: np.ndarray, name: str) -> np.ndarray:
        """The array `name` of the value, not of what is nested in it, as a view of such a `memory`."""
        wanted = getattr(self._value, name)
        index = next(k for k, leaf in enumerate(_arrays(self._value)) if leaf is wanted)
        return _view(memory, wanted, self._begins[index])


class Space:
    """Memory of a layout."""

    def __init__(self, layout: Layout, packed: Packed):
        self._layout, self.packed = layout, packed

    def __getstate__(self):  # a copy's views are of its own memory
        return {"_layout": self._layout, "packed": self.packed}

    @cached_property
    def views(self):
        """The NamedTuple, of views."""
        return self._layout.views(self.packed.memory)

    def view(self, name: str) -> np.ndarray:
        """One array of it, for less."""
        return self._layout.view(self.packed.memory, name)


def _leaves(value):
    if isinstance(value, tuple):
        for each in value:
            yield from _leaves(each)
    else:
        yield value


def _arrays(value):
    return (leaf for leaf in _leaves(value) if isinstance(leaf, np.ndarray))


def _view(memory, like, begin):
    return memory[begin : begin + like.size].view(like.dtype).reshape(like.shape)


def _rebuilt(value, arrays):
    if isinstance(value, tuple):
        return type(value)(*(_rebuilt(each, arrays) for each in value))
    return next(arrays) if isinstance(value, np.ndarray) else value


def opener(example: Callable):
    """For compiled loops: a function that makes a NamedTuple, of the type of `example()`, of what it is packed into."""

    @intrinsic
    def opened(typingctx, packed):
        """The NamedTuple."""
        result = typeof(example())

        def lowering(context, builder, sig, args):
            memory, table = (
                context.make_array(kind)(context, builder, array).data
                for kind, array in zip(sig.args[0].types, cgutils.unpack_tuple(builder, args[0]), strict=True)
            )
            places = count()

            def word():
                return builder.load(builder.gep(table, [ir.Constant(ir.IntType(64), next(places))]))

            def opened_as(kind):
                if isinstance(kind, types.BaseTuple):
                    return context.make_tuple(builder, kind, [opened_as(each) for each in kind.types])
                if isinstance(kind, types.Array):
                    return _array(context, builder, kind, memory, [word() for _ in range(1 + kind.ndim)])
                if kind == types.float64:
                    return builder.bitcast(word(), ir.DoubleType())
                return context.cast(builder, word(), types.int64, kind)

            return opened_as(result)

        return result(packed), lowering

    return opened


def _array(context, builder, kind, memory, words):
    begin, *shape = words
    array = context.make_array(kind)(context, builder)
    data = builder.bitcast(builder.gep(memory, [begin]), context.get_data_type(kind.dtype).as_pointer())
    stride, strides = ir.Constant(ir.IntType(64), WORD), []
    for size in reversed(shape):
        strides.insert(0, stride)
        stride = builder.mul(stride, size)
    populate_array(array, data, shape, strides, ir.Constant(ir.IntType(64), WORD), meminfo=None)
    return array._getvalue()
