"""Arrays as compiled code passes them on: pointers.

Numba counts references to arrays wherever a tuple of them is handed on, which takes longer than the
arithmetic here. Pointers have no counts, and no bounds either: their memory is that of arrays which the
caller of the compiled function holds. `p[i]` reads and writes.
"""

from __future__ import annotations

from numba import from_dtype
from numba.core import types
from numba.extending import intrinsic

NUMBERS = types.CPointer(types.float64)
WHOLE_NUMBERS = types.CPointer(types.int64)


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


def as_record(dtype):
    """Function of compiled code that reads whole numbers of eight bytes as a record with named fields.

    Numba takes long to recognise an array of records that is handed over from Python.
    """
    record = from_dtype(dtype)

    @intrinsic
    def view(typingctx, start):
        def generate(context, builder, signature, arguments):
            return builder.bitcast(arguments[0], context.get_value_type(record))

        return record(WHOLE_NUMBERS), generate

    return view
