"""Eight numbers side by side, as a type of the compiled loops: what a processor does at once (SIMD), said plainly.

    v = take(array, k, i)        # the eight numbers array[k, i : i + 8]
    put(array, k, i, a * v + b)  # and back
    total(v), last(v), where(v > 0.0, v, -v), any_of(v < 0.0)

Arithmetic is that of the numbers, lane by lane; a plain number beside lanes counts for all of them. LLVM turns it into
the widest instructions of the processor: one of 512 bits, two of 256, four of 128. Arrays along the body are as long as
`padded` says, with zero weights behind the last node, so that no loop has a remainder.
"""

import math
import operator
from typing import NamedTuple

import numpy as np
from numba import types
from numba.core import cgutils
from numba.core.cgutils import ir
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

WIDTH = 8
ALIGNMENT = 64  # bytes

_REAL, _INDEX, _BIT = ir.DoubleType(), ir.IntType(64), ir.IntType(1)
_VECTOR, _BITS, _INTEGERS = (ir.VectorType(each, WIDTH) for each in (_REAL, _BIT, _INDEX))


class _Lanes(types.Type):
    def __init__(self):
        super().__init__(name="lanes")


class _Mask(types.Type):
    def __init__(self):
        super().__init__(name="lanes_mask")


LANES, MASK = _Lanes(), _Mask()


@register_model(_Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _VECTOR)


@register_model(_Mask)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _BITS)


