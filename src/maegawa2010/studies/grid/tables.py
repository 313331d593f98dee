"""A grid of chains, each run to its first global slip."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from maegawa2010.studies.grid.axes import Axis, chain_values, points_of
from maegawa2010.studies.members import Study, chain_of, stack
from precursors.model.statics import LIMIT, longest_run

# A run that has no global slip ends when the drive could have loaded the chain to its
# limit mu_s F_Z so often.
LOADINGS = 2.0


def grid_study(slider: Mapping[str, Any], axes: Sequence[Axis]) -> Study:
    """Chains at all points of a grid of two axes."""
    columns, rows = (points_of(axis) for axis in axes)
    x, y = (grid.ravel() for grid in np.meshgrid(columns, rows))
    values = {axes[0]["key"]: x, axes[1]["key"]: y}
    study = Study(stack([{**slider, **values, **chain_values({**slider, **values})}]))
    return Study(study.members.assign(duration=durations(study)))


def durations(study: Study) -> list[float]:
    """Longest run of each member [s], a power of two: members with the same run in one
    batch."""
    longest = [
        longest_run(chain_of(member)) for member in study.members.to_dict("records")
    ]
    return (2.0 ** np.ceil(np.log2(LOADINGS / LIMIT * np.array(longest)))).tolist()
