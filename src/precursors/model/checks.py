"""Check arguments: each function returns the value, or raises a ValueError that names
the parameter."""

import math
from contextlib import suppress
from numbers import Integral, Real
from typing import Any, Literal, TypeGuard

import numpy as np
from numpy.typing import NDArray

# Event at which a run ends before its duration is over.
Until = Literal["global slip"] | None

# Products and squares of three such numbers stay within the range of doubles.
SMALLEST = 1e-60
LARGEST = 1e60
MOST_BLOCKS = 100_000
LONGEST_SHOWN = 100  # characters of an array in a message


def number(name: str, value: object, unit: str) -> float:
    """Return a finite float, or raise a ValueError that names the parameter."""
    if is_number(value):
        with suppress(OverflowError):
            if math.isfinite(result := float(value)):
                return result
    many = callable(value) or isinstance(value, (list, tuple, np.ndarray))
    kind = "one number for all blocks and times" if many else "a finite number"
    raise ValueError(f"{name} must be {kind} [{unit}], but is {value!r}")


def is_number(value: object) -> TypeGuard[Real]:
    """Whether a value has the type of a real number, and is not a boolean."""
    return isinstance(value, Real) and not isinstance(value, bool)


def number_array(name: str, values: Any, unit: str) -> NDArray[np.float64]:
    """Return a new array of floats, or raise a ValueError that names the parameter.

    Texts, masked arrays and arrays with units are refused.
    """
    wanted = f"{name} must be numbers [{unit}]"
    if isinstance(values, (list, tuple)):
        for i, value in enumerate(values):
            if isinstance(value, (list, tuple, np.ndarray)):
                number_array(f"{name}[{i}]", value, unit)
            elif not is_number(value):
                number(f"{name}[{i}]", value, unit)
    elif hasattr(values, "units") or hasattr(values, "unit"):
        raise ValueError(
            f"{wanted} without a unit of their own, but are {_shown(values)}: "
            "convert them, and pass their magnitude"
        )
    elif np.ma.isMaskedArray(values):
        raise ValueError(f"{wanted} without a mask, but are {_shown(values)}")
    elif np.asarray(values).dtype.kind not in "iuf":
        raise ValueError(f"{wanted}, but are {_shown(values)}")
    with suppress(TypeError, ValueError, OverflowError):
        return np.array(values, dtype=np.float64)
    raise ValueError(f"{wanted}, but are {_shown(values)}")


def block_array(name: str, values: Any, unit: str) -> NDArray[np.float64]:
    """Return a new array of floats, one per block, or raise a ValueError.

    A pandas Series is refused if its index is not in order.
    """
    index: Any = getattr(values, "index", None)
    if not getattr(index, "is_monotonic_increasing", True):
        raise ValueError(
            f"{name} must be in the order of the blocks, but their index is "
            f"{_shown(list(index))}: sort_index() sorts them, to_numpy() drops it"
        )
    return number_array(name, values, unit)


def _shown(values: object) -> str:
    """Return the beginning of an array's text, on one line."""
    text = " ".join(repr(values).split())
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]} ..."


def positive(name: str, value: object, unit: str) -> float:
    """Return a float between `SMALLEST` and `LARGEST`, or raise a ValueError that names
    the parameter."""
    result = number(name, value, unit)
    if not SMALLEST <= result <= LARGEST:
        limits = "above 0" if result <= 0 else f"between {SMALLEST:g} and {LARGEST:g}"
        raise ValueError(f"{name} must be {limits} {unit}, but is {value!r}")
    return result


def not_negative(name: str, value: object, unit: str) -> float:
    """Return a float from 0 to `LARGEST`, or raise a ValueError that names the
    parameter."""
    result = number(name, value, unit)
    if not 0 <= result <= LARGEST:
        raise ValueError(
            f"{name} must be between 0 and {LARGEST:g} [{unit}], but is {value!r}"
        )
    return result


def whole(name: str, value: object, at_most: float = math.inf) -> int:
    """Return an int from 1 to `at_most`, or raise a ValueError that names the
    parameter."""
    if (
        isinstance(value, bool)
        or not isinstance(value, Integral)
        or not 1 <= int(value) <= at_most
    ):
        limits = "of at least 1" if at_most == math.inf else f"from 1 to {at_most}"
        raise ValueError(f"{name} must be a whole number {limits}, but is {value!r}")
    return int(value)


def checked_span(duration: object, until: object) -> float:
    """Return the duration [s] of a run, or raise a ValueError; `until` is checked,
    too."""
    checked_until(until)
    return positive("duration", duration, "s")


def checked_until(until: Any) -> Any:
    """Return `until` if it is None or "global slip", or raise a ValueError."""
    if until not in (None, "global slip"):
        raise ValueError(f'until must be None or "global slip", but is {until!r}')
    return until
