"""Memory as compiled code passes it on: addresses, and pointers to which they are cast.

Numba counts references to arrays wherever a tuple of them is handed on, which takes
longer than the arithmetic here. Pointers have no counts, and no bounds either: their
memory is that of arrays which the caller of the compiled function holds. `p[i]` reads
and writes.
"""

from numba.core import types
from numba.extending import intrinsic, register_jitable

NUMBERS = types.CPointer(types.float64)
WHOLE_NUMBERS = types.CPointer(types.int64)
# Bytes of a number.
EIGHT = 8


def cast_to(kind):
    """Function of compiled code that takes an address for a pointer, or a record with
    named fields."""

    @intrinsic
    def cast(typingctx, address):
        def generate(context, builder, signature, arguments):
            return builder.inttoptr(arguments[0], context.get_value_type(kind))

        return kind(types.uintp), generate

    return cast


numbers = cast_to(NUMBERS)
whole_numbers = cast_to(WHOLE_NUMBERS)


@register_jitable
def row_address(array, n):
    """Address of row n of an array without gaps."""
    return array.ctypes.data + n * array.strides[0]


@intrinsic
def shifted(typingctx, start, by):
    """Pointer to the element `by` places further on."""

    def generate(context, builder, signature, arguments):
        return builder.gep(arguments[0], [arguments[1]])

    return start(start, types.intp), generate
