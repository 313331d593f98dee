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


def test_the_scene_at_theta_plus_is_fragile():
    table = pd.read_csv(TABLES / "robustness.csv").set_index(["scene", "quantity"])
    assert set(table.loc["fig12"]["class"]) == {"fragile"}


def test_slip_may_not_end():
    table = pd.read_csv(ROOT / "paper/tables/endless_full.csv")
    endless, runs, least, most = said(r"(\d+) of (\d+) runs with (\d+) to (\d+) blocks never had")
    own = table[table["n_blocks"].between(least, most)]
    assert (own["endless"].sum(), own["runs"].sum()) == (endless, runs)
    assert table.loc[~table["n_blocks"].between(least, most), "endless"].sum() == 0


def test_the_printed_digits_do_not_settle_the_coefficient():
    table = pd.read_csv(TABLES / "digits.csv").set_index("scene")
    counted = table[table["quantity"] == "mu_sapp"].loc[["fig11", "fig10", "fig12"], "probability"]
    percent = said(r"0.705\), (\d+), (\d+) and (\d+) % keep mu_sapp")
    agree = said(r"In ([\d.]+) % \(95 % interval: ([\d.]+) to ([\d.]+) %\) the three")
    ours = table.loc["all, same slider", ["probability", "probability_low", "probability_high"]]
    # Draws near a jump fall on other sides on other processors.
    assert (counted * 100).tolist() == pytest.approx(percent, abs=1.5)
    assert (ours * 100).tolist() == pytest.approx(agree, abs=0.6)


def test_the_apparent_friction_falls_to_mu_k_with_the_number_of_blocks():
    table = pd.read_csv(TABLES / "resolution_limits.csv")
    friction = table[table["quantity"] == "mu_sapp"]
    # To half a unit of the last digit of mu_k = 0.45.
    assert ((friction["a"] - 0.45).abs() < 0.005).all()
