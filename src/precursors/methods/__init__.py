"""The methods a user would otherwise pick: one file each, one interface, one table."""

from importlib import import_module
from importlib.util import find_spec

from precursors.methods.common import DivergedError, Method, Result

# The module of a method and the package it needs beyond the library's own; without that it is absent.
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

METHODS: dict[str, Method] = {
    method.name: method
    for module, package in MODULES.items()
    if package is None or find_spec(package)
    for method in import_module(f"{__name__}.{module}").METHODS
}

__all__ = ["METHODS", "DivergedError", "Method", "Result"]
