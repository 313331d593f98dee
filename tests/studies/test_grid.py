"""A grid over any two values of the chain."""

import numpy as np
import pytest
from places import ROOT, made
from settings import CONFIG

from maegawa2010.config import check_config
from maegawa2010.studies.grid import figure
from maegawa2010.studies.grid.axes import check_axes
from maegawa2010.studies.grid.tables import grid_study

SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
AXES = [
    {"key": "theta", "from": -0.95, "to": 0.95, "points": 4},
    {"key": "mu_k/mu_s", "from": 0.1, "to": 0.95, "points": 3},
]
SOFT = {"key": "drive_stiffness", "from": 1e4, "to": 1e6, "points": 3, "scale": "log"}
BLOCKS = {"key": "n_blocks", "from": 2, "to": 4, "points": 9}


def map_of_friction():
    return figure.draw(made("grid"), CONFIG["grid"], [(0.25, 0.5)])


PICTURES = {"grid": map_of_friction}


def test_any_two_values_are_combined_and_blocks_are_whole():
    members = grid_study(CONFIG["chain"], [SOFT, BLOCKS]).members
    assert sorted(set(members["n_blocks"])) == [2, 3, 4]
    assert sorted(set(members["drive_stiffness"])) == pytest.approx([1e4, 1e5, 1e6])
    assert len(members) == 9
    # a softer drive needs longer
    assert np.corrcoef(members["drive_stiffness"], members["duration"])[0, 1] < 0


@pytest.mark.parametrize(
    ("axes", "told"),
    [
        ([AXES[0], AXES[0]], "grid must have axes of two keys, but has theta twice"),
        ([AXES[0], {**SOFT, "key": "mu_k"}], "mu_k = 10000: mu_k must be between"),
    ],
)
def test_axes_that_lead_to_no_chain_are_refused(axes, told):
    with pytest.raises(ValueError, match=told):
        check_axes(CONFIG["chain"], axes)


@pytest.mark.parametrize(
    ("axes", "told"),
    [
        (AXES[:1], r"configuration: grid: \[{'key': 'theta'.* is too short"),
        ([AXES[0] | {"key": "mass"}, AXES[1]], r"grid\[0\].key: 'mass' is not one of"),
    ],
)
def test_axes_are_two_values_of_the_chain(axes, told):
    with pytest.raises(ValueError, match=told):
        check_config(CONFIG | {"grid": axes}, SCHEMA)
