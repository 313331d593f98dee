"""What docs/numbers.md says of chaos, robustness and resolution is what the tables say."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).parents[2]
TABLES = ROOT / "results/tables"
PAGE = " ".join((ROOT / "docs/numbers.md").read_text(encoding="utf-8").split())
# Exponents differ from one processor to another by some hundredths: to this they are what is said.
EXPONENT = 0.1


def said(pattern: str) -> list[float]:
    """The numbers in a sentence of the page."""
    found = re.search(pattern, PAGE)
    assert found, pattern
    return [float(text) for text in found.groups()]


def test_lyapunov_exponents_and_times_of_growth():
    table = pd.read_csv(TABLES / "lyapunov.csv")
    least, most = said(r"exponents are ([\d.]+) to ([\d.]+) per second")
    assert least - EXPONENT <= table["exponent_per_s"].min()
    assert table["exponent_per_s"].max() <= most + EXPONENT
    narrow, wide = said(r"of \+-([\d.]+) to \+-([\d.]+):")
    assert table["uncertainty_per_s"].round(1).between(narrow, wide).all()
    fast, slow = said(r"tenfold in ([\d.]+) to ([\d.]+) s")
    assert [fast, slow] == [round(math.log(10) / most, 1), round(math.log(10) / least, 1)]


def test_errors_of_times_at_ten_seconds():
    table = pd.read_csv(TABLES / "solver_vs_proof.csv").set_index("chain")
    errors = table.loc[["trailing", "uniform", "leading"], "time_error_while_agreeing_s"]
    (bound,) = said(r"first global slip and ([\de-]+) s at 10 s")
    assert errors.max() < bound


def test_the_printed_digits_do_not_settle_the_coefficient():
    table = pd.read_csv(TABLES / "digits.csv").set_index(["scene", "quantity", "question"])
    shares = ["share", "low", "high"]
    each = [table.loc[(scene, "mu_sapp", "as printed"), "share"] for scene in ("fig11", "fig10", "fig12")]
    same = table.loc[("all", "mu_sapp", "same mu_sapp"), shares]
    six = table.loc[("all", "all", "all six numbers"), shares]
    # Draws near a jump fall on other sides on other processors.
    assert [100 * share for share in each] == pytest.approx(
        said(r"0.705\), (\d+), (\d+) and (\d+) % have mu_sapp"), abs=1.5
    )
    assert (100 * same).tolist() == pytest.approx(
        said(r"In ([\d.]+) % \(95 % interval: ([\d.]+) to ([\d.]+) %\) the three"), abs=0.6
    )
    (below,) = said(r"In none \(below ([\d.]+) %\) all six")
    assert six["share"] == 0
    assert 100 * six["high"] == pytest.approx(below, abs=0.05)


def test_medians_with_noise_are_the_same_at_two_loadings_and_differ_at_the_third():
    noise = pd.read_csv(TABLES / "noise.csv").set_index(["scene", "quantity"])
    medians = [noise.loc[(scene, "mu_sapp"), "q50"] for scene in ("fig11", "fig10", "fig12")]
    assert medians == pytest.approx(said(r"mu_sapp is ([\d.]+), ([\d.]+) and ([\d.]+) \(1000 runs"), abs=2e-3)
    table = pd.read_csv(TABLES / "noise_differences.csv")
    pairs = table[table["quantity"] == "mu_sapp"].set_index(["scene", "other"])
    assert pairs["verdict"].to_dict() == {
        ("fig10", "fig11"): "same",
        ("fig12", "fig11"): "different",
        ("fig12", "fig10"): "different",
    }
    at_plus = pairs.drop(index=("fig10", "fig11"))
    least, most = said(r"at \+5/6 is larger by ([\d.]+) to ([\d.]+)\.")
    assert [at_plus["low"].min(), at_plus["high"].max()] == pytest.approx([least, most], abs=1.5e-3)


def test_the_apparent_friction_falls_to_mu_k_with_the_number_of_blocks():
    table = pd.read_csv(TABLES / "resolution_limits.csv")
    friction = table[table["quantity"] == "mu_sapp"]
    (unit,) = said(r"falls to mu_k, within ([\d.]+),")
    assert ((friction["a"] - 0.45).abs() < unit).all()
