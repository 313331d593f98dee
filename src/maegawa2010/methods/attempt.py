"""Runs of methods that may break off."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from maegawa2010.methods import DivergedError, Result
from precursors.solver.simulate import TransitionLimitError


def attempt(solve: Callable[..., Result], *arguments: Any, **options: Any) -> Result:
    """Result of a method; of a run that breaks off, what there is."""
    try:
        return solve(*arguments, **options)
    except (DivergedError, TransitionLimitError) as error:
        return Result(error.run, 0)
