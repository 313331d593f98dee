"""Four doubles at once in compiled code: a type for Numba on which +, -, * act lane by lane.

Loops over the blocks of a chain are too short for LLVM to vectorise by itself. A value of this type becomes
one AVX register, or two of SSE or NEON.
"""

from __future__ import annotations

import operator

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

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


def _pointer(context, builder, array_type, array, indices):
    """Pointer to four doubles that begin at an element of a C-contiguous array."""
    view = context.make_array(array_type)(context, builder, value=array)
    shape = cgutils.unpack_tuple(builder, view.shape)
    strides = cgutils.unpack_tuple(builder, view.strides)
    item = cgutils.get_item_pointer2(context, builder, view.data, shape, strides, array_type.layout, indices)
    return builder.bitcast(item, VECTOR.as_pointer())


@intrinsic
def load(typingctx, array, i):
    """array[i : i + 4]."""

    def generate(context, builder, signature, arguments):
        value, index = arguments
        return builder.load(_pointer(context, builder, signature.args[0], value, [index]), align=8)

    return four(array, i), generate


@intrinsic
def store(typingctx, array, i, value):
    """array[i : i + 4] = value."""

    def generate(context, builder, signature, arguments):
        target, index, values = arguments
        builder.store(values, _pointer(context, builder, signature.args[0], target, [index]), align=8)
        return context.get_dummy_value()

    return types.void(array, i, value), generate


@intrinsic
def load_row(typingctx, array, n, i):
    """array[n, i : i + 4]."""

    def generate(context, builder, signature, arguments):
        value, *indices = arguments
        return builder.load(_pointer(context, builder, signature.args[0], value, indices), align=8)

    return four(array, n, i), generate


@intrinsic
def store_row(typingctx, array, n, i, value):
    """array[n, i : i + 4] = value."""

    def generate(context, builder, signature, arguments):
        target, row, column, values = arguments
        builder.store(values, _pointer(context, builder, signature.args[0], target, [row, column]), align=8)
        return context.get_dummy_value()

    return types.void(array, n, i, value), generate


@intrinsic
def of_width(typingctx, array, width):
    """The same array of two dimensions, C-contiguous, with rows of a width that the compiler knows."""

    def generate(context, builder, signature, arguments):
        value, columns = arguments
        view = context.make_array(signature.args[0])(context, builder, value=value)
        n_rows = builder.extract_value(view.shape, 0)
        view.shape = cgutils.pack_array(builder, [n_rows, columns])
        item = ir.Constant(columns.type, DOUBLE.get_abi_size(context.target_data))
        view.strides = cgutils.pack_array(builder, [builder.mul(columns, item), item])
        return view._getvalue()

    return array(array, types.intp), generate


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

    return types.uint64(four, four), generate


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