def padded(nodes: int) -> int:
    """Length of an array over `nodes` nodes from any of which eight can be taken."""
    return WIDTH * -(-(nodes + WIDTH - 1) // WIDTH)


def aligned_zeros(*shape: int) -> np.ndarray:
    """Zeros that begin where eight numbers are loaded at once."""
    count = math.prod(shape)
    space = np.zeros(count + ALIGNMENT // 8)
    start = -space.__array_interface__["data"][0] % ALIGNMENT // 8
    return space[start : start + count].reshape(shape)


def aligned(values, length: int | None = None) -> np.ndarray:
    """A copy of `values` (..., n) with zeros behind, up to `length`."""
    values = np.asarray(values, dtype=float)
    result = aligned_zeros(*values.shape[:-1], length or padded(values.shape[-1]))
    result[..., : values.shape[-1]] = values
    return result


def work_space(sizes: tuple[tuple[int, ...], ...], nodes: int):
    """Zeros (*size, n) for each of the `sizes`, of `nodes` nodes and those that fill them up, in one piece."""
    length, counts = padded(nodes), [math.prod(size) for size in sizes]
    rows, begin = aligned_zeros(sum(counts), length), 0
    for size, count in zip(sizes, counts, strict=True):
        part = rows[begin : begin + count]
        yield part if len(size) == 1 else part.reshape(*size, length)
        begin += count


# -- arithmetic


def _vector(context, builder, kind, value):
    return value if kind == LANES else _spread(builder, value)


def _spread(builder, value):
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
    return builder.shuffle_vector(first, ir.Constant(_VECTOR, ir.Undefined), zeros)


def _binary(symbol, build, result):
    @infer_global(symbol)
    class Typing(AbstractTemplate):
        def generic(self, args, kws):
            if len(args) != 2 or LANES not in args or kws:
                return None
            if all(each == LANES or isinstance(each, types.Number) for each in args):
                return signature(result, *(LANES if each == LANES else types.float64 for each in args))
            return None

    def lowering(context, builder, sig, args):
        left, right = (_vector(context, builder, kind, value) for kind, value in zip(sig.args, args, strict=True))
        return build(builder, left, right)

    for kinds in ((LANES, LANES), (LANES, types.float64), (types.float64, LANES)):
        lower_builtin(symbol, *kinds)(lowering)


for _name, _instruction in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
    for _symbol in (getattr(operator, _name), getattr(operator, f"i{_name}")):
        _binary(_symbol, lambda builder, a, b, name=_instruction: getattr(builder, name)(a, b), LANES)
for _symbol, _name in ((operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">=")):
    _binary(_symbol, lambda builder, a, b, name=_name: builder.fcmp_ordered(name, a, b), MASK)


@infer_global(operator.neg)
class _Negative(AbstractTemplate):
    def generic(self, args, kws):
        return signature(LANES, LANES) if args == (LANES,) else None


@lower_builtin(operator.neg, LANES)
def _negate(context, builder, sig, args):
    return builder.fsub(ir.Constant(_VECTOR, [-0.0] * WIDTH), args[0])


# -- from and to arrays


def _place(context, builder, array_type, array, kinds, index):
    array = context.make_array(array_type)(context, builder, array)
    index = [context.cast(builder, value, kind, types.intp) for kind, value in zip(kinds, index, strict=True)]
    shape = cgutils.unpack_tuple(builder, array.shape, array_type.ndim)
    strides = cgutils.unpack_tuple(builder, array.strides, array_type.ndim)
    pointer = cgutils.get_item_pointer2(context, builder, array.data, shape, strides, array_type.layout, index)
    return builder.bitcast(pointer, _VECTOR.as_pointer())


def take(array, *index):
    """Eight numbers of the `array` (contiguous, float64) from `index` on, along its last axis."""
    raise NotImplementedError("only in compiled loops")


def put(array, *index_and_value):
    """Store the value, given last, as eight numbers of the `array` from the index on."""
    raise NotImplementedError("only in compiled loops")


class Each(NamedTuple):
    """Numbers that count for eight swimmers each: taken from 8 i on, number i in all lanes."""

    value: np.ndarray


def _is_each(kind) -> bool:
    return getattr(kind, "instance_class", None) is Each


@infer_global(take)
class _Taking(AbstractTemplate):
    def generic(self, args, kws):
        return signature(LANES, *args)


@infer_global(put)
class _Putting(AbstractTemplate):
    def generic(self, args, kws):
        return signature(types.void, *args) if args[-1] == LANES else None


@lower_builtin(take, types.VarArg(types.Any))
def _take(context, builder, sig, args):
    if _is_each(sig.args[0]):
        index = builder.lshr(context.cast(builder, args[1], sig.args[1], types.int64), _INDEX(WIDTH.bit_length() - 1))
        array_type = sig.args[0].types[0]
        array = context.make_array(array_type)(context, builder, builder.extract_value(args[0], 0))
        return _spread(builder, builder.load(builder.gep(array.data, [index])))
    return builder.load(_place(context, builder, sig.args[0], args[0], sig.args[1:], args[1:]), align=8)


@lower_builtin(put, types.VarArg(types.Any))
def _put(context, builder, sig, args):
    builder.store(args[-1], _place(context, builder, sig.args[0], args[0], sig.args[1:-1], args[1:-1]), align=8)
    return context.get_dummy_value()


# -- between lanes


@intrinsic
def spread(typingctx, value):
    """The number in all lanes."""

    def lowering(context, builder, sig, args):
        return _spread(builder, args[0])

    return LANES(types.float64), lowering


@intrinsic
def last(typingctx, value):
    """The number in the last lane."""

    def lowering(context, builder, sig, args):
        return builder.extract_element(args[0], ir.Constant(ir.IntType(32), WIDTH - 1))

    return types.float64(LANES), lowering


@intrinsic
def first(typingctx, value):
    """The number in the first lane."""

    def lowering(context, builder, sig, args):
        return builder.extract_element(args[0], ir.Constant(ir.IntType(32), 0))

    return types.float64(LANES), lowering


@intrinsic
def following(typingctx, value):
    """In each lane the number of the next one; in the last its own."""

    def lowering(context, builder, sig, args):
        order = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [*range(1, WIDTH), WIDTH - 1])
        return builder.shuffle_vector(args[0], ir.Constant(_VECTOR, ir.Undefined), order)

    return LANES(LANES), lowering


@intrinsic
def total(typingctx, value):
    """Sum of the lanes."""

    def lowering(context, builder, sig, args):
        part, width = args[0], WIDTH
        while width > 1:
            width //= 2
            nothing = ir.Constant(part.type, ir.Undefined)
            halves = [
                builder.shuffle_vector(
                    part, nothing, ir.Constant(ir.VectorType(ir.IntType(32), width), list(range(start, start + width)))
                )
                for start in (0, width)
            ]
            part = builder.fadd(*halves)
        return builder.extract_element(part, ir.Constant(ir.IntType(32), 0))

    return types.float64(LANES), lowering


def _moved_by(lanes: int):
    @intrinsic
    def moved(typingctx, value, filling):
        """The lanes moved towards the end; the first ones are the `filling`."""

        def lowering(context, builder, sig, args):
            order = [WIDTH] * lanes + list(range(WIDTH - lanes))
            order = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), order)
            return builder.shuffle_vector(args[0], _spread(builder, args[1]), order)

        return LANES(LANES, types.float64), lowering

    return moved


moved1, moved2, moved4 = _moved_by(1), _moved_by(2), _moved_by(4)


# -- functions and choices


