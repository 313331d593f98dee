"""The smaller models agree with closed forms, dense matrices and the exact chain."""

from dataclasses import replace

import numpy as np
import pytest

from maegawa2010.studies.models import quasistatic
from maegawa2010.studies.models.answers import MODELS
from maegawa2010.studies.models.quasistatic import (
    ENERGY_CONSERVED,
    OVERDAMPED,
    quasistatic_slips,
)
from maegawa2010.studies.models.rigid import (
    load_drop,
    rigid_slip_duration,
)
from maegawa2010.studies.models.statics import front_law_answers
from precursors import Chain, simulate
from precursors.model.statics import balance_matrix, load_bound

SLIDER = Chain.from_slider
THETAS = ["-5/6", 0.0, "5/6"]
ROUNDING = 1e-12  # relative, of sums of a few terms
# Relative, growing from event to event; a wrong set of blocks gives errors of 1e-2.
CASCADE_ROUNDING = 1e-8
FORCE_ROUNDING = 1e-9  # of F_Z, in the dense cascade
RUN_ROUNDING = 1e-11  # relative, of the exact solver's times and loads over ten slips


def dense_cascade(
    chain: Chain, overshoot: float
) -> list[tuple[float, float, int, int]]:
    """Events (loads before and after, front, number of blocks that slid), computed with
    dense matrices and a check of energies."""
    n = chain.n_blocks
    matrix = balance_matrix(chain)
    stiffness = matrix @ (np.eye(n) - np.eye(n, k=-1))
    rounding = FORCE_ROUNDING * chain.normal_load
    force = np.zeros(n)
    events = []
    while (not events or events[-1][3] < n) and len(events) < 2000:
        force[0] = chain.strength[0] + np.append(force[1:], 0.0)[0]
        before = force[0]
        slid = np.zeros(n, bool)
        sign = np.eye(n)[0]
        while sign.any():
            net = force - np.append(force[1:], 0.0)
            step, sign = dense_stage(chain, stiffness, net, sign, overshoot, rounding)
            released = net @ step - 0.5 * step @ stiffness @ step
            heat = chain.kinetic_friction @ np.abs(step)
            lost = (released - heat) / (net @ step)
            assert (
                abs(lost) < FORCE_ROUNDING
                if overshoot == ENERGY_CONSERVED
                else lost > 0.0
            )
            force = force - chain.springs * np.diff(step, prepend=0.0)
            slid |= sign != 0
            net = force - np.append(force[1:], 0.0)
            sign = np.where(np.abs(net) > chain.strength + rounding, np.sign(net), 0.0)
        events.append(
            (
                before,
                force[0],
                int(np.flatnonzero(slid)[-1]) + 1,
                np.count_nonzero(slid),
            )
        )
    return events


def dense_stage(chain, stiffness, net, sign, overshoot, rounding):
    seeds = sign != 0
    out = np.zeros(chain.n_blocks, bool)
    while True:
        moving = np.flatnonzero(sign)
        step = np.zeros(chain.n_blocks)
        push = (net - sign * chain.kinetic_friction)[moving]
        step[moving] = (1 + overshoot) * np.linalg.solve(
            stiffness[np.ix_(moving, moving)], push
        )
        turned = step * sign < 0
        if turned.any():
            if (turned & ~seeds).any():
                turned &= ~seeds
            out |= turned
            sign = np.where(turned, 0.0, sign)
            continue
        after = net - stiffness @ step
        joins = (sign == 0) & ~out & (np.abs(after) > chain.strength + rounding)
        if not joins.any():
            return step, sign
        sign = np.where(joins, np.sign(after), sign)


