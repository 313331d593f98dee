"""The picture of the push says what the run does."""

import numpy as np
import pytest

from precursors import Chain, Record, plot, simulate


def words_of(axes):
    return [axes.get_title(), *(text.get_text() for text in axes.texts)]


def test_a_slip_stops_where_the_line_ends_and_the_global_slip_has_load_left():
    """18 N a block: 79.0 N are used up in block 5, 164.7 N in block 10, 194.3 N never."""
    run = simulate(Chain.from_slider(), until="global slip")
    figure = plot(run, "push")
    assert figure.get_suptitle() == "A slip stops where friction has used up the push"
    first, second, last = figure.axes
    assert words_of(first) == [
        "Precursor: stops after block 4",
        "$F_X$ = 79 N",
        "used up",
    ]
    assert "Precursor: stops after block 9" in words_of(second)
    assert words_of(last) == [
        "Global slip: all 10 blocks",
        "$F_X$ = 194 N",
        "14 N left",
    ]
    for axes, end in zip((first, second), (79.0 / 180, 164.7 / 180), strict=True):
        np.testing.assert_allclose(axes.lines[0].get_xydata()[-1], [end, 0], atol=1e-3)
    assert last.lines[0].get_xydata()[-1] == pytest.approx([1.0, 14.3], abs=0.05)


def test_any_event_is_shown_that_is_over():
    run = simulate(Chain.from_slider(), until="global slip")
    (axes,) = plot(run, "push", events=[2]).axes
    assert axes.get_title() == "Precursor: stops after block 2"
    with pytest.raises(
        ValueError, match=r"must be 1 to 16, the slips that are over, but are \[2, 17\]"
    ):
        plot(run, "push", events=[2, 17])
    columns = [run.transitions[name] for name in run.transitions.dtype.names]
    made = Record.from_columns(run.chain, run.duration, *columns)
    for figure in ("load", "push", "wave"):
        with pytest.raises(
            ValueError, match=f"a {figure} needs a Run, but this is a R"
        ):
            plot(made, figure)
