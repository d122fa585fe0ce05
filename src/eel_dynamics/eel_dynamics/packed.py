"""What a compiled loop takes, as one row of words: of each array its address and its shape, of each number its bits.

To hand an array over to a compiled loop costs as much as a good part of an evaluation, and a run has more than a
hundred. A row is one array, and rows of many runs are one table.

    form = Form(lambda: value)          # of a NamedTuple of arrays and numbers, nested or not, of the type of `value`
    packed = form.packed(value)         # keeps the arrays alive whose addresses are in packed.row
    space = Layout(form, value).space() # the same in memory of its own: space.row, space.views
    open_it = form.opener()             # for compiled loops: open_it(row) is the NamedTuple
"""

import struct
from collections.abc import Callable
from ctypes import addressof, c_char
from functools import cached_property
from itertools import count

import numpy as np
from numba import typeof, types
from numba.core.cgutils import ir
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

from .lanes import ALIGNMENT, aligned_zeros

_BYTES = c_char * 0  # by far the quickest way to an address
WORD = 8  # bytes, of every number in an array
KINDS = "dlL"  # of arrays, numpy's letters: float64, int64, uintp


def address_of(array: np.ndarray) -> int:
    """Where the numbers of a contiguous array begin in memory."""
    return addressof(_BYTES.from_buffer(array))


class Form:
    """How NamedTuples of one type lie in a row. `example()` makes one of them, when it is first needed."""

    def __init__(self, example: Callable):
        self._example = example

    def __deepcopy__(self, memo):
        return self

    @cached_property
    def example(self):
        """One of the NamedTuples."""
        return self._example()

    @cached_property
    def _nested(self) -> bool:
        return any(isinstance(each, tuple) for each in self.example)

    @cached_property
    def _letters(self) -> list[str | None]:
        """Of each array numpy's letter, None of a number."""
        return [leaf.dtype.char if isinstance(leaf, np.ndarray) else None for leaf in _leaves(self.example)]

    @cached_property
    def _struct(self) -> struct.Struct:
        return struct.Struct("".join(_format(leaf) for leaf in _leaves(self.example)))

    @property
    def words(self) -> int:
        """Length of a row."""
        return self._struct.size // WORD

    @cached_property
    def places(self) -> dict[str, slice]:
        """Where each field lies in a row."""
        places, begin = {}, 0
        for name, value in zip(self.example._fields, self.example, strict=True):
            end = begin + sum(len(_format(leaf)) for leaf in _leaves((value,)))
            places[name], begin = slice(begin, end), end
        return places

    def row(self, value) -> np.ndarray:
        """The row (words,) of a `value`; whoever uses it keeps the value's arrays alive. `TypeError` for a value of
        another form."""
        words = []
        for leaf, letter in zip(_leaves(value) if self._nested else value, self._letters, strict=True):
            if letter is None:
                words.append(leaf)
                continue
            if leaf.dtype.char != letter:
                raise TypeError(f"array must be of type {letter!r}, got {leaf.dtype.char!r}")
            words += (address_of(leaf), *leaf.shape)
        try:
            return np.frombuffer(self._struct.pack(*words), dtype=np.int64)
        except struct.error as error:
            raise TypeError(f"value must be of the form {self._struct.format!r}: {error}") from None

    def packed(self, value) -> "Packed":
        """A `value` with its row."""
        return Packed(self, value)

    def opener(self, field: str | None = None):
        """For compiled loops: a function that makes the NamedTuple of a row, or a `field` of it that is one."""
        form = self

        @intrinsic
        def opened(typingctx, row):
            """The NamedTuple."""
            result = typeof(getattr(form.example, field) if field else form.example)
            begin = form.places[field].start if field else 0

            def lowering(context, builder, sig, args):
                words, places = context.make_array(sig.args[0])(context, builder, args[0]).data, count(begin)

                def word():
                    return builder.load(builder.gep(words, [ir.Constant(ir.IntType(64), next(places))]))

                return _opened(context, builder, result, word)

            return result(row), lowering

        return opened


class _Placed:
    """What knows where its arrays are: a copy, whose arrays are elsewhere, has to look again."""

    def __getstate__(self):
        return {name: value for name, value in self.__dict__.items() if name not in ("row", "views")}


class Packed(_Placed):
    """A value and its row."""

    def __init__(self, form: Form, value):
        self._form, self.value = form, value

    @cached_property
    def row(self) -> np.ndarray:
        """(words,) int64; good for as long as this is."""
        return self._form.row(self.value)


