"""The figure of the push agrees with the run."""

import numpy as np
import pytest

from precursors import Chain, Record, plot, simulate
from precursors.figures import push


def test_each_panel_states_why_its_slip_stops():
    """With 18 N per block, 79.0 N are used up in block 5, 164.7 N in block 10, and 194.3 N
    never. Block 4 bears 27.8 N and rests when event 14 stops."""
    run = simulate(Chain.from_slider(), until="global slip")
    figure = plot(run, "push", events=[5, 12, 14, 16])
    assert figure.get_suptitle() == push.FINDING
    assert [axes.get_title() for axes in figure.axes] == [
        "Precursor: stops after block 5,\nwhere the push is used up",
        "Precursor: stops after block 9,\nwhere the push is used up",
        "Precursor: stops early, after block 3;\nblock 4 bears 27.8 N and holds 28 N",
        "Global slip: the row goes,\n14 N of the push are not used up",
    ]
    first, *_, last = [axes.lines[0].get_xydata()[-1] for axes in figure.axes]
    assert first == pytest.approx([92.7 / 180, 0.0], abs=1e-3)
    assert last == pytest.approx([1.0, 14.3], abs=0.05)


def test_title_is_omitted_if_a_farthest_slip_contradicts_it():
    """At theta = -5/6 the longest slip passes the point at which its push is used up."""
    run = simulate(Chain.from_slider(theta=-5 / 6), until="global slip")
    figure = plot(run, "push")
    assert figure.get_suptitle() == ""
    assert figure.axes[1].get_title().endswith("\nbeyond where the push is used up")
    assert plot(run, "push", events=[5]).get_suptitle() == ""


def test_slip_adds_to_the_push_and_releases_some_of_it():
    """The first global slip adds 19 N in all springs together, and releases 64 N."""
    run = simulate(Chain.from_slider(), until="global slip")
    stairs = [patch.get_data() for patch in plot(run, "push").axes[-1].patches]
    added, released = (fill.values - fill.baseline for fill in stairs[:2])
    assert [added.sum(), released.sum()] == pytest.approx([19, 64], abs=0.5)
    before, after = (outline.values for outline in stairs[2:])
    np.testing.assert_allclose(after - before, added - released, atol=1e-12)


def test_any_event_that_is_over_can_be_shown():
    run = simulate(Chain.from_slider(), until="global slip")
    (axes,) = plot(run, "push", events=[2]).axes
    assert axes.get_title().startswith("Precursor: stops after block 2,")
    with pytest.raises(
        ValueError,
        match=r"must be 1 to 16, those that end within the run, but are \[2, 17\]",
    ):
        plot(run, "push", events=[2, 17])
    columns = [run.transitions[name] for name in run.transitions.dtype.names]
    made = Record.from_columns(run.chain, run.duration, *columns)
    for figure in ("load", "push", "wave"):
        with pytest.raises(
            ValueError, match=f"a {figure} needs a Run, but this is a R"
        ):
            plot(made, figure)
