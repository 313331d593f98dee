"""Four doubles at once in compiled code: a type for Numba on which +, -, * act lane by lane.

Loops over the blocks of a chain are too short for LLVM to vectorise by itself. A value of this type becomes
one AVX register, or two of SSE or NEON.
"""

from __future__ import annotations

import operator

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

from precursors.solver.kernel.pointers import NUMBERS, TABLE, element

LANES = 4
DOUBLE = ir.DoubleType()
VECTOR = ir.VectorType(DOUBLE, LANES)


class Four(types.Type):
    """Numba's type of four doubles."""

    def __init__(self) -> None:
        super().__init__(name="Four")


four = Four()


@register_model(Four)
class _FourModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, VECTOR)


def _read(builder, start):
    return builder.load(_untyped(builder, start), align=8, typ=VECTOR)


def _write(context, builder, values, start):
    builder.store(values, _untyped(builder, start), align=8)
    return context.get_dummy_value()


def _untyped(builder, start):
    """The same pointer, without the type that Numba still gives it; the compiler sees nothing of it."""
    box = ir.Constant(ir.LiteralStructType([ir.PointerType()]), ir.Undefined)
    return builder.extract_value(builder.insert_value(box, start, 0), 0)


@intrinsic
def load(typingctx, values, i):
    """values[i : i + 4]."""

    def generate(context, builder, signature, arguments):
        start, index = arguments
        return _read(builder, builder.gep(start, [index]))

    return four(NUMBERS, types.intp), generate


@intrinsic
def store(typingctx, values, i, value):
    """values[i : i + 4] = value."""

    def generate(context, builder, signature, arguments):
        start, index, four_values = arguments
        return _write(context, builder, four_values, builder.gep(start, [index]))

    return types.void(NUMBERS, types.intp, four), generate


@intrinsic
def load_row(typingctx, table, n, i):
    """table[n, i : i + 4]."""

    def generate(context, builder, signature, arguments):
        return _read(builder, element(context, builder, *arguments))

    return four(TABLE, types.intp, types.intp), generate


@intrinsic
def store_row(typingctx, table, n, i, value):
    """table[n, i : i + 4] = value."""

    def generate(context, builder, signature, arguments):
        *place, four_values = arguments
        return _write(context, builder, four_values, element(context, builder, *place))

    return types.void(TABLE, types.intp, types.intp, four), generate


@intrinsic
def spread(typingctx, value):
    """The same value in all four lanes."""

    def generate(context, builder, signature, arguments):
        return _splat(builder, arguments[0])

    return four(types.float64), generate


@intrinsic
def four_of(typingctx, a, b, c, d):
    """Four values, one for each lane."""

    def generate(context, builder, signature, arguments):
        vector = ir.Constant(VECTOR, ir.Undefined)
        for lane, value in enumerate(arguments):
            vector = builder.insert_element(vector, value, ir.Constant(ir.IntType(32), lane))
        return vector

    return four(*[types.float64] * LANES), generate


def _splat(builder, scalar):
    one = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), scalar, ir.Constant(ir.IntType(32), 0))
    return _shuffle(builder, one, one, (0, 0, 0, 0))


def _shuffle(builder, a, b, lanes):
    mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), list(lanes))
    return builder.shuffle_vector(a, b, mask)


@intrinsic
def behind(typingctx, before, here):
    """Each lane's neighbour behind: the last lane of `before`, then the first three of `here`."""

    def generate(context, builder, signature, arguments):
        return _shuffle(builder, *arguments, (3, 4, 5, 6))

    return four(four, four), generate


@intrinsic
def ahead(typingctx, here, after):
    """Each lane's neighbour ahead: the last three lanes of `here`, then the first of `after`."""

    def generate(context, builder, signature, arguments):
        return _shuffle(builder, *arguments, (1, 2, 3, 4))

    return four(four, four), generate


@intrinsic
def magnitude(typingctx, value):
    """Absolute value."""

    def generate(context, builder, signature, arguments):
        kind = ir.FunctionType(VECTOR, [VECTOR])
        fabs = cgutils.get_or_insert_function(builder.module, kind, "llvm.fabs.v4f64")
        return builder.call(fabs, arguments)

    return four(four), generate


def _select(comparison):
    def generate(context, builder, signature, arguments):
        a, b = arguments
        return builder.select(builder.fcmp_ordered(comparison, a, b), a, b)

    return generate


@intrinsic
def larger(typingctx, a, b):
    """The larger of each pair."""
    return four(four, four), _select(">")


@intrinsic
def smaller(typingctx, a, b):
    """The smaller of each pair."""
    return four(four, four), _select("<")


@intrinsic
def where_not_above(typingctx, a, b):
    """Bits 0..3: lanes in which a > b does not hold."""

    def generate(context, builder, signature, arguments):
        lanes = builder.not_(builder.fcmp_ordered(">", *arguments))
        return builder.zext(builder.bitcast(lanes, ir.IntType(LANES)), ir.IntType(64))

    return types.int64(four, four), generate


@intrinsic
def largest(typingctx, value):
    """The largest of the four lanes."""

    def generate(context, builder, signature, arguments):
        a = arguments[0]
        for lanes in ((2, 3, 0, 1), (1, 0, 3, 2)):
            b = _shuffle(builder, a, a, lanes)
            a = builder.select(builder.fcmp_ordered(">", a, b), a, b)
        return builder.extract_element(a, ir.Constant(ir.IntType(32), 0))

    return types.float64(four), generate


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
