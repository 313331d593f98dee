"""Failure modes of the methods on the paper's chain, each as measured curves."""

from collections.abc import Callable

import pandas as pd

from maegawa2010.studies.failures.common import Curve
from maegawa2010.studies.failures.energy import (
    numerical_damping,
    silent_instability,
    unstable,
)
from maegawa2010.studies.failures.literal_friction import literal_friction
from maegawa2010.studies.failures.missed_roots import missed_roots
from maegawa2010.studies.failures.regularised_friction import creep

# Functions that measure the curves, by name, in the order of the gallery.
FAILURE_MODES: dict[str, Callable[[], list[Curve]]] = {
    measure.__name__: measure
    for measure in (
        unstable,
        silent_instability,
        numerical_damping,
        literal_friction,
        creep,
        missed_roots,
    )
}


def failure_curves() -> pd.DataFrame:
    """The points of all curves: failure_mode, curve, role (see `common.Curve`), x, y."""
    curves = [
        pd.DataFrame(
            {
                "failure_mode": mode,
                "curve": curve.name,
                "role": curve.role,
                "x": curve.x,
                "y": curve.y,
            }
        )
        for mode, measure in FAILURE_MODES.items()
        for curve in measure()
    ]
    return pd.concat(curves, ignore_index=True)
