"""Exact relations between runs: scaled chains, a chain inside a longer one, mirrored
starts."""

from dataclasses import replace

import numpy as np
import pytest
from chains import first_transitions
from random_chains import mild_chain

from precursors import Chain, simulate

THETAS = [-5 / 6, 0.0, 5 / 6]
# Before chaos has doubled roundings many times.
DURATION, ROUNDING = 2.0, 1e-12
# Of the duration: some tens of transitions of chains drawn at random.
RANDOM = 1e-9


@pytest.mark.parametrize("theta", THETAS)
@pytest.mark.parametrize(
    "scaled",
    [
        ("weights", "mass", "stiffness", "drive_stiffness"),
        ("weights", "drive_velocity"),
    ],
)
def test_forces_scaled_together_give_the_same_times_and_scaled_loads(theta, scaled):
    """Twice all forces over the same, or over twice the displacements; a factor of two
    rounds nothing."""
    chain = Chain.from_slider(theta=theta)
    doubled = replace(chain, **{name: 2.0 * getattr(chain, name) for name in scaled})
    run, other = (simulate(one, DURATION).transitions for one in (chain, doubled))
    assert len(run) > 10
    assert (
        run[["time", "block", "mode"]].tolist()
        == other[["time", "block", "mode"]].tolist()
    )
    np.testing.assert_array_equal(
        other["tangential_load"], 2.0 * run["tangential_load"]
    )


def test_a_chain_inside_a_longer_one_whose_far_blocks_never_move_slips_as_if_it_were_alone():
    def heavy_from_block_6(n_blocks):
        weights = np.where(np.arange(n_blocks) < 5, 40.0, 1e6)
        return replace(Chain.from_slider(), weights=weights)

    short, long = (
        simulate(heavy_from_block_6(n), DURATION).transitions for n in (6, 23)
    )
    assert len(short) > 10
    assert short["block"].max() == 5
    assert short[["block", "mode"]].tolist() == long[["block", "mode"]].tolist()
    np.testing.assert_allclose(short["time"], long["time"], rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("seed", range(5))
def test_mirrored_starts_have_mirrored_transitions(seed):
    """Heavy blocks at both ends keep the drive out."""
    rng, n = np.random.default_rng(seed), 9
    weights = np.r_[1e6, rng.uniform(20.0, 60.0, n - 2), 1e6]
    start = np.r_[0.0, 1e-5 * rng.standard_normal(n - 2), 0.0]
    chain = replace(Chain.from_slider(), weights=weights)
    mirrored = replace(chain, weights=weights[::-1])
    run = simulate(chain, 0.1, start_positions=start).transitions
    other = simulate(mirrored, 0.1, start_positions=start[::-1]).transitions
    # Blocks released at one instant, as at the start, come in the order of their
    # numbers.
    run, other = run[run["time"] > 0], other[other["time"] > 0]
    assert len(run) > 10
    assert run["block"].tolist() == (n + 1 - other["block"]).tolist()
    assert run["mode"].tolist() == other["mode"].tolist()
    np.testing.assert_allclose(run["time"], other["time"], rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("seed", range(40))
def test_a_run_that_goes_on_from_its_state_at_any_time_has_the_transitions_of_the_whole(
    seed,
):
    """The drive is at 0 when a run begins, so that the chain is moved back by what the
    drive went."""
    rng = np.random.default_rng(seed)
    case = mild_chain(rng)
    whole = case.run()
    cut = rng.uniform(0.2, 0.8) * whole.duration
    # Times before it let the state be found from an earlier one, and from one within
    # the same slip.
    positions, velocities = whole.at([cut / 2, 0.999 * cut, cut])
    start = {"start_positions": positions[2] - case.chain.drive_velocity * cut}
    start |= {"start_velocities": velocities[2]}
    rest = whole.transitions[whole.transitions["time"] > cut]
    found = first_transitions(
        case.chain, 100, duration=1.01 * (whole.duration - cut), **start
    ).transitions
    found = found[found["time"] > 0.0][: len(rest)]
    assert found[["block", "mode"]].tolist() == rest[["block", "mode"]].tolist()
    np.testing.assert_allclose(
        found["time"] + cut, rest["time"], rtol=0, atol=RANDOM * case.duration
    )
