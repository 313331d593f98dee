"""Events, precursors, global slip and mu_sapp follow from the transitions by the stated
definitions."""

import math

import numpy as np
import pandas as pd
import pytest
from analysis.random_runs import random_chain, random_transitions

from precursors import (
    Chain,
    Record,
    apparent_friction,
    find_precursors,
    find_slips,
    simulate,
)
from precursors.analysis.slips import (
    OURS,
    Definition,
    first_global,
    first_global_slip,
    slip_table,
)


def run_of(n_blocks, transitions, duration):
    """A run with the given (time, block, mode, load), at rest at the start, without
    stored states."""
    columns = zip(*transitions, strict=True) if transitions else [[]] * 4
    return Record.from_columns(Chain.from_slider(n_blocks), duration, *columns)


def events_one_by_one(run):
    """Slip events as a plain loop over the transitions finds them."""
    events, slides, goes_on, largest = [], set(), False, 0.0
    for (time, block, mode, load), pause in zip(
        run.transitions, run.intervals[1:], strict=True
    ):
        largest = max(largest, load)
        if not goes_on:
            events.append(
                {
                    "onset": time,
                    "load_before": load,
                    "largest_load": largest,
                    "slid": set(),
                    "most": 0,
                }
            )
        event = events[-1]
        slides = slides | {block} if mode else slides - {block}
        event["slid"] |= slides
        event["most"] = max(event["most"], len(slides))
        event["end"], event["load_after"] = (
            (math.nan, math.nan) if slides else (time, load)
        )
        goes_on = slides or pause == 0.0
    return [
        {
            **{
                name: event[name]
                for name in (
                    "onset",
                    "end",
                    "load_before",
                    "load_after",
                    "largest_load",
                )
            },
            "front": max(event["slid"], default=0),
            "n_slid": len(event["slid"]),
            "n_simultaneous": event["most"],
            "is_global": event["most"] == run.chain.n_blocks,
        }
        for event in events
    ]


def test_any_list_of_transitions_has_the_events_of_a_plain_loop():
    rng = np.random.default_rng(5)
    runs = [random_transitions(rng) for _ in range(120)]
    runs += [
        simulate(random_chain(rng), duration=rng.uniform(0.5, 4.0)) for _ in range(40)
    ]
    for run in runs:
        expected = pd.DataFrame(events_one_by_one(run), columns=find_slips(run).columns)
        pd.testing.assert_frame_equal(
            find_slips(run), expected, check_dtype=False, check_exact=True
        )


def test_something_else_than_a_run_or_its_slips_is_named():
    with pytest.raises(
        TypeError, match="slips are found in a Run or Record, but this is Chain"
    ):
        find_slips(Chain.from_slider())
    with pytest.raises(
        TypeError,
        match="precursors are found in the table of find_slips, but this is int",
    ):
        find_precursors(5)
    with pytest.raises(
        TypeError, match="slips are found in a Run or Record, but this is DataFrame"
    ):
        apparent_friction(find_slips(random_transitions(np.random.default_rng(1))))


def test_a_rule_that_is_not_known_is_named_beside_those_that_are():
    slips = find_slips(random_transitions(np.random.default_rng(1)))
    with pytest.raises(ValueError, match=r"short must be one of 'shorter', .* is 'x'"):
        find_precursors(slips, "x")


def test_short_events_are_dropped_equal_ones_kept_and_nothing_after_the_global_slip():
    slips = find_slips(simulate(Chain.from_slider()))
    fronts = [1, 2, 3, 4, 5, 2, 6, 4, 3, 8, 3, 9, 8, 3, 1, 10]
    assert slips.front[:16].tolist() == fronts
    assert find_precursors(slips).front.tolist() == [1, 2, 3, 4, 5, 6, 8, 9, 10]
    equal = slips.assign(front=[2, 2, 1, *slips.front[3:]])
    assert find_precursors(equal).index[:3].tolist() == [0, 1, 3]


def test_mu_sapp_under_every_definition_is_that_of_the_stated_event():
    run = simulate(Chain.from_slider(theta="-5/6"), duration=3.0)
    found = [
        first_global_slip(slip_table(run), definition)
        for definition in (OURS, Definition("each"))
    ]
    assert [(f.event, f.events_counted) for f in found] == [(7, 6), (6, 5)]
    assert [round(f.mu_sapp, 4) for f in found] == [0.4845, 0.4336]
    load = slip_table(run)["largest_load_N"].iloc[found[0].event - 1]
    assert load == pytest.approx(found[0].mu_sapp * 400.0, rel=1e-15)
    assert apparent_friction(run) == found[0].mu_sapp
    early = simulate(run.chain, duration=1.0)
    assert first_global_slip(slip_table(early)) is None
    assert math.isnan(apparent_friction(early))


def test_mu_sapp_is_the_largest_load_before_the_global_slip_though_an_earlier_event_reached_it():
    """Block 1 slides backward in the first event, so that F_X is largest at its end."""
    back = [(1, 1, -1, 90.0), (2, 1, 0, 120.0)]
    both = [(3, 1, 1, 100.0), (4, 2, 1, 130.0), (5, 1, 0, 80.0), (6, 2, 0, 70.0)]
    table = slip_table(run_of(2, back + both, 9.0))
    assert table["largest_load_N"].tolist() == [90.0, 120.0]
    assert first_global_slip(table).mu_sapp == pytest.approx(120.0 / 400.0, rel=1e-15)


# Front, blocks that slid, most at once, load before and after, of five events of a
# chain of three blocks.
EVENTS = pd.DataFrame(
    [
        (2, 2, 1, 9.0, 8.0),
        (1, 1, 1, 10.0, 9.5),
        (2, 2, 2, 11.0, 8.0),
        (3, 3, 2, 12.0, 10.0),
        (3, 3, 3, 11.0, 5.0),
    ],
    columns=["front", "n_slid", "n_simultaneous", "load_before_N", "load_after_N"],
).assign(n_blocks=3)


@pytest.mark.parametrize(
    ("definition", "global_slip", "counted"),
    [
        (Definition(), 4, [0, 2, 3, 4]),
        (Definition("each"), 3, [0, 2, 3]),
        (Definition(2.5), 2, [0, 2]),
        (Definition(short="not longer"), 4, [0, 3]),
        (Definition(short="shorter than the last"), 4, [0, 2, 3, 4]),
        (Definition(front="n_simultaneous"), 4, [0, 1, 2, 3, 4]),
        (Definition("each", "n_simultaneous", "not longer"), 3, [0, 2]),
    ],
)
def test_a_reading_decides_which_event_is_global_and_which_are_short(
    definition, global_slip, counted
):
    slips = definition.read(EVENTS)
    assert first_global(slips) == global_slip
    assert find_precursors(slips, definition.short).index.tolist() == counted


def test_the_first_definition_reads_slips_as_find_slips_does():
    slips = slip_table(simulate(Chain.from_slider(), duration=3.0))
    pd.testing.assert_frame_equal(OURS.read(slips), slips)
