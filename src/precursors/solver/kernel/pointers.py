"""Arrays as compiled code passes them on: a pointer, or a pointer and the width of a table.

Numba counts references to arrays wherever a tuple of them is handed on, which takes longer than the
arithmetic here. Pointers have no counts, and no bounds either: their memory is that of arrays which the
caller of the compiled function holds. `p[i]` and `table[n, i]` read and write.
"""

from __future__ import annotations

import operator

from numba.core import cgutils, types
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

NUMBERS = types.CPointer(types.float64)
WHOLE_NUMBERS = types.CPointer(types.int64)


class Table(types.Type):
    """Numba's type of a table of doubles with rows of one width, without gaps."""

    def __init__(self) -> None:
        super().__init__(name="Table")


TABLE = Table()


@register_model(Table)
class _TableModel(models.StructModel):
    def __init__(self, dmm, fe_type):
        super().__init__(dmm, fe_type, [("data", NUMBERS), ("width", types.intp)])


@intrinsic
def pointer(typingctx, array):
    """Pointer to the first element of an array without gaps."""

    def generate(context, builder, signature, arguments):
        return context.make_array(signature.args[0])(context, builder, value=arguments[0]).data

    return types.CPointer(array.dtype)(array), generate


@intrinsic
def shifted(typingctx, start, by):
    """Pointer to the element `by` places further on."""

    def generate(context, builder, signature, arguments):
        return builder.gep(arguments[0], [arguments[1]])

    return start(start, types.intp), generate


@intrinsic
def whole_numbers(typingctx, start):
    """The same memory, holding integers of eight bytes."""

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], context.get_value_type(WHOLE_NUMBERS))

    return WHOLE_NUMBERS(NUMBERS), generate


@intrinsic
def table(typingctx, start, width):
    """Table with rows of a width, from `start` on."""

    def generate(context, builder, signature, arguments):
        made = cgutils.create_struct_proxy(TABLE)(context, builder)
        made.data, made.width = arguments
        return made._getvalue()

    return TABLE(NUMBERS, types.intp), generate


def element(context, builder, value, row, column):
    """Pointer to an element of a table."""
    view = cgutils.create_struct_proxy(TABLE)(context, builder, value=value)
    return builder.gep(view.data, [builder.add(builder.mul(row, view.width), column)])


def _at_indices(context, builder, signature, arguments):
    indices = [
        context.cast(builder, index, kind, types.intp)
        for index, kind in zip(
            cgutils.unpack_tuple(builder, arguments[1]), signature.args[1].types, strict=True
        )
    ]
    return element(context, builder, arguments[0], *indices)


@type_callable(operator.getitem)
def _type_of_reading(context):
    def result(values, indices):
        return types.float64 if values == TABLE and isinstance(indices, types.BaseTuple) else None

    return result


@lower_builtin(operator.getitem, Table, types.BaseTuple)
def _read(context, builder, signature, arguments):
    return builder.load(_at_indices(context, builder, signature, arguments))


@type_callable(operator.setitem)
def _type_of_writing(context):
    def result(values, indices, value):
        return types.none if values == TABLE and isinstance(indices, types.BaseTuple) else None

    return result


@lower_builtin(operator.setitem, Table, types.BaseTuple, types.Float)
def _write(context, builder, signature, arguments):
    builder.store(arguments[2], _at_indices(context, builder, signature, arguments))
    return context.get_dummy_value()