def _function(name: str):
    @intrinsic
    def function(typingctx, value):
        """Of each lane, or of a number."""
        kind = LANES if value == LANES else types.float64

        def lowering(context, builder, sig, args):
            form, ending = (_VECTOR, "v8f64") if sig.args[0] == LANES else (_REAL, "f64")
            kind = ir.FunctionType(form, [form])
            return builder.call(cgutils.get_or_insert_function(builder.module, kind, f"llvm.{name}.{ending}"), args)

        return kind(kind), lowering

    return function


root, size, floor = _function("sqrt"), _function("fabs"), _function("floor")


@intrinsic
def signed(typingctx, value, sign):
    """The size of `value` with the sign of `sign`."""

    def lowering(context, builder, sig, args):
        kind = ir.FunctionType(_VECTOR, [_VECTOR, _VECTOR])
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, "llvm.copysign.v8f64"), args)

    return LANES(LANES, LANES), lowering


@intrinsic
def fused(typingctx, a, b, c):
    """`a b + c` of plain numbers, and in this order: a compiler that may reorder has a recurrence wait for more."""
    real = types.float64

    def lowering(context, builder, sig, args):
        kind = ir.FunctionType(_REAL, [_REAL] * 3)
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, "llvm.fmuladd.f64"), args)

    return real(real, real, real), lowering


@intrinsic
def where(typingctx, mask, yes, no):
    """Lane by lane `yes` or `no`."""

    def lowering(context, builder, sig, args):
        return builder.select(*args)

    return LANES(MASK, LANES, LANES), lowering


@intrinsic
def bits(typingctx, mask):
    """The mask as a whole number, the first lane lowest."""

    def lowering(context, builder, sig, args):
        return builder.zext(builder.bitcast(args[0], ir.IntType(WIDTH)), _INDEX)

    return types.int64(MASK), lowering


@intrinsic
def lowest(typingctx, value):
    """Number of the lowest bit of a whole number that is not 0."""

    def lowering(context, builder, sig, args):
        return builder.cttz(args[0], ir.Constant(_BIT, 1))

    return types.int64(types.int64), lowering


@intrinsic
def any_of(typingctx, mask):
    """Whether it is so in any lane."""

    def lowering(context, builder, sig, args):
        return builder.icmp_unsigned("!=", builder.bitcast(args[0], ir.IntType(WIDTH)), ir.IntType(WIDTH)(0))

    return types.boolean(MASK), lowering


@intrinsic
def below(typingctx, count):
    """The lanes whose number, from 0 on, is below `count`."""

    def lowering(context, builder, sig, args):
        count = context.cast(builder, args[0], sig.args[0], types.int64)
        first = builder.insert_element(ir.Constant(_INTEGERS, ir.Undefined), count, ir.Constant(ir.IntType(32), 0))
        zeros = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
        counts = builder.shuffle_vector(first, ir.Constant(_INTEGERS, ir.Undefined), zeros)
        return builder.icmp_signed("<", ir.Constant(_INTEGERS, list(range(WIDTH))), counts)

    return MASK(count), lowering


@intrinsic
def root_guess(typingctx, value):
    """x^(-1/5) of positive numbers within 4 per cent: a fifth of the exponent, by the bits of the numbers."""

    def lowering(context, builder, sig, args):
        number = builder.sitofp(builder.bitcast(args[0], _INTEGERS), _VECTOR)
        scaled = builder.fmul(number, ir.Constant(_VECTOR, [-0.2] * WIDTH))
        scaled = builder.fadd(scaled, ir.Constant(_VECTOR, [1.2 * (1023 - 0.045) * 2.0**52] * WIDTH))
        return builder.bitcast(builder.fptosi(scaled, _INTEGERS), _VECTOR)

    return LANES(LANES), lowering


@intrinsic
def inverse_root_guess(typingctx, value, order):
    """x^(-1/n) of a positive number, n >= 1, within 6 per cent: as `root_guess`."""

    def lowering(context, builder, sig, args):
        x, n = args[0], builder.sitofp(context.cast(builder, args[1], sig.args[1], types.int64), _REAL)
        part = builder.fdiv(_REAL(1.0), n)
        number = builder.sitofp(builder.bitcast(x, _INDEX), _REAL)
        scaled = builder.fsub(
            builder.fmul(builder.fadd(_REAL(1.0), part), _REAL((1023 - 0.045) * 2.0**52)), builder.fmul(number, part)
        )
        return builder.bitcast(builder.fptosi(scaled, _INDEX), _REAL)

    return types.float64(types.float64, order), lowering
