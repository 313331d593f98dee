"""Every check of Eq. 15 fails if the equation or the chain is changed."""

from dataclasses import replace

import numpy as np
import pytest

from maegawa2010.paper import eq15
from precursors import Chain, simulate

CHAIN = Chain.from_slider()
# Relative rounding of mu_s F_Z in double precision.
ROUNDING = 1e-12


def test_the_load_of_a_rigid_slider_has_its_closed_form():
    """One block with mu_s = mu_k: at most F_X = mu_k F_Z + V sqrt(K M)."""
    block = replace(Chain.from_slider(n_blocks=1), mu_s=0.45)
    speed = 2.0
    closed = 180.0 + speed * np.sqrt(block.drive_stiffness * block.mass)
    assert eq15.largest_load(block, speed) == pytest.approx(closed, rel=1e-6)


# Checks of changed equations and chains


def test_the_state_of_eq_12_is_at_the_limit():
    """From maximal strain, all blocks are at their limits at the onset of the first
    slip."""
    start = eq15.maximal_strain_positions(CHAIN)
    strained = simulate(CHAIN, 0.001, start_positions=start)
    row = eq15.below_limit("fig10", strained)
    assert row.computed == pytest.approx(0.0, abs=ROUNDING)
    assert not row.holds


@pytest.mark.parametrize(
    ("name", "broken"),
    [
        ("load_bound", lambda chain: chain.mu_k * chain.normal_load),
        ("maximal_compressions", eq15.compressions_as_printed),
        (
            "largest_load_at_rest",
            lambda chain: (279.9, eq15.maximal_compressions(chain)),
        ),
    ],
)
def test_the_check_at_rest_fails_for_a_broken_part(monkeypatch, name, broken):
    assert eq15.at_rest("fig10", CHAIN).holds
    monkeypatch.setattr(eq15, name, broken)
    assert not eq15.at_rest("fig10", CHAIN).holds


@pytest.mark.parametrize(
    ("name", "factor", "failing"),
    [
        ("mu_s", 1.0 + 1.4e-11, ["full_strain", "less_strain", "rigid"]),
        ("stiffness", 1.01, ["less_strain"]),
        ("mu_k", 0.5, ["fast"]),
    ],
)
def test_the_checks_of_motion_fail_for_another_chain(
    monkeypatch, name, factor, failing
):
    def of_another(chain, *arguments, **options):
        return simulate(
            replace(chain, **{name: factor * getattr(chain, name)}),
            *arguments,
            **options,
        )

    monkeypatch.setattr(eq15, "simulate", of_another)
    rows = [
        *eq15.in_motion("fig10", CHAIN, 10.0),
        eq15.rigid(CHAIN, 10.0),
        eq15.fast_drive("fig10", CHAIN),
    ]
    assert [row.check for row in rows if not row.holds] == failing
