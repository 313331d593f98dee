"""Failure modes of the methods on the paper's chain, each with a measured number that
shows it."""

from collections.abc import Callable
from dataclasses import asdict
from itertools import chain

import pandas as pd

from precursors.accuracy.failures.common import Failure, Number
from precursors.accuracy.failures.dead_zone import (
    dead_zone_too_large,
    dead_zone_too_small,
)
from precursors.accuracy.failures.energy import (
    numerical_damping,
    silent_instability,
    unstable,
)
from precursors.accuracy.failures.forward_only import forward_only
from precursors.accuracy.failures.literal_friction import literal_friction
from precursors.accuracy.failures.locating import (
    merged_transitions,
    missed_roots,
    restart_on_root,
)
from precursors.accuracy.failures.regularised_friction import creep, stiffness
from precursors.accuracy.failures.stability import thresholds

# By name, in the order of the gallery.
FAILURE_MODES: dict[str, Callable[[], Failure]] = {
    measure.__name__: measure
    for measure in (
        unstable,
        silent_instability,
        numerical_damping,
        literal_friction,
        dead_zone_too_small,
        dead_zone_too_large,
        creep,
        stiffness,
        missed_roots,
        restart_on_root,
        merged_transitions,
        forward_only,
    )
}

__all__ = ["FAILURE_MODES", "Failure", "Number"]


def failure_tables() -> dict[str, pd.DataFrame]:
    """Numbers and thresholds of all failure modes, and the curves of each, by file
    name."""
    found = {name: measure() for name, measure in FAILURE_MODES.items()}
    numbers = [
        {"failure_mode": name, **asdict(n)}
        for name, of in found.items()
        for n in of.numbers
    ]
    limits = pd.DataFrame(
        map(asdict, chain(thresholds(), *(of.thresholds for of in found.values())))
    )
    return {name: of.curves for name, of in found.items()} | {
        "failures": pd.DataFrame(numbers),
        "thresholds": limits.assign(ratio=limits["measured"] / limits["predicted"]),
    }
