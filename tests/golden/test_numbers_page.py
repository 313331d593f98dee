"""What docs/numbers.md says of chaos, robustness and resolution is what the tables
say."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).parents[2]
PAGE = " ".join((ROOT / "docs/numbers.md").read_text(encoding="utf-8").split())
THETAS = ("fig11", "fig10", "fig12")
# Exponents differ from one processor to another by some hundredths: to this they are
# what is said.
EXPONENT = 0.1


def said(pattern: str) -> list[float]:
    """The numbers in a sentence of the page."""
    found = re.search(pattern, PAGE)
    assert found, pattern
    return [float(text) for text in found.groups()]


def table(name: str, *index: str) -> pd.DataFrame:
    found = pd.read_csv(ROOT / f"results/tables/{name}.csv")
    return found.set_index(list(index)) if index else found


def medians(quantity: str) -> pd.DataFrame:
    """Medians of the committed study, a row per scene and a column per N."""
    found = pd.read_csv(ROOT / "paper/tables/resolution_full.csv")
    own = found[found["quantity"] == quantity]
    return own.pivot_table(index="scene", columns="n_blocks", values="q50")


def test_lyapunov_exponents_and_times_of_growth_and_errors_at_ten_seconds():
    lyapunov = table("lyapunov")
    least, most = said(r"exponents are ([\d.]+) to ([\d.]+) per second")
    assert lyapunov["exponent_per_s"].between(least - EXPONENT, most + EXPONENT).all()
    narrow, wide = said(r"of \+-([\d.]+) to \+-([\d.]+):")
    assert lyapunov["uncertainty_per_s"].round(1).between(narrow, wide).all()
    fast, slow = said(r"tenfold in ([\d.]+) to ([\d.]+) s")
    assert [fast, slow] == [
        round(math.log(10) / most, 1),
        round(math.log(10) / least, 1),
    ]
    errors = table("solver_vs_proof", "chain")["time_error_while_agreeing_s"]
    (bound,) = said(r"first global slip and ([\de-]+) s at 10 s")
    assert errors[["trailing", "uniform", "leading"]].max() < bound


def test_the_printed_digits_do_not_settle_the_coefficient():
    """Draws near a jump fall on other sides on other processors."""
    shares = (
        100 * table("digits", "scene", "quantity", "question")[["share", "low", "high"]]
    )
    each = [shares["share"][scene, "mu_sapp", "as_printed"] for scene in THETAS]
    assert each == pytest.approx(
        said(r"0.705\), (\d+), (\d+) and (\d+) % have mu_sapp"), abs=1.5
    )
    same = said(r"In ([\d.]+) % \(95 % interval: ([\d.]+) to ([\d.]+) %\) the three")
    assert shares.loc["all", "mu_sapp", "same_mu_sapp"].tolist() == pytest.approx(
        same, abs=0.6
    )
    six, _, high = shares.loc["all", "all", "all_six"]
    assert [six, high] == pytest.approx(
        [0.0, *said(r"In none \(below ([\d.]+) %\) all six")], abs=0.05
    )


def test_medians_with_noise_are_the_same_at_two_loadings_and_differ_at_the_third():
    noise = table("noise", "scene", "quantity")["q50"]
    expected = said(r"mu_sapp is ([\d.]+), ([\d.]+) and ([\d.]+) \(1000 runs")
    assert [noise[scene, "mu_sapp"] for scene in THETAS] == pytest.approx(
        expected, abs=2e-3
    )
    pairs = (
        table("noise_differences")
        .query("quantity == 'mu_sapp'")
        .set_index(["scene", "other"])
    )
    same = pairs.pop("verdict") == "same"
    assert same[same].index.tolist() == [("fig10", "fig11")]
    at_plus = pairs.loc["fig12"]
    found = [at_plus["low"].min(), at_plus["high"].max()]
    assert found == pytest.approx(
        said(r"at \+5/6 is larger by ([\d.]+) to ([\d.]+)\."), abs=1.5e-3
    )


def test_the_apparent_friction_approaches_mu_k_with_the_number_of_blocks():
    friction = medians("mu_sapp")
    n, near = said(r"with (\d+) blocks it is within ([\d.]+) of it")
    assert ((friction[n] - 0.45).abs() < near).all()
    assert (friction[10] - 0.45).min() > near
    (fine,) = said(r"agree to 0.01, interval included, from (\d+) blocks on")
    verdicts = table("resolution_differences").groupby("n_blocks")["verdict"]
    same = verdicts.agg(lambda of_n: set(of_n) == {"same"})
    assert same[same.index >= fine].all()
    assert not same[10]


def test_the_counts_of_two_loadings_draw_near_with_the_number_of_blocks():
    counts = medians("events_counted")
    coarse, fine = said(r"counts (\d+) % more .* ten blocks, and (\d+) % more with 320")
    found = [100 * (counts[n]["fig12"] / counts[n]["fig10"] - 1) for n in (10, 320)]
    assert found == pytest.approx([coarse, fine], abs=0.5)
