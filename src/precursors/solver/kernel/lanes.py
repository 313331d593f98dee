"""Four doubles at once in compiled code: a type for Numba on which +, -, *, / act lane by lane.

Loops over the blocks of a chain are too short for LLVM to vectorise by itself. A value of this type becomes
one AVX register, or two of SSE or NEON.
"""

from __future__ import annotations

import functools
import operator

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

from precursors.solver.kernel.layout import WIDTH
from precursors.solver.kernel.pointers import NUMBERS

DOUBLE, BITS, PLACE = ir.DoubleType(), ir.IntType(WIDTH), ir.IntType(32)
VECTOR = ir.VectorType(DOUBLE, WIDTH)
ZERO = ir.Constant(VECTOR, [0.0] * WIDTH)


class Four(types.Type):
    """Numba's type of four doubles."""

    def __init__(self) -> None:
        super().__init__(name="Four")


four = Four()


@register_model(Four)
class _FourModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, VECTOR)


def _operation(result, *kinds):
    """Make a function of compiled code from one that builds its instructions, (builder, *values) -> value."""

    def make(build):
        def generate(context, builder, signature, arguments):
            value = build(builder, *arguments)
            return context.get_dummy_value() if result == types.void else value

        @functools.wraps(build)
        def typed(typingctx, *given):
            return result(*kinds), generate

        return intrinsic(typed)

    return make


def _group(builder, start, index):
    """Pointer to four elements from one on."""
    return builder.bitcast(builder.gep(start, [index]), VECTOR.as_pointer())


def _splat(builder, scalar):
    one = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), scalar, ir.Constant(PLACE, 0))
    return _shuffle(builder, one, one, [0] * WIDTH)


def _shuffle(builder, a, b, lanes):
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(PLACE, WIDTH), list(lanes)))


def _call(builder, name, value):
    kind = ir.FunctionType(VECTOR, [VECTOR])
    function = cgutils.get_or_insert_function(builder.module, kind, f"llvm.{name}.v{WIDTH}f64")
    return builder.call(function, [value])


def _select(builder, comparison, a, b):
    return builder.select(builder.fcmp_ordered(comparison, a, b), a, b)


def _across(builder, comparison, a):
    """Select one of all lanes, by halves."""
    step = WIDTH // 2
    while step:
        a = _select(builder, comparison, a, _shuffle(builder, a, a, [lane ^ step for lane in range(WIDTH)]))
        step //= 2
    return builder.extract_element(a, ir.Constant(PLACE, 0))


@_operation(four, NUMBERS, types.intp)
def load(builder, values, i):
    """values[i : i + 4]."""
    return builder.load(_group(builder, values, i), align=8)


@_operation(types.void, NUMBERS, types.intp, four)
def store(builder, values, i, value):
    """values[i : i + 4] = value."""
    builder.store(value, _group(builder, values, i), align=8)


@_operation(four, types.float64)
def spread(builder, value):
    """The same value in all lanes."""
    return _splat(builder, value)


@_operation(four, types.float64)
def ladder(builder, s):
    """1, s, s^2, s^3."""
    powers = [ir.Constant(DOUBLE, 1.0), s]
    vector = ir.Constant(VECTOR, ir.Undefined)
    for n in range(WIDTH):
        if n > 1:
            powers.append(builder.fmul(powers[n // 2], powers[n - n // 2]))
        vector = builder.insert_element(vector, powers[n], ir.Constant(PLACE, n))
    return vector


@_operation(four, four, four)
def behind(builder, before, here):
    """Each lane's neighbour behind: the last lane of `before`, then all but the last of `here`."""
    return _shuffle(builder, before, here, range(WIDTH - 1, 2 * WIDTH - 1))


@_operation(four, four, four)
def ahead(builder, here, after):
    """Each lane's neighbour ahead: all but the first lane of `here`, then the first of `after`."""
    return _shuffle(builder, here, after, range(1, WIDTH + 1))


@_operation(four, four)
def magnitude(builder, value):
    """Absolute value."""
    return _call(builder, "fabs", value)


@_operation(four, four)
def square_root(builder, value):
    """Square root."""
    return _call(builder, "sqrt", value)


@_operation(four, four, four)
def larger(builder, a, b):
    """The larger of each pair."""
    return _select(builder, ">", a, b)


@_operation(four, four, four)
def smaller(builder, a, b):
    """The smaller of each pair."""
    return _select(builder, "<", a, b)


@_operation(types.float64, four)
def largest(builder, a):
    """The largest of the lanes."""
    return _across(builder, ">", a)


@_operation(types.float64, four)
def smallest(builder, a):
    """The smallest of the lanes."""
    return _across(builder, "<", a)


@_operation(four, four, four, four)
def choose(builder, flag, a, b):
    """a in lanes where flag > 0, b in the others."""
    return builder.select(builder.fcmp_ordered(">", flag, ZERO), a, b)


@_operation(four, four, four)
def only(builder, flag, a):
    """a in lanes where flag > 0, zero in the others."""
    return builder.select(builder.fcmp_ordered(">", flag, ZERO), a, ZERO)


@_operation(types.int64, four)
def where_negative(builder, a):
    """Bits of lanes in which a >= 0 does not hold: below zero, or not a number."""
    lanes = builder.not_(builder.fcmp_ordered(">=", a, ZERO))
    return builder.zext(builder.bitcast(lanes, BITS), ir.IntType(64))


def _lane_by_lane(operation, name):
    """Let an operator act on two values of four, or on one and a number."""

    @type_callable(operation)
    def typed(context):
        def result(a, b):
            return four if {a, b} <= {four, types.float64} and four in (a, b) else None

        return result

    def generate(context, builder, signature, arguments):
        values = [
            v if t == four else _splat(builder, v) for v, t in zip(arguments, signature.args, strict=True)
        ]
        return getattr(builder, name)(*values)

    for pair in ((four, four), (four, types.float64), (types.float64, four)):
        lower_builtin(operation, *pair)(generate)


_lane_by_lane(operator.add, "fadd")
_lane_by_lane(operator.sub, "fsub")
_lane_by_lane(operator.mul, "fmul")
_lane_by_lane(operator.truediv, "fdiv")
