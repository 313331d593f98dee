"""Other numerical methods for the chain, behind one interface, to compare with the exact
solver.

Each row of methods.csv is a method: its module, the extra package that it needs, and how
charts show it. A method whose package is not installed is left out.
"""

import csv
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from maegawa2010.methods.common import DivergedError, Method, Result, attempt

with Path(__file__).with_name("methods.csv").open(encoding="utf-8") as _file:
    ROWS = {
        row["method"]: row
        for row in csv.DictReader(_file)
        if not row["needs"] or find_spec(row["needs"])
    }


def _method(name: str, module: str) -> Method:
    methods = import_module(f"{__name__}.{module}").METHODS
    return next(method for method in methods if method.name == name)


METHODS = {name: _method(name, row["module"]) for name, row in ROWS.items()}
SMOOTH = {name: method.smooth for name, method in METHODS.items() if method.smooth}

__all__ = ["METHODS", "ROWS", "SMOOTH", "DivergedError", "Method", "Result", "attempt"]
