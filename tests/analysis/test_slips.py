"""Slip events and precursors follow from the transitions by the stated definitions."""

from dataclasses import replace

import numpy as np

from precursors import (
    Chain,
    Record,
    find_precursors,
    find_slips,
    simulate,
    slip_table,
)
from precursors.analysis.slips import (
    SLIP,
    Slip,
    slip_events_by_definition,
    slip_rows,
)

# One product and one quotient of doubles.
ROUNDING = 1e-15


def random_chain(rng: np.random.Generator) -> Chain:
    chain = Chain.from_slider(
        n_blocks=int(rng.integers(1, 13)),
        theta=rng.uniform(-1, 1),
        mu_k=rng.uniform(0.2, 0.65),
        drive_stiffness=10 ** rng.uniform(4.5, 7.5),
    )
    return replace(chain, weights=chain.weights * rng.uniform(0.5, 1.5, chain.n_blocks))


def random_transitions(rng: np.random.Generator) -> Record:
    """Make transitions that no mechanics would give: rests without duration, turns, an
    unfinished event."""
    n_blocks = int(rng.integers(1, 5))
    n = int(rng.integers(1, 40))
    intervals = rng.uniform(0.1, 1.0, n + 1) * (rng.random(n + 1) < 0.7)
    mode = np.zeros(n_blocks + 1, int)
    rows = []
    for time in np.cumsum(intervals[:-1]):
        block = int(rng.integers(1, n_blocks + 1))
        mode[block] = rng.choice([m for m in (-1, 0, 1) if m != mode[block]])
        rows.append((time, block, mode[block], rng.uniform(0, 300)))
    chain = Chain.from_slider(n_blocks)
    return Record.from_columns(
        chain, intervals.sum(), *zip(*rows, strict=True), intervals
    )


def without_load(run, share=0.0):
    """Return the same transitions on a chain whose last block bears only a share of its
    load."""
    weights = run.chain.weights.copy()
    weights[-1] *= share
    return replace(run, chain=replace(run.chain, weights=weights))


def test_slip_events_follow_the_definition_for_any_transitions():
    rng = np.random.default_rng(5)
    runs = [random_transitions(rng) for _ in range(120)]
    runs += [without_load(run) for run in runs if run.chain.n_blocks > 1]
    runs += [
        simulate(random_chain(rng), duration=rng.uniform(0.5, 4.0)) for _ in range(40)
    ]
    for run in runs:
        expected = np.array(slip_events_by_definition(run), SLIP)
        events = slip_rows(run)[list(Slip._fields)]
        np.testing.assert_array_equal(events.tolist(), expected.tolist())


def test_block_below_1e_4_of_the_mean_load_counts_as_weightless():
    run = simulate(Chain.from_slider(9), 3.0)
    none, next_to_none, light, even = (
        slip_rows(without_load(run, share))["front"].tolist()
        for share in (0, 8e-5, 1e-4, 1)
    )
    assert none == next_to_none != light == even


def test_precursors_exclude_short_events_and_later_slips():
    slips = find_slips(simulate(Chain.from_slider()))
    fronts = [1, 2, 3, 4, 5, 2, 6, 4, 3, 8, 3, 9, 8, 3, 1, 10]
    assert slips.front[:16].tolist() == fronts
    assert find_precursors(slips).front.tolist() == [1, 2, 3, 4, 5, 6, 8, 9, 10]
    equal = slips.assign(front=[2, 2, 1, *slips.front[3:]])
    assert find_precursors(equal).index[:3].tolist() == [0, 1, 3]


def test_slip_table_has_units_and_lengths_in_metres():
    run = random_transitions(np.random.default_rng(1))
    run = replace(run, chain=replace(run.chain, length=0.3))
    table = slip_table(run)
    slips = find_slips(run)
    for name, with_unit in {"end": "end_s", "largest_load": "largest_load_N"}.items():
        assert table[with_unit].equals(slips[name])
    assert (slips["front"] != slips["n_slid"]).any()
    lengths = 0.3 * slips["front"] / run.chain.n_blocks
    np.testing.assert_allclose(table["front_length_m"], lengths, rtol=ROUNDING)
    assert table["slider_length_m"].eq(0.3).all()
    assert table.index[table["counted"]].equals(find_precursors(slips).index)
