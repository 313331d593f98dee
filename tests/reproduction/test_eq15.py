"""Every check of Eq. 15 holds, and fails where the equation or the chain it is about is broken."""

import pytest
import sympy

from precursors import Chain
from precursors.reproduction import derivation, eq15

SCENES = {"fig11": "-5/6", "fig10": 0.0, "fig12": "5/6"}
CHAIN = Chain.from_slider()
# Times of mu_s F_Z in double precision.
ROUNDING = 1e-12


@pytest.fixture(scope="module")
def table():
    return eq15.eq15_table({name: Chain.from_slider(theta=theta) for name, theta in SCENES.items()}, 10.0)


def test_every_check_holds(table):
    assert list(table.columns) == ["check", "case", "unit", "expected", "found", "holds"]
    assert len(table) == 15
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


@pytest.mark.parametrize(
    ("scene", "mu_sapp"),
    [
        ("fig11", 0.7 * (0.999 + 0.001 * 11 / 60)),
        ("fig10", 0.7 * (0.999 + 0.001 / 10)),
        ("fig12", 0.7 * (0.999 + 0.001 / 60)),
    ],
)
def test_a_start_slightly_below_maximal_strain_falls_short_by_as_much(table, scene, mu_sapp):
    row = table[(table["check"] == eq15.LESS_STRAIN) & (table["case"] == scene)]
    assert row["found"].item() == pytest.approx(mu_sapp, rel=ROUNDING)


# Each check on something broken.


def test_the_symbols_see_a_wrong_sign_in_the_equation_of_motion(monkeypatch):
    true = derivation.net_spring_forces
    monkeypatch.setattr(derivation, "net_spring_forces", lambda n: [*true(n)[:-1], -true(n)[-1]])
    assert [row["holds"] for row in eq15.in_symbols(4)] == [False, True]


def test_the_symbols_see_another_misprint(monkeypatch):
    true = derivation.balances
    monkeypatch.setattr(derivation, "balances_as_printed", true)
    assert [row["holds"] for row in eq15.in_symbols(4)] == [True, False]


@pytest.mark.parametrize(
    ("name", "broken"),
    [
        ("load_bound", lambda chain: chain.mu_k * chain.normal_load),
        ("maximal_compressions", eq15.compressions_as_printed),
        ("largest_load_at_rest", lambda chain: (279.9, eq15.maximal_compressions(chain))),
    ],
)
def test_the_states_of_rest_see_a_broken_part(monkeypatch, name, broken):
    assert eq15.at_rest("fig10", CHAIN)["holds"]
    monkeypatch.setattr(eq15, name, broken)
    assert not eq15.at_rest("fig10", CHAIN)["holds"]


def test_the_numbers_see_the_misprint_corrected(monkeypatch):
    monkeypatch.setattr(eq15, "compressions_as_printed", eq15.maximal_compressions)
    assert not eq15.as_printed("fig10", CHAIN)["holds"]


def test_the_motion_sees_a_start_at_less_strain(monkeypatch):
    full = eq15.maximal_strain_positions
    monkeypatch.setattr(eq15, "maximal_strain_positions", lambda chain: 0.99 * full(chain))
    assert not any(row["holds"] for row in eq15.in_motion("fig10", CHAIN, 10.0))


def test_a_chain_without_a_global_slip_shows_nothing():
    assert not eq15.rigid(CHAIN, 1.0)["holds"]


def test_ten_blocks_do_not_pass_for_the_rigid_slider(monkeypatch):
    monkeypatch.setattr(eq15, "replace", lambda chain, **_: chain)
    assert not eq15.rigid(CHAIN, 10.0)["holds"]
