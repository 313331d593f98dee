"""The distribution of a number over the noise, and when two loadings have the same, by hand."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import noise_of

from precursors.analysis.run_statistics import compared, median_difference
from precursors.ensembles.noise import differences_table, noise_table
from precursors.ensembles.study import NOISE, chain_of


def members_of(**mu_sapp: list[float]) -> pd.DataFrame:
    """Runs with these mu_sapp, NaN for a run without a global slip; draw 0 is without noise."""
    same = {"events_counted": 5, "events_to_global_slip": 7, "time_s": 2.0}
    tables = [
        pd.DataFrame({"scene": name, "theta": i, "draw": range(len(mu)), "mu_sapp": mu, **same})
        for i, (name, mu) in enumerate(mu_sapp.items())
    ]
    members = pd.concat(tables, ignore_index=True)
    return members.assign(reached=members["mu_sapp"].notna())


def test_draw_0_is_the_scene_and_the_others_have_noise_in_every_normal_load():
    members = noise_of().members
    for _, runs in members.groupby("scene"):
        scene, *noisy = (chain_of(member, 1).weights for member in runs.to_dict("records"))
        for weights in noisy:
            change = weights / scene - 1
            assert (change != 0).all()
            assert (np.abs(change) <= NOISE).all()


def test_a_distribution_is_that_of_the_noisy_runs_with_a_global_slip():
    row = noise_table(members_of(a=[0.9, np.nan, *np.linspace(0.4, 0.5, 11)])).iloc[0]
    assert (row["without_noise"], row["runs"], row["reached"]) == (0.9, 12, 11)
    assert (row["q50"], row["q05"], row["q95"]) == pytest.approx((0.45, 0.405, 0.495))


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (-0.01, 0.01, "same"),
        (0.0, 0.011, "undecided"),
        (0.011, 0.02, "different"),
        (-0.3, -0.2, "different"),
        (-0.3, 0.3, "undecided"),
    ],
)
def test_the_whole_interval_decides(low, high, verdict):
    assert compared(low, high, 0.01) == verdict


def test_pairs_of_loadings_are_compared_with_their_sign():
    random = np.random.default_rng(3)
    mu = {name: [0.5, *(level + 1e-4 * random.normal(size=50))] for name, level in (("a", 0.5), ("b", 0.53))}
    found = differences_table(members_of(**mu)).query("quantity == 'mu_sapp'").iloc[0]
    assert (found["scene"], found["other"], found["verdict"]) == ("b", "a", "different")
    assert found["difference"] == pytest.approx(0.03, abs=1e-4)
    assert found["low"] < found["difference"] < found["high"]


def test_the_interval_holds_the_difference_of_the_medians_in_95_of_100_cases():
    random = np.random.default_rng(4)
    cases = 400
    held = 0
    for _ in range(cases):
        a, b = random.exponential(size=40), 2 + random.normal(size=60)
        low, high = median_difference(pd.Series(b), pd.Series(a))
        held += low <= 2 - np.log(2) <= high
    assert held / cases >= 0.95
