"""Failure modes of the methods on the paper's chain, each shown by measured curves."""

from collections.abc import Callable, Mapping

import pandas as pd

from maegawa2010.studies.failures.common import Failure
from maegawa2010.studies.failures.energy import (
    numerical_damping,
    silent_instability,
    stability_limits,
    unstable,
)
from maegawa2010.studies.failures.missed_roots import missed_roots
from maegawa2010.studies.failures.regularised_friction import creep, stiffness
from maegawa2010.studies.failures.velocity_friction import (
    dead_zone_too_large,
    dead_zone_too_small,
    literal_friction,
)

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
    )
}


def failure_tables() -> dict[str, pd.DataFrame]:
    """failure_curves, the points of all failure modes, and stability_limits.

    A row of failure_curves is a point: failure_mode, curve, role (see `common.Curve`),
    x, y, and the names of both quantities with their units (x_is, y_is).
    """
    found = {mode: measure() for mode, measure in FAILURE_MODES.items()}
    return {
        "failure_curves": curve_table(found),
        "stability_limits": pd.DataFrame(stability_limits()),
    }


def curve_table(found: Mapping[str, Failure]) -> pd.DataFrame:
    """The points of all curves of some failure modes."""
    curves = [
        pd.DataFrame(
            {
                "failure_mode": mode,
                "curve": curve.name,
                "role": curve.role,
                "x": curve.x,
                "y": curve.y,
                "x_is": failure.x,
                "y_is": failure.y,
            }
        )
        for mode, failure in found.items()
        for curve in failure.curves
    ]
    return pd.concat(curves, ignore_index=True)
