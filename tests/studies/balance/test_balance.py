"""The mean load is that of kinetic friction and of what changes R, in runs and in the
committed tables of long ones."""

import numpy as np
import pandas as pd
from places import made
from settings import CONFIG, SLIDERS

from maegawa2010.studies.balance import long
from maegawa2010.studies.balance.figure import draw
from maegawa2010.studies.balance.tables import PIXELS, balance_tables, curve
from precursors import Chain, simulate

SETTINGS = CONFIG["balance"]
SEED = SETTINGS["seed"]
# Of the mean over F_Z: roundings of the run and of the integral.
CLOSED = 1e-11
# Runs of tens of seconds are beyond predictability: roundings change their slips.
CHAOS = 2e-3
# The integral of block forces is read at eight points between two transitions.
READ = 1e-4


def assert_explained(rows: pd.DataFrame) -> None:
    explained = rows["mu_k"] + rows["stored"] + rows["backward"] - rows["remainder"]
    np.testing.assert_allclose(rows["mean"], explained, rtol=0, atol=1e-14)
    assert abs(rows["remainder"]).max() < CLOSED


def test_six_runs_have_the_mean_of_kinetic_friction():
    tables = balance_tables(SLIDERS, [10], 10.0)
    rows = tables["balance"]
    assert_explained(rows)
    assert abs(rows["mean"] - rows["mu_k"]).max() < 1e-3
    assert (rows["largest"] > rows["mean"]).all()
    even = rows.set_index("scene").loc["fig10"]
    assert even["slips_backward"] == 0
    # Without backward sliding R changes by the work of the drive, and nothing else.
    assert np.isclose(even["change_largest"], even["work_largest"], rtol=1e-6)
    assert set(tables["balance_curves"]["scene"]) == set(SLIDERS)


def test_a_slider_that_never_slips_has_no_mean():
    rows = balance_tables({"calm": SLIDERS["fig10"]}, [10], 0.1)["balance"]
    assert rows["mean"].isna().all()
    assert rows["slips"].item() == 0


def test_few_points_of_the_curve_have_all_its_peaks():
    run = simulate(Chain.from_slider(theta="5/6"), 10.0)
    points = curve(run)
    peaks = run.transitions["tangential_load"]
    assert len(points) <= 2 * PIXELS + 2
    assert np.isclose(points["load"].max() * 400.0, peaks.max())
    exact = run.tangential_load(points["time_s"])
    np.testing.assert_allclose(points["load"], exact / 400.0, atol=1e-6)


def test_the_curve_is_grey_where_slips_are_not_predicted():
    table = balance_tables({"fig10": SLIDERS["fig10"]}, [10], 4.0)
    rows = table["balance"].assign(predictable_s=3.0)
    axes, *_ = draw(rows, table["balance_curves"]).axes
    grey, colored = axes.lines[:2]
    assert 2.9 < colored.get_xdata().max() == grey.get_xdata().min() <= 3.0
    assert grey.get_xdata().max() == 4.0
    known = rows["mean"].item()
    words = "\n".join(text.get_text() for text in axes.texts)
    assert f"mean {known:.4f}" in words


def test_long_runs_have_the_mean_that_the_balance_says():
    shorter = {"n_blocks": [10], "seconds": [25], "mu_k": [0.1, 0.3]}
    few = SETTINGS["runs"] | shorter | {"mu_k_seconds": 100}
    rows = long.runs_table(CONFIG["chain"], few, SEED)
    there = made("balance_runs")
    for table in (rows, there):
        assert_explained(table)
        assert (table["largest"] > table["mean"]).all()
    random, known = (t.query("varied == 'weights'") for t in (rows, there))
    np.testing.assert_allclose(random["mean"], known["mean"], atol=CHAOS)
    slippery = rows.query("mu_k == 0.1")
    # At mu_k = 0.1 blocks slide backward: the mean is above mu_k.
    assert (slippery["mean"] > 0.101).all()
    assert set(there["n_blocks"]) == set(SETTINGS["runs"]["n_blocks"])
    assert set(SETTINGS["runs"]["mu_k"]) <= set(there["mu_k"])


def test_the_mean_friction_of_all_blocks_is_the_mean_load():
    chain = Chain.from_slider(theta="5/6")
    run, start = long.lasting(chain, 20.0)
    friction = long.mean_friction(run, start, 20.0).sum() / chain.normal_load
    assert abs(friction - long.mean_of(run, start, 20.0).mean) < READ
    there = made("balance_blocks").query("theta > 0")["friction"]
    assert abs(there @ chain.weights / chain.normal_load - chain.mu_k) < CHAOS


def test_first_slips_are_those_of_the_library():
    few = {"n_blocks": [10], "runs": SETTINGS["first_slips"]["runs"][:1]}
    again = long.first_slips_table(SLIDERS, few, SEED)
    there = made("balance_first_slips").query("n_blocks == 10")
    there = there.reset_index(drop=True)
    pd.testing.assert_frame_equal(there, again, rtol=1e-6)
    # F_X is as far from mu_k F_Z as R allows, at most.
    assert (abs(again["excess_q50"]) <= again["bound_q50"]).all()


def test_loads_with_a_heavy_block_are_those_of_the_library():
    few = {"n_blocks": [20], "runs": SETTINGS["loads"]["runs"]}
    again = long.loads_table(CONFIG["chain"], few, SEED)
    there = made("balance_loads").query("n_blocks == 20")
    pd.testing.assert_frame_equal(there.reset_index(drop=True), again, rtol=1e-6)
    heavy = again["load"].str.startswith("heavy")
    assert np.allclose(again["share"][heavy], 0.2)
