"""The methods a user would otherwise pick: one file each, one interface, one table."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from itertools import cycle

from precursors.methods.common import DivergedError, Method, Result

# The module of a method and the package it needs beyond the library's own; without that
# it is absent.
MODULES = {
    "exact": None,
    "heyoka_events": "heyoka",
    "cvode_events": "sksundae",
    "dop853": None,
    "scipy_events": None,
    "rk4": None,
    "rk4_located": None,
    "leapfrog": None,
    "newmark": None,
    "moreau_jean": None,
    "karnopp": None,
    "regularised": None,
}

# Colours and markers of methods that have none of their own, in turn.
SPARE = (
    ("#E4007F", "7,1,0"),
    ("#7B2CBF", "5,1,0"),
    ("#B00020", "12,1,0"),
    ("#00A6A6", "3,0,90"),
    ("#5C4033", "7,0,0"),
    ("#FF8A65", "9,1,0"),
)


def with_looks(methods: Iterable[Method]) -> Iterator[Method]:
    """Give methods without a colour and a marker those of `SPARE` whose colour no other
    has."""
    every = list(methods)
    taken = {method.look[0] for method in every}
    spare = cycle([look for look in SPARE if look[0] not in taken] or SPARE)
    for method in every:
        yield method if all(method.look) else replace(method, look=next(spare))


_ALL = (
    method
    for module, package in MODULES.items()
    if package is None or find_spec(package)
    for method in import_module(f"{__name__}.{module}").METHODS
)
METHODS: dict[str, Method] = {method.name: method for method in with_looks(_ALL)}

__all__ = ["METHODS", "DivergedError", "Method", "Result"]
