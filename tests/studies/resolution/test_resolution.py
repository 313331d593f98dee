"""Each number is tabulated for every N."""

from places import ROOT, made
from settings import CONFIG, SLIDERS

from maegawa2010.config import long_settings
from maegawa2010.studies.resolution import figure
from maegawa2010.studies.resolution.tables import check, resolution_study

FACTOR = 1.37
FORCES = ("normal_load", "slider_mass", "youngs_modulus", "drive_stiffness")


def numbers_by_n():
    return figure.draw(made("resolution"), papers_n=10, mu_k=0.45)


PICTURES = {"resolution": numbers_by_n}


def test_the_study_is_drawn_to_its_end_and_the_title_says_where():
    counts, frictions = numbers_by_n().axes
    for axes in (counts, frictions):
        assert max(line.get_xdata()[-1] for line in axes.lines[:9]) == 320
    assert counts.get_title() == "More blocks, more events"
    assert frictions.get_title() == r"With many blocks, every median is near $\mu_k$"


def test_the_first_runs_are_the_same_with_other_roundings():
    """With all forces and masses times a factor the motion is the same."""
    there = {name: made(name) for name in ("resolution", "resolution_differences")}
    scaled = {
        scene: slider | {name: FACTOR * slider[name] for name in FORCES}
        for scene, slider in SLIDERS.items()
    }
    settings = long_settings(ROOT / "workflow")["resolution"]
    study = resolution_study(scaled, CONFIG["duration"], settings)
    comparison = check(there, study, noise={})
    assert comparison["agrees"].all(), comparison[~comparison["agrees"]]
    again = comparison.query("quantity == 'first'")
    assert (again["made"] != again["committed"]).any()
    assert len(again) == 4 * 3 * len(settings["n_blocks"])
