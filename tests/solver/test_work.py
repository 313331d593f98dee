"""Exact counts of the work of the kernel, which increase if a bound becomes looser.

The counts do not depend on rounding: multiplying all forces by 3 or 1.1 does not change
them. They depend on the windows (`layout`, `events`), the derivatives (`series`), the
guessed roots and the steps to them (`guess`), and the cases that the bounds (`proof`)
leave to a search (`roots`).
"""

import pytest
from chains import SLIDER, first_transitions

from precursors import Chain, simulate
from precursors.audit import audit
from precursors.solver import kernel

COUNTED = ["transitions", "windows", "derivatives", "searches", "root_steps"]
# For theta = 0 up to the first global slip. Less is better: then update the numbers.
UNIFORM = [216, 416, 59608, 9, 665]


@pytest.fixture
def counted(monkeypatch):
    """Return a function that runs a chain and returns the counts of the kernel."""
    calls = []
    run_batch = kernel.run_batch

    def watched(batch, limits, progress, *others):
        calls.append(progress[0])
        return run_batch(batch, limits, progress, *others)

    def count(chain, most, **options):
        run = first_transitions(chain, most, **options)
        counts = {name: int(calls[-1][name]) for name in COUNTED}
        assert counts["derivatives"] == round(run.evaluations * chain.n_blocks)
        return list(counts.values())

    monkeypatch.setattr(kernel, "run_batch", watched)
    return count


def test_work_for_a_scene_is_unchanged(counted):
    assert counted(SLIDER(theta=0.0), 1000, until="global slip") == UNIFORM


def test_blocks_far_from_the_drive_need_no_long_search(counted):
    """Without friction all blocks move at once. Block 5 moves as t^9, which stays nearly
    zero for long."""
    chain = Chain([10.0] * 5, 2.84e-5, 25e6, 2.7e11, 8.4e-5, 0.0, 0.0)
    audit(simulate(chain, 4.6e-7)).raise_if_failed()
    transitions, windows, _, _, root_steps = counted(chain, 1000, duration=4.6e-7)
    assert transitions == 5
    assert windows < 100
    assert root_steps < 5000  # millions without restarting the search
