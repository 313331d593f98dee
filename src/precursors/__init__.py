"""Simulate stick-slip chains exactly, and analyse the precursors of global slip
(Maegawa, Suzuki and Nakano 2010).

This library works for any chain. The package `maegawa2010` uses it to reproduce the
paper.

    >>> from precursors import Chain, apparent_friction, find_slips, plot, simulate
    >>> run = simulate(Chain.from_slider(theta="-5/6"))  # the rest as in the paper
    >>> round(apparent_friction(run), 4)
    0.4845
    >>> len(find_slips(run))
    41
    >>> plot(run).savefig("run.png")
"""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING

from precursors.audit import audit  # not lazily: the subpackage has the same name

if TYPE_CHECKING:
    from precursors.analysis.load_curve import load_curve
    from precursors.analysis.slips import find_precursors, find_slips, slip_table
    from precursors.analysis.summary import apparent_friction, summarise
    from precursors.figures.run import plot
    from precursors.model.chain import Chain
    from precursors.proof import certify
    from precursors.solver.many import simulate_many
    from precursors.solver.run import Record, Run, RunFileError
    from precursors.solver.simulate import TransitionLimitError, simulate

    __version__: str

# A literal list, which type checkers and editors can read.
__all__ = [
    "Chain",
    "Record",
    "Run",
    "RunFileError",
    "TransitionLimitError",
    "apparent_friction",
    "audit",
    "certify",
    "find_precursors",
    "find_slips",
    "load_curve",
    "plot",
    "simulate",
    "simulate_many",
    "slip_table",
    "summarise",
]
# Modules are imported when a name is first used (PEP 562): checking a configuration or
# drawing a table must not load the compiler.
_MODULES = {
    "Chain": "model.chain",
    "Record": "solver.run",
    "Run": "solver.run",
    "RunFileError": "solver.run",
    "TransitionLimitError": "solver.simulate",
    "apparent_friction": "analysis.summary",
    "certify": "proof",
    "find_precursors": "analysis.slips",
    "find_slips": "analysis.slips",
    "load_curve": "analysis.load_curve",
    "plot": "figures.run",
    "simulate": "solver.simulate",
    "simulate_many": "solver.many",
    "slip_table": "analysis.slips",
    "summarise": "analysis.summary",
}

# Hidden from type checkers: with it, they would accept any name of this package.
if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        if name == "__version__":
            return version("precursors")
        if name in _MODULES:
            module = import_module(f"{__name__}.{_MODULES[name]}")
            value = globals()[name] = getattr(module, name)
            return value
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
