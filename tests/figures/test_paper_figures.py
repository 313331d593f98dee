"""Figs. 9-13 show what the slip tables say."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
import pytest
from figures.examples import LENGTH_M, N_BLOCKS, N_COUNTED, draw, scene, slips, trace
from matplotlib.collections import FillBetweenPolyCollection, LineCollection
from matplotlib.colors import to_hex
from matplotlib.text import Annotation

from precursors.figures import style
from precursors.figures.scene import GLOBAL, MOST_ARROWS, PARTIAL

# Positions pass through no arithmetic but a unit conversion.
ROUNDING = 1e-12
FIRST_GLOBAL_S = slips()["onset_s"].iloc[-1]
# An event that never ends.
ENDLESS = {"end_s": np.nan, "load_after_N": np.nan, "counted": False}


@pytest.fixture(scope="module")
def figure():
    return draw("scene")


def draw_scene(events, duration=10.0):
    return draw("scene", **scene(events, duration))


def events_drawn(axes, color):
    """Time of each vertical line of a color, and how far it goes; all must start at the trailing edge."""
    drawn = {}
    for collection in axes.collections:
        if isinstance(collection, LineCollection) and to_hex(collection.get_color()[0]) == color.lower():
            for (x, y), (x_end, y_end) in collection.get_segments():
                assert (x, y) == (x_end, 0)
                drawn[float(x)] = float(y_end)
    return drawn


def dashed_lines(axes):
    return [float(line.get_xdata()[0]) for line in axes.lines if line.get_linestyle() == "--"]


def arrows(axes):
    return [tuple(child.xy) for child in axes.get_children() if isinstance(child, Annotation)]


def key(figure):
    legend = figure.legends[0] if figure.legends else figure.axes[0].get_legend()
    return [text.get_text() for text in legend.get_texts()]


def markers(figure, marker):
    return [line.get_xydata() for line in figure.axes[0].lines if line.get_marker() == marker]


def test_each_event_is_a_line_from_the_trailing_edge_as_long_as_its_front(figure):
    for is_global, color in ((False, PARTIAL), (True, GLOBAL)):
        events = slips()[lambda table, wanted=is_global: table["is_global"] == wanted]
        drawn = events_drawn(figure.axes[1], color)
        np.testing.assert_allclose(list(drawn), events["onset_s"], rtol=ROUNDING)
        reached_mm = 1e3 * LENGTH_M * events["front"] / N_BLOCKS
        np.testing.assert_allclose(list(drawn.values()), reached_mm, rtol=ROUNDING)


def test_a_dashed_line_marks_the_first_global_slip_in_all_panels():
    later = slips().iloc[[-1]].assign(onset_s=5.0, end_s=5.0005, counted=False)
    panels = draw_scene(pd.concat([slips(), later], ignore_index=True)).axes
    assert [dashed_lines(axes) for axes in panels] == [[FIRST_GLOBAL_S]] * 4


def test_a_partial_slip_that_reaches_the_leading_edge_has_a_circle():
    events = slips().assign(is_global=False)
    figure = draw_scene(events)
    (circles,) = [line for line in figure.axes[1].lines if line.get_marker() == "o"]
    assert circles.get_xydata().tolist() == [[FIRST_GLOBAL_S, 1e3 * LENGTH_M]]
    assert key(figure) == ["partial slip", "partial, to the leading edge"]


def test_scenes_that_are_compared_have_one_load_axis():
    high, low = slips(), slips()[lambda table: ~table["is_global"]]
    traces = [trace(high, 20.0), trace(low, 2.0)]
    limits = [
        draw("scene", slips=one, trace=own, others=traces).axes[0].get_ylim()
        for one, own in zip((high, low), traces, strict=True)
    ]
    assert limits[0] == limits[1]
    assert limits[0][1] > traces[0]["tangential_load_N"].max()


def test_of_hundreds_of_events_the_largest_drops_have_the_arrows():
    rng, n = np.random.default_rng(1), 600
    events = slips([*rng.integers(1, N_BLOCKS, n), N_BLOCKS], np.linspace(1, 190, n + 1), drop_N=0.01)
    events["load_after_N"] = events["load_before_N"] - rng.random(n + 1)
    figure = draw_scene(events)
    inset = figure.axes[2]
    seen = events[(events["onset_s"] > inset.get_xlim()[0]) & ~events["is_global"]]
    drop = seen["load_before_N"] - seen["load_after_N"]
    marked = seen["onset_s"].isin([time for time, _ in arrows(inset)])
    assert marked.sum() == MOST_ARROWS < len(seen)
    assert drop[marked].min() > drop[~marked].max()
    assert len(events_drawn(figure.axes[1], PARTIAL)) == n


@pytest.mark.parametrize("duration", [0.7, 1000.0])
def test_the_time_axis_is_the_run(duration):
    assert draw_scene(slips()[lambda table: table["end_s"] < duration], duration).axes[1].get_xlim() == (
        0,
        duration,
    )


def test_a_run_that_stops_at_the_global_slip_keeps_its_line_off_the_frame():
    assert draw_scene(slips(), slips()["end_s"].iloc[-1]).axes[1].get_xlim()[1] > 1.03 * FIRST_GLOBAL_S


@pytest.mark.parametrize(
    ("events", "title", "said"),
    [
        (slips()[lambda table: ~table["is_global"]], r"$\theta = 0$: uniform (no global slip)", []),
        (slips([], []), "uniform", ["no slip event"]),
    ],
)
def test_a_run_without_a_global_slip_says_so_and_has_no_magnified_view(events, title, said):
    upper, lower = draw_scene(events).axes
    assert upper.get_title(loc="left") == title
    assert dashed_lines(upper) == dashed_lines(lower) == []
    assert [text.get_text() for text in lower.texts] == said


def test_an_event_that_the_end_of_the_run_cuts_off_is_a_band():
    cut_off = slips().iloc[[0]].assign(onset_s=4.0, front=7, **ENDLESS)
    figure = draw("scene", slips=pd.concat([slips(), cut_off], ignore_index=True))
    (band,) = [item for item in figure.axes[1].collections if isinstance(item, FillBetweenPolyCollection)]
    np.testing.assert_allclose(
        band.get_paths()[0].get_extents().get_points(), [[4, 0], [10, 70]], rtol=ROUNDING
    )
    assert key(figure)[-1] == "not over when the run ends"


def test_an_event_that_starts_the_run_and_never_ends_is_drawn():
    flat = pd.DataFrame({"time_s": [0.0, 1.0], "tangential_load_N": [0.0, 0.0]})
    figure = draw("scene", slips=slips([N_BLOCKS], [0.0]).assign(**ENDLESS), trace=flat)
    assert list(events_drawn(figure.axes[1], GLOBAL)) == [0.0]


def test_a_chain_of_one_block_slips_over_the_whole_length():
    figure = draw_scene(slips([1], [280.0], n_blocks=1, length_m=0.25).assign(is_global=True))
    assert list(events_drawn(figure.axes[1], GLOBAL).values()) == [250.0]


def test_a_dollar_sign_in_a_title_is_a_dollar_sign():
    assert draw("scene", title="$5").axes[0].get_title(loc="left").endswith(r": \$5")


@pytest.mark.parametrize(("width", "columns"), [(85.0, 1), (178.0, 2)])
def test_a_narrow_figure_has_its_panels_below_each_other_in_the_asked_size(width, columns):
    figure = draw("scene", look=style.Look(width, 9.0))
    assert figure.get_size_inches()[0] == pytest.approx(width / style.MM_PER_INCH)
    assert len({round(axes.get_position().x0, 2) for axes in figure.axes}) == columns
    assert {axes.xaxis.label.get_size() for axes in figure.axes} == {9.0}


def test_a_key_with_large_letters_stands_below_the_marks():
    figure = draw("fig13", look=style.Look(85.0, 9.0))
    figure.draw_without_rendering()
    (legend,) = figure.legends
    assert legend.get_window_extent().y1 < figure.axes[0].get_window_extent().y0


def test_symbols_have_the_font_of_the_text(tmp_path):
    look = style.Look(font="DejaVu Serif")
    style.save(draw("scene", look=look), tmp_path / "figure.pdf", look)
    fonts = re.findall(rb"/BaseFont /\w+\+(\w+)", (tmp_path / "figure.pdf").read_bytes())
    assert {font.removesuffix(b"-Italic") for font in fonts} == {b"DejaVuSerif"}


def test_a_measurement_lies_over_the_load_and_over_the_lengths():
    data = np.array([[1.0, 90.0], [2.0, 120.0]])
    load, magnified = (draw("scene", data=data).axes[i].lines for i in (0, 2))
    assert any(np.array_equal(line.get_xydata(), data) for line in load)
    assert any(np.array_equal(line.get_xydata(), data) for line in magnified)
    lengths = np.array([[50.0, 0.3], [90.0, 0.5]])
    (points,) = markers(draw("fig13", data=lengths), "+")
    np.testing.assert_array_equal(points, lengths)
    with pytest.raises(ValueError, match="between 0 and 1"):
        draw("fig13", data=100 * lengths)


def test_short_events_up_to_the_global_slip_are_crosses():
    after = slips().iloc[[0]].assign(onset_s=9.0, counted=False)
    (crosses,) = markers(draw("fig13", slips=[pd.concat([slips(), after], ignore_index=True)]), "x")
    assert len(crosses) == len(slips()) - N_COUNTED


def test_scenes_that_differ_in_n_or_normal_load_say_so_and_have_no_common_friction_coefficient():
    figure = draw("fig13", slips=[slips(), slips(n_blocks=20, normal_load_N=800.0)])
    assert not figure.axes[0].child_axes
    assert key(figure)[:2] == [
        rf"$\theta = 0$, $N = {n}$, $F_Z = {load}$ N: 9 events" for n, load in ((10, 400), (20, 800))
    ]


def test_the_friction_coefficient_is_a_mean_where_there_are_several_scenes():
    for scenes, said in ((["fig10"], "$"), (["fig10", "fig12"], "mean $")):
        numbers = pd.DataFrame({"scene": scenes, "mu_sapp": 0.49, "is_papers": True})
        tables = [slips(theta=theta) for theta in (0.0, 5 / 6)[: len(scenes)]]
        figure = draw("fig13", slips=tables, mu_sapp=numbers, scenes=scenes)
        (text,) = (t.get_text() for t in figure.axes[0].texts if "mu" in t.get_text())
        assert text.startswith(said)


def test_two_scenes_with_the_same_sign_of_theta_have_different_outlines():
    figure = draw("fig13", slips=[slips(theta=0.2), slips(theta=0.4)])
    assert [len(markers(figure, outline)) for outline in "os"] == [1, 1]


def test_scenes_without_a_global_slip_or_any_slip_or_a_known_theta_are_drawn():
    without = slips()[lambda table: ~table["is_global"]]
    tables = [without, slips([], []), slips([1], [5.0], theta=np.nan)]
    figure = draw("fig13", slips=tables, mu_sapp=None)
    assert key(figure)[:2] == [
        r"$\theta = 0$: 8 events, no global slip",
        r"$\theta$ unknown: 1 event, no global slip",
    ]
