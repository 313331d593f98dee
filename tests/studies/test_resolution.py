"""Each number is tabulated for every N, and extrapolated to infinite N."""

from functools import cache

import numpy as np
import pandas as pd
import pytest
from golden.kept import SMALL
from settings import CONFIG
from studies.made import chunks_of, noise_made

from maegawa2010.studies.resolution import figure
from maegawa2010.studies.resolution import tables as resolution


@cache
def small() -> dict[str, pd.DataFrame]:
    """The tables of few runs of few blocks."""
    few = chunks_of("resolution_members", seed=1, n_blocks=[2, 4], runs=[6, 6])
    noise = noise_made()["noise_members"]
    return resolution.resolution_tables(few, noise, CONFIG["chain"], "fig10", 2)


def numbers_by_n():
    foreseen = {
        "scene": "fig10",
        "n_blocks": [2, 4],
        "horizon_s": 2.5,
        "predictable": [True, False],
    }
    table = pd.read_csv(SMALL / "resolution.csv")
    return figure.draw(table, pd.DataFrame(foreseen), papers_n=12, mu_k=0.45)


TABLES = {
    name: lambda name=name: small()[name]
    for name in ("resolution", "counts_by_n", "resolution_limits")
}
PICTURES = {"resolution": numbers_by_n}


def test_an_exact_law_is_found_from_the_runs_with_noise_and_a_global_slip():
    """Three runs for each N, one below the law, one on it, one above; others do not
    count."""
    n = np.array([20, 40, 80, 160])
    law = pd.DataFrame(
        {
            "n_blocks": n,
            "scene": "s",
            "draw": 1,
            "reached": True,
            "mu_sapp": 0.4 + 2 / n,
        }
    )
    others = [{"n_blocks": 5}, {"draw": 0}, {"reached": False}]
    members = [law.assign(mu_sapp=factor * law["mu_sapp"]) for factor in (0.9, 1, 1.1)]
    members += [law.assign(mu_sapp=9.9, **other) for other in others]
    [found] = resolution.limits_table(pd.concat(members), 20, 0.4).to_dict("records")
    assert (found["a"], found["n_points"]) == (0.4, 4)
    assert found["b"] == pytest.approx(2.0, rel=1e-12)
    assert found["misfit"] == pytest.approx(0.0, abs=1e-12)


def test_a_median_off_the_law_is_the_misfit():
    """0.1 and 0.3 above the limit at N = 1 and 2: b = (0.1 + 0.3/2)/(1 + 1/4) = 0.2."""
    members = pd.DataFrame({"n_blocks": [1, 2], "mu_sapp": [0.5, 0.7], "scene": "s"})
    members = members.assign(draw=1, reached=True)
    [found] = resolution.limits_table(members, 1, 0.4).to_dict("records")
    assert (found["b"], found["misfit"]) == pytest.approx((0.2, 0.2), rel=1e-12)


def test_equal_counts_differ_by_chance_only():
    """Also with SciPy 1.18, whose test has no answer without variance."""
    members = pd.DataFrame({"scene": ["even", "tilted"] * 3, "n_blocks": 2, "draw": 1})
    members = members.assign(
        theta=0.0, reached=True, **dict.fromkeys(resolution.COUNTS, 3)
    )
    counts = resolution.counts_table(members, "even")
    assert (counts.filter(like="_p") == 1).all(axis=None)


def test_the_papers_run_is_predictable_and_thirty_blocks_with_a_heavy_trailing_edge_are_not():
    """At N = 30 and theta = 5/6 the horizon of the run is shorter than its first global
    slip."""
    slider = {"s": {**CONFIG["chain"], "theta": 5 / 6}}
    table = resolution.predictability_table(slider, [10, 30], 10.0, 1e-9)
    assert table["predictable"].tolist() == [True, False]
