"""Audits of chains with extreme parameters: some that were once inaccurate, and random
ones."""

import pytest
from chains import first_transitions, positions_under
from random_chains import moves_as_the_model_says

from precursors import Chain

# Deviations of an earlier solver were above 1e-10 of the largest strength; the worst is
# first. In the last two, friction is below rounding for all blocks but one, or for all.
ONCE_SUSPECTED = (12621, 14434, 12209, 12177, 19552, 12626, 15083, 17283, 1668, 3798)


def test_soft_drive_keeps_its_load_with_block_1_at_its_limit():
    """At K/k = 1e-7, a rounding error of k x_1 is 4e-11 of K (V t - x_1)."""
    chain = Chain.from_slider(n_blocks=5, drive_stiffness=25.0)
    pushes = [chain.strength[0], 0.21, 0.32, -chain.strength[3], 0.54]
    start = positions_under(chain, pushes)
    run = first_transitions(chain, 2, duration=0.01, start_positions=start)
    first = run.transitions[0]
    assert (first["time"], first["block"], first["mode"]) == (0.0, 1, 1)
    assert first["tangential_load"] == pytest.approx(
        -chain.drive_stiffness * start[0], rel=1e-14
    )


@pytest.mark.parametrize("first", range(0, 160, 20))
def test_random_chains_pass_the_audit(first):
    """The audit shares no code with the solver."""
    assert sum(map(moves_as_the_model_says, range(first, first + 20))) >= 15


@pytest.mark.parametrize("number", ONCE_SUSPECTED)
def test_formerly_inaccurate_chains_pass_the_audit(number):
    assert moves_as_the_model_says(number)