class Layout:
    """Where the arrays of a NamedTuple `value` lie in one piece of memory."""

    def __init__(self, form: Form, value):
        self._value, self._begins, end = value, [], 0
        for leaf in _arrays(value):
            self._begins.append(end)
            end += -(-leaf.size * WORD // ALIGNMENT) * ALIGNMENT // WORD
        self._memory = aligned_zeros(end)
        for leaf, begin in zip(_arrays(value), self._begins, strict=True):
            self._memory[begin : begin + leaf.size] = leaf.ravel().view(np.float64)
        self._row, self._moves = relative(form, self.views(self._memory), self._memory)

    def __deepcopy__(self, memo):
        return self

    def space(self) -> "Space":
        """Memory of its own, with the numbers of the value."""
        memory = aligned_zeros(len(self._memory))
        memory[:] = self._memory
        return Space(self, memory)

    def row(self, memory: np.ndarray) -> np.ndarray:
        """The row (words,) of the value in such a `memory`."""
        return self._row + address_of(memory) * self._moves

    def views(self, memory: np.ndarray):
        """The value, of views of such a `memory`."""
        arrays = (_view(memory, *each) for each in zip(_arrays(self._value), self._begins, strict=True))
        return _rebuilt(self._value, arrays)

    def view(self, memory: np.ndarray, name: str) -> np.ndarray:
        """The array `name` of the value, not of what is nested in it, as a view of such a `memory`."""
        wanted = getattr(self._value, name)
        index = next(k for k, leaf in enumerate(_arrays(self._value)) if leaf is wanted)
        return _view(memory, wanted, self._begins[index])


class Space(_Placed):
    """Memory of a layout."""

    def __init__(self, layout: Layout, memory: np.ndarray):
        self._layout, self._memory = layout, memory

    @cached_property
    def row(self) -> np.ndarray:
        """(words,) int64; good for as long as this is."""
        return self._layout.row(self._memory)

    @cached_property
    def views(self):
        """The NamedTuple, of views."""
        return self._layout.views(self._memory)

    def view(self, name: str) -> np.ndarray:
        """One array of it, for less."""
        return self._layout.view(self._memory, name)


def _leaves(value):
    for each in value:
        if isinstance(each, tuple):
            yield from _leaves(each)
        else:
            yield each


def _arrays(value):
    return (leaf for leaf in _leaves(value) if isinstance(leaf, np.ndarray))


def _format(leaf) -> str:
    """The words of a leaf, as `struct` names them."""
    if isinstance(leaf, np.ndarray) and leaf.dtype.char in KINDS:
        return "Q" + "q" * leaf.ndim
    if isinstance(leaf, float):
        return "d"
    if isinstance(leaf, (int, np.integer)):
        return "q"
    raise TypeError(f"what is packed must be arrays of eight-byte numbers, whole numbers or floats, got {leaf!r}")


def relative(form: Form, value, memory: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Row (words,) of a `value` whose arrays lie in the `memory`, by where it begins; and 1 for each of the words that
    is an address, else 0."""
    moves, begin = np.zeros(form.words, dtype=np.int64), 0
    for leaf in _leaves(value):
        moves[begin] = isinstance(leaf, np.ndarray)
        begin += len(_format(leaf))
    return form.row(value) - address_of(memory) * moves, moves


def _view(memory, like, begin):
    return memory[begin : begin + like.size].view(like.dtype).reshape(like.shape)


def _rebuilt(value, arrays):
    if isinstance(value, tuple):
        return type(value)(*(_rebuilt(each, arrays) for each in value))
    return next(arrays) if isinstance(value, np.ndarray) else value


def _opened(context, builder, kind, word):
    """A value of the type `kind`, of the next words."""
    if isinstance(kind, types.BaseTuple):
        return context.make_tuple(builder, kind, [_opened(context, builder, each, word) for each in kind.types])
    if isinstance(kind, types.Array):
        return _array(context, builder, kind, [word() for _ in range(1 + kind.ndim)])
    if kind == types.float64:
        return builder.bitcast(word(), ir.DoubleType())
    return context.cast(builder, word(), types.int64, kind)


def _array(context, builder, kind, words):
    begin, *shape = words
    array = context.make_array(kind)(context, builder)
    data = builder.inttoptr(begin, context.get_data_type(kind.dtype).as_pointer())
    stride, strides = ir.Constant(ir.IntType(64), WORD), []
    for size in reversed(shape):
        strides.insert(0, stride)
        stride = builder.mul(stride, size)
    populate_array(array, data, shape, strides, ir.Constant(ir.IntType(64), WORD), meminfo=None)
    return array._getvalue()