@pytest.mark.parametrize("velocity", [1e-4, 0.3])
def test_the_rigid_slider_is_the_exact_chain_of_one_block(velocity):
    chain = SLIDER(n_blocks=1, drive_velocity=velocity)
    run = simulate(chain, 12.5 * 200.0 / chain.loading_rate)
    n = len(run.transitions)
    intervals = run.intervals[:-1]
    assert n > 10
    assert run.transitions["mode"].tolist() == [1, 0] * (n // 2) + [1] * (n % 2)
    load = {1: load_bound(chain), 0: load_bound(chain) - load_drop(chain)}
    expected = [load[mode] for mode in run.transitions["mode"].tolist()]
    np.testing.assert_allclose(
        run.transitions["tangential_load"], expected, rtol=RUN_ROUNDING
    )
    slip = rigid_slip_duration(chain)
    stick = load_drop(chain) / chain.loading_rate
    assert intervals[0] == pytest.approx(
        load_bound(chain) / chain.loading_rate, rel=RUN_ROUNDING
    )
    np.testing.assert_allclose(intervals[1::2], slip, rtol=RUN_ROUNDING, atol=1e-14)
    np.testing.assert_allclose(intervals[2::2], stick, rtol=RUN_ROUNDING)
    np.testing.assert_allclose(
        np.cumsum(intervals), run.transitions["time"], rtol=RUN_ROUNDING
    )


@pytest.mark.parametrize("theta", THETAS)
@pytest.mark.parametrize("overshoot", [ENERGY_CONSERVED, OVERDAMPED, 0.4])
@pytest.mark.parametrize("n_blocks", [1, 2, 10, 23])
def test_cascades_agree_with_dense_matrices_that_balance_energy(
    theta, overshoot, n_blocks
):
    assert_dense(SLIDER(n_blocks=n_blocks, theta=theta), overshoot)


# Two uneven chains in which blocks join and turn round, including blocks that began the
# slip.
@pytest.mark.parametrize(("draw", "mu_k"), [(72, 0.45), (88, 0.6)])
def test_cascades_with_blocks_that_turn_round_agree_as_well(draw, mu_k):
    chain = SLIDER(n_blocks=6, mu_k=mu_k, drive_stiffness=8e6)
    uneven = np.random.default_rng(draw).uniform(0.1, 1.9, 6)
    assert_dense(replace(chain, weights=chain.weights * uneven), ENERGY_CONSERVED)


def assert_dense(chain: Chain, overshoot: float) -> None:
    slips = quasistatic_slips(chain, overshoot)
    dense = np.array(dense_cascade(chain, overshoot))
    cascade = np.array(
        [slips[name] for name in ("load_before_N", "load_after_N", "front", "n_slid")]
    ).T
    np.testing.assert_array_equal(cascade[:, 2:], dense[:, 2:])
    np.testing.assert_allclose(cascade[:, :2], dense[:, :2], rtol=CASCADE_ROUNDING)
    assert slips["is_global"].tolist() == [False] * (len(slips) - 1) + [True]
    # The drive advances while the load grows, and no event takes time.
    before, after = dense[:, :2].T
    driven = before + np.append(0.0, np.cumsum(before - after)[:-1])
    np.testing.assert_allclose(
        slips["onset_s"], driven / chain.loading_rate, rtol=CASCADE_ROUNDING
    )
    np.testing.assert_array_equal(slips["end_s"], slips["onset_s"])
    np.testing.assert_array_equal(
        slips["largest_load_N"], np.maximum.accumulate(slips["load_before_N"])
    )


@pytest.mark.parametrize("theta", THETAS)
def test_the_front_law_is_closer_to_the_chain_with_more_blocks(theta):
    errors = []
    for n_blocks in (10, 40):
        chain = SLIDER(n_blocks=n_blocks, theta=theta)
        exact = MODELS["chain"](chain)["front_loads"]
        law = front_law_answers(chain)["front_loads"]
        errors.append(np.square(law - exact).mean())
    assert errors[1] < 0.36 * errors[0]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: quasistatic_slips(SLIDER(theta=1.0)), "block 1 has 0 N"),
        (
            lambda: quasistatic_slips(SLIDER(mu_k=0.7)),
            "must be below mu_s = 0.7, but is equal",
        ),
    ],
)
def test_a_chain_that_no_cascade_fits_gets_one_clear_line(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_cascade_that_reaches_a_limit_raises(monkeypatch):
    needed = len(quasistatic_slips(SLIDER()))
    monkeypatch.setattr(quasistatic, "MAX_EVENTS", needed - 1)
    with pytest.raises(RuntimeError, match=f"no global slip within {needed - 1} event"):
        quasistatic_slips(SLIDER())
    monkeypatch.setattr(quasistatic, "MAX_STAGES", 0)
    with pytest.raises(RuntimeError, match="event 1 does not come to rest"):
        quasistatic_slips(SLIDER())


def test_without_a_global_slip_answers_that_need_it_are_nan(
    monkeypatch,
):
    monkeypatch.setattr("precursors.model.statics.LIMIT", 0.1)
    answers = MODELS["chain"](SLIDER())
    assert all(
        np.isnan(answers[name])
        for name in ("events_counted", "mu_sapp", "slip_duration")
    )
    assert np.isnan(answers["front_loads"][-1])
    assert answers["first_load"] == pytest.approx(28.0)
