"""The methods a user would otherwise pick: one file each, one interface, one table.

A row of methods.csv is a method: its module, the package it needs beyond the library's
own, and how charts show it. Without that package the method is absent.
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
