"""Every check of Eq. 15 holds, and fails where the equation or the chain it is about is broken."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import sympy
from golden.small_tables import SMALL

from precursors import Chain, simulate
from precursors.reproduction import derivation, eq15

SCENES = {"fig11": "-5/6", "fig10": 0.0, "fig12": "5/6"}
CHAINS = {name: Chain.from_slider(theta=theta) for name, theta in SCENES.items()}
CHAIN = CHAINS["fig10"]
# Times of mu_s F_Z in double precision.
ROUNDING = 1e-12
# Speeds and distances from the limit are given with four digits.
KEPT = 1e-9


@pytest.fixture(scope="module")
def table():
    return eq15.eq15_table({name: simulate(chain, 10.0) for name, chain in CHAINS.items()}, 10.0)


def test_every_check_holds_with_the_numbers_that_are_kept(table):
    assert list(table.columns) == ["check", "case", "unit", "expected", "found", "holds"]
    kept = pd.read_csv(SMALL.parent / "eq15.csv", dtype=str)
    assert (
        table[["check", "case", "unit", "holds"]].astype(str).equals(kept[["check", "case", "unit", "holds"]])
    )
    for column in ("expected", "found"):
        numbers = pd.to_numeric(table[column], errors="coerce")
        np.testing.assert_allclose(numbers, pd.to_numeric(kept[column], errors="coerce"), rtol=KEPT)
        assert (table[column].astype(str) == kept[column])[numbers.isna()].all()
    assert table["holds"].all()


@pytest.mark.parametrize("n", range(1, 13))
def test_the_load_of_eq_12_is_mu_s_F_Z_for_any_normal_loads(n):
    load = derivation.load(derivation.balances(n))
    assert sympy.expand(load - derivation.bound(n)) == 0
    assert all(sympy.diff(load, w) == derivation.mu_s for w in derivation.weights(n))


@pytest.mark.parametrize("n", range(1, 13))
def test_in_any_state_the_forces_on_the_blocks_add_up_to_the_load(n):
    """The telescoping sum of Eq. 13, before any block is at its limit."""
    total = sympy.Add(*derivation.net_spring_forces(n))
    assert sympy.expand(total - derivation.K * derivation.compressions(n)[0]) == 0


@pytest.mark.parametrize("n", range(2, 13))
def test_eq_12_as_printed_differs_in_its_last_line_only(n):
    lines = zip(derivation.balances(n), derivation.balances_as_printed(n), strict=True)
    wrong = [i for i, (true, printed) in enumerate(lines) if sympy.expand(true - printed) != 0]
    assert wrong == [n - 1]


def test_the_load_of_a_rigid_slider_is_that_of_the_closed_form():
    """One block with mu_s = mu_k: at most F_X = mu_k F_Z + V sqrt(K M)."""
    block = replace(Chain.from_slider(n_blocks=1), mu_s=0.45)
    speed = 2.0
    closed = 180.0 + speed * np.sqrt(block.drive_stiffness * block.mass)
    assert eq15.largest_load(block, speed) == pytest.approx(closed, rel=1e-6)


# Each check on something broken.


def test_the_state_of_eq_12_is_at_the_limit():
    """From maximal strain on all blocks are at their limits at the onset of the first slip."""
    start = eq15.maximal_strain_positions(CHAIN)
    strained = simulate(CHAIN, 0.001, start_positions=start)
    row = eq15.below_limit("fig10", strained)
    assert row.found == pytest.approx(0.0, abs=ROUNDING)
    assert not row.holds


def test_four_times_the_mass_halves_the_speed_at_which_the_bound_breaks(table):
    heavy = replace(CHAIN, mass=4.0 * CHAIN.mass)
    row = eq15.fast_drive("fig10", heavy)
    light = table[(table["check"] == eq15.FAST) & (table["case"] == "fig10")]
    assert row.holds
    assert row.found == pytest.approx(float(light["found"].item()) / 2, rel=0.02)


@pytest.mark.parametrize(
    ("name", "broken", "holds"),
    [
        ("net_spring_forces", lambda true: lambda n: [*true(n)[:-1], -true(n)[-1]], [False, True]),
        ("balances_as_printed", lambda _: derivation.balances, [True, False]),
    ],
    ids=["a wrong sign in the equation of motion", "another misprint"],
)
def test_the_symbols_see_what_is_broken(monkeypatch, name, broken, holds):
    monkeypatch.setattr(derivation, name, broken(getattr(derivation, name)))
    assert [row.holds for row in eq15.in_symbols(4)] == holds


@pytest.mark.parametrize(
    ("name", "broken"),
    [
        ("load_bound", lambda chain: chain.mu_k * chain.normal_load),
        ("maximal_compressions", eq15.compressions_as_printed),
        ("largest_load_at_rest", lambda chain: (279.9, eq15.maximal_compressions(chain))),
    ],
)
def test_the_states_of_rest_see_a_broken_part(monkeypatch, name, broken):
    assert eq15.at_rest("fig10", CHAIN).holds
    monkeypatch.setattr(eq15, name, broken)
    assert not eq15.at_rest("fig10", CHAIN).holds


def test_the_motion_sees_a_start_at_less_strain(monkeypatch):
    full = eq15.maximal_strain_positions
    monkeypatch.setattr(eq15, "maximal_strain_positions", lambda chain: 0.99 * full(chain))
    assert not any(row.holds for row in eq15.in_motion("fig10", CHAIN, 10.0))


@pytest.mark.parametrize(
    ("name", "factor", "failing"),
    [
        ("mu_s", 1.0 + 1.4e-11, [eq15.FULL_STRAIN, eq15.LESS_STRAIN, eq15.RIGID]),
        ("stiffness", 1.01, [eq15.LESS_STRAIN]),
        ("mu_k", 0.5, [eq15.FAST]),
    ],
)
def test_the_motion_sees_another_chain_than_the_one_it_is_about(monkeypatch, name, factor, failing):
    def of_another(chain, *arguments, **options):
        return simulate(replace(chain, **{name: factor * getattr(chain, name)}), *arguments, **options)

    monkeypatch.setattr(eq15, "simulate", of_another)
    rows = [
        *eq15.in_motion("fig10", CHAIN, 10.0),
        eq15.rigid(CHAIN, 10.0),
        eq15.fast_drive("fig10", CHAIN),
    ]
    assert [row.check for row in rows if not row.holds] == failing


def test_a_chain_without_a_global_slip_shows_nothing():
    assert not eq15.rigid(CHAIN, 1.0).holds


def test_ten_blocks_do_not_pass_for_the_rigid_slider(monkeypatch):
    monkeypatch.setattr(eq15, "replace", lambda chain, **_: chain)
    assert not eq15.rigid(CHAIN, 10.0).holds
