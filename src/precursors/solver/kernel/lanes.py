"""A Numba type of four doubles, on which +, -, * and / act lane by lane.

Loops over the blocks of a chain are too short for LLVM to vectorise them. A value of
this type becomes one AVX register, or two registers of SSE or NEON.
"""

import functools
import operator
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import (
    intrinsic,
    lower_builtin,
    models,
    register_model,
    type_callable,
)

from precursors.solver.kernel.layout import WIDTH

DOUBLE = ir.DoubleType()
BITS = ir.IntType(WIDTH)
PLACE = ir.IntType(32)
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


def _operation(build, result, *kinds):
    """Make a compiled function from `build`, which emits its instructions: (builder,
    *values) -> value."""

    def generate(context, builder, signature, arguments):
        value = build(builder, *arguments)
        return context.get_dummy_value() if result == types.void else value

    @functools.wraps(build)
    def typed(typingctx, *arguments):
        return result(*kinds), generate

    return intrinsic(typed)


def _pack(builder, *values):
    vector = ir.Constant(VECTOR, ir.Undefined)
    for lane, value in enumerate(values):
        vector = builder.insert_element(vector, value, ir.Constant(PLACE, lane))
    return vector


def _shuffle(builder, a, b, lanes):
    return builder.shuffle_vector(
        a, b, ir.Constant(ir.VectorType(PLACE, WIDTH), list(lanes))
    )


def _call(builder, name, value):
    kind = ir.FunctionType(VECTOR, [VECTOR])
    name = f"llvm.{name}.v{WIDTH}f64"
    return builder.call(builder.module.declare_intrinsic(name, fnty=kind), [value])


def _select(builder, comparison, a, b):
    return builder.select(builder.fcmp_ordered(comparison, a, b), a, b)


def _where(builder, flag, a, b):
    return builder.select(builder.fcmp_ordered(">", flag, ZERO), a, b)


def _across(builder, comparison, a):
    """Reduce all lanes to one by halving."""
    for step in (2, 1):
        a = _select(
            builder,
            comparison,
            a,
            _shuffle(builder, a, a, [lane ^ step for lane in range(WIDTH)]),
        )
    return builder.extract_element(a, ir.Constant(PLACE, 0))


def _where_negative(builder, a):
    lanes = builder.not_(builder.fcmp_ordered(">=", a, ZERO))
    return builder.zext(builder.bitcast(lanes, BITS), ir.IntType(64))


def _group(context, builder, kind, arguments):
    """Return a pointer to four consecutive elements of a row."""
    array = context.make_array(kind)(context, builder, arguments[0])
    stride = builder.extract_value(array.shape, 1)
    place = builder.add(builder.mul(arguments[1], stride), arguments[2])
    start = builder.gep(array.data, [place])
    return builder.bitcast(start, VECTOR.as_pointer())


def _load(typingctx, values, row, i):
    def generate(context, builder, signature, arguments):
        return builder.load(_group(context, builder, values, arguments), align=8)

    return four(values, types.intp, types.intp), generate


def _store(typingctx, values, row, i, a):
    def generate(context, builder, signature, arguments):
        builder.store(
            arguments[3], _group(context, builder, values, arguments), align=8
        )
        return context.get_dummy_value()

    return types.void(values, types.intp, types.intp, four), generate


# values[row, i : i + 4], and values[row, i : i + 4] = a.
load: Any = intrinsic(_load)
store: Any = intrinsic(_store)
# The same number in all lanes, or one number per lane.
spread = _operation(lambda b, value: _pack(b, *WIDTH * [value]), four, types.float64)
pack = _operation(
    lambda b, w, x, y, z: _pack(b, w, x, y, z), four, *WIDTH * [types.float64]
)
# Neighbours behind: the last lane of `before`, then all but the last of `here`.
behind = _operation(
    lambda b, before, here: _shuffle(b, before, here, range(3, 7)), four, four, four
)
# Neighbours ahead: all but the first lane of `here`, then the first of `after`.
ahead = _operation(
    lambda b, here, after: _shuffle(b, here, after, range(1, 5)), four, four, four
)
magnitude = _operation(lambda b, a: _call(b, "fabs", a), four, four)
square_root = _operation(lambda b, a: _call(b, "sqrt", a), four, four)
# The first two compare lane by lane, the others across all lanes.
larger = _operation(lambda b, x, y: _select(b, ">", x, y), four, four, four)
smaller = _operation(lambda b, x, y: _select(b, "<", x, y), four, four, four)
largest = _operation(lambda b, a: _across(b, ">", a), types.float64, four)
smallest = _operation(lambda b, a: _across(b, "<", a), types.float64, four)
# x in lanes with flag > 0, and y or zero in the others.
choose = _operation(_where, four, four, four, four)
only = _operation(lambda b, flag, x: _where(b, flag, x, ZERO), four, four, four)
# Bits of the lanes in which a < 0 or a is NaN.
where_negative = _operation(_where_negative, types.int64, four)


def _lane_by_lane(operation, name):
    """Let an operator act on two values of type Four, or on one and a number."""

    @type_callable(operation)
    def typed(context):
        def result(a, b):
            return four if {a, b} <= {four, types.float64} and four in (a, b) else None

        return result

    def generate(context, builder, signature, arguments):
        values = [
            v if t == four else _pack(builder, *WIDTH * [v])
            for v, t in zip(arguments, signature.args, strict=True)
        ]
        return getattr(builder, name)(*values)

    for pair in ((four, four), (four, types.float64), (types.float64, four)):
        lower_builtin(operation, *pair)(generate)


_lane_by_lane(operator.add, "fadd")
_lane_by_lane(operator.sub, "fsub")
_lane_by_lane(operator.mul, "fmul")
_lane_by_lane(operator.truediv, "fdiv")
