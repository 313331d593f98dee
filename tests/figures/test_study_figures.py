"""Figures of the studies show the columns of their tables, and failures as failures."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from figures import examples
from figures.examples import THETAS, draw
from matplotlib.colors import to_hex

from precursors.accuracy.failures import FAILURE_MODES
from precursors.figures import style
from precursors.figures.failure_gallery import PANELS, pretty
from precursors.methods import METHODS, Method, with_looks

RULES = Path(__file__).parents[2] / "workflow/rules"


def points(axes, name):
    """Points of the line that has a label or an id."""
    (line,) = [line for line in axes.lines if name in (line.get_label(), line.get_gid())]
    return [(float(x), float(y)) for x, y in line.get_xydata()]


def words(axes):
    return " ".join(text.get_text() for text in axes.texts)


def key(owner):
    legend = owner.legends[0] if hasattr(owner, "legends") else owner.get_legend()
    return [text.get_text() for text in legend.get_texts()]


@pytest.fixture(scope="module", name="figure")
def work_precision_figure():
    return draw("work_precision")


@pytest.fixture(scope="module", name="gallery")
def failure_gallery_figure():
    return draw("failure_gallery")


class TestWorkPrecision:
    def panels(self, figure):
        """A row for each theta: wrong sequences and errors of loads, of times, and the part right."""
        return np.array(figure.axes).reshape(5, -1).T

    def test_errors_of_right_sequences_are_over_the_time_to_the_first_global_slip(self, figure):
        assert [axes.get_title() for axes in figure.axes[:3]] == list(map(style.theta_text, THETAS.values()))
        for _, load, _, time, _ in self.panels(figure):
            assert points(load, "rk4 right") == [(20.0, 1e-1), (200.0, 1e-2), (2000.0, 1e-3)]
            assert points(time, "rk4 right") == [(200.0, 1e-4), (2000.0, 1e-5)]
            assert points(load, "exact right") == [(1.0, 1e-12)]

    def test_wrong_sequences_are_in_the_bands_as_high_as_their_wrong_part(self, figure):
        for slips, load, transitions, time, _ in self.panels(figure):
            assert points(slips, "rk4 wrong") == [(2.0, pytest.approx(0.6))]
            assert points(transitions, "rk4 wrong") == [(2.0, 0.8), (20.0, pytest.approx(0.4))]
            assert points(slips, "scipy_rk45 wrong") == [(100.0, 0.9)]
            for axes in (load, time):
                assert not [line for line in axes.lines if line.get_gid().endswith("wrong")]

    def test_the_part_that_is_right_is_over_the_time_of_the_whole_run(self, figure):
        right = self.panels(figure)[1, -1]
        assert points(right, "rk4 right") == [(1000.0, 1.0), (10000.0, 1.0)]
        assert points(right, "rk4 wrong") == [(10.0, 0.2), (100.0, 0.6)]
        assert right.get_xlabel() == "Wall time for the whole run [ms]"

    def test_without_whole_runs_it_is_that_to_the_first_global_slip(self):
        figure = draw("work_precision", **examples.work_precision((0.0,), ("global slip",)))
        assert points(figure.axes[-1], "rk4 wrong") == [(2.0, 0.2), (20.0, 0.6)]
        assert figure.axes[-1].get_xlabel() == "Wall time to the end of the first global slip [ms]"

    def test_a_wrong_sequence_is_open_and_joined_to_nothing(self, figure):
        lines = {line.get_gid(): line for line in self.panels(figure)[0, -1].lines}
        assert lines["rk4 right"].get_linestyle() == "-"
        assert lines["rk4 right"].get_markerfacecolor() == lines["rk4 right"].get_color()
        assert lines["rk4 wrong"].get_linestyle() == "None"
        assert lines["rk4 wrong"].get_markerfacecolor() == "none"

    def test_a_transition_too_many_makes_the_sequence_wrong(self):
        table = examples.work_precision((0.0,))["table"].assign(transitions_found=101)
        slips, load, transitions, time, right = draw("work_precision", table=table).axes
        assert (points(slips, "exact wrong"), len(points(load, "exact right"))) == ([], 1)
        for wrong, axes in ((transitions, time), (right, right)):
            assert points(axes, "exact right") == []
            assert len(points(wrong, "exact wrong")) == 1

    def test_an_error_that_is_none_is_not_drawn(self):
        table = examples.work_precision((0.0,))["table"].assign(error_load_N=0.0)
        assert points(draw("work_precision", table=table).axes[1], "exact right") == []

    def test_every_method_has_a_colour_and_a_marker_of_its_own(self):
        new = (Method(name, name, "step [s]", METHODS["rk4"].solve, (1e-6,)) for name in ("first", "second"))
        every = list(with_looks([*METHODS.values(), *new]))
        for looks in zip(*((method.color, method.marker) for method in every), strict=True):
            assert len(set(looks)) == len(every)

    def test_evaluations_are_drawn_where_they_are_counted(self):
        load = draw("work_precision", work="evaluations").axes[3]
        assert points(load, "rk4 right") == [(2e3, 1e-1), (2e4, 1e-2), (2e5, 1e-3)]
        assert "exact right" not in [line.get_gid() for line in load.lines]

    def test_the_key_names_the_methods_of_the_table(self, figure):
        assert key(figure) == [
            "label of exact",
            "label of rk4",
            "label of scipy_rk45",
            "open: wrong sequence",
        ]

    def test_all_methods_fit_into_the_key(self):
        (row,) = examples.work_precision((0.0,), ("end",))["table"].head(1).to_dict("records")
        looks = [(m.name, m.label, m.color, m.marker) for m in METHODS.values()]
        rows = [row | dict(zip(("method", "label", "color", "marker"), look, strict=True)) for look in looks]
        figure = draw("work_precision", table=pd.DataFrame(rows))
        box, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
        assert min(box.x0, box.y0) >= 0
        assert (box.x1, box.y1) <= (width, height)


def test_points_of_the_step_sweep_are_green_only_where_every_transition_is_right():
    figure = draw("step_sweep")
    assert [axes.get_title() for axes in figure.axes[:3]] == list(map(style.theta_text, THETAS.values()))
    wrong = "RK4, waits in closed form: some transition wrong"
    for row, exact in zip(np.reshape(figure.axes, (3, 3)), (5.0, 0.5, 100.0), strict=True):
        for axes in row:
            assert points(axes, "all transitions right") == [(1e-7, exact)]
            assert {y for _, y in points(axes, "exact")} == {exact}
            assert [x for x, _ in points(axes, wrong)] == [1e-5, 1e-6]
    assert [y for _, y in points(figure.axes[0], wrong)] == [7, 6]
    assert points(figure.axes[6], "RK4, every step") == [(1e-5, 20)]


class TestFailureGallery:
    def test_panels_failure_modes_and_rule_have_the_same_order(self):
        rule = (RULES / "accuracy.smk").read_text(encoding="utf-8")
        listed = re.findall(r'"(\w+)"', rule.partition("FAILURE_MODES = [")[2].partition("]")[0])
        assert list(PANELS) == list(FAILURE_MODES) == listed

    def test_thresholds_of_ten_blocks_are_marked_measured_and_predicted(self, gallery):
        place = 0
        for panel, axes in zip(PANELS.values(), gallery.axes, strict=True):
            marks = [line.get_xdata()[0] for line in axes.lines if line.get_transform() != axes.transData]
            own = place + np.arange(len(panel.limits))
            assert marks == pytest.approx(np.column_stack([own + 3.75, own + 1.25]).ravel())
            place += len(own)

    def test_every_axis_has_two_labels_at_least(self, gallery):
        gallery.draw_without_rendering()
        for mode, axes in zip(PANELS, gallery.axes, strict=True):
            for axis in (axes.xaxis, axes.yaxis):
                low, high = sorted(axis.get_view_interval())
                ticks = [
                    t for t in axis.get_major_ticks() if t.label1.get_text() and low <= t.get_loc() <= high
                ]
                assert len(ticks) >= 2, (mode, axis.axis_name)

    def test_curves_are_those_of_the_tables_in_the_units_of_the_axes(self, gallery):
        for axes in gallery.axes:
            np.testing.assert_allclose(points(axes, "bad"), [(0.1, 0.2), (0.2, 0.4), (0.4, 0.8)])
            colors = {line.get_label(): to_hex(line.get_color()) for line in axes.lines}
            assert (colors["exact"], colors["bad"]) == (style.BLACK, style.VERMILION.lower())

    @pytest.mark.parametrize(
        ("text", "mathematics"),
        [
            ("dt = 1e-07 s", r"$\Delta t$ = $10^{-7}$ s"),
            ("1.0e-10 s", "$10^{-10}$ s"),
            ("1.2e-10 s", r"$1.2\times10^{-10}$ s"),
            ("21e-10", r"$21\times10^{-10}$"),
            ("0.35 s", "0.35 s"),
        ],
    )
    def test_powers_of_ten_are_written_as_mathematics(self, text, mathematics):
        assert pretty(text) == mathematics


def test_the_horizon_marks_until_when_the_tolerance_is_met_and_where_the_order_is_lost():
    kept, lost, exponents = draw("horizon").axes[:3]
    assert (kept.get_title(), lost.get_title()) == (r"$\theta = -5/6$", r"$\theta = 5/6$, $V$ = 10 mm/s")
    for axes, times in ((kept, []), (lost, [0.12, 0.14])):
        ends = [line.get_xdata() for line in axes.lines if len(line.get_xdata()) == 2]
        assert [start for start, end in ends if start == end] == times
    assert [list(line.get_xydata()[0]) for line in lost.lines if line.get_marker() == "x"] == [[0.15, 1e-10]]
    assert [label.get_text() for label in exponents.get_yticklabels()] == [
        r"$\theta = -5/6$",
        r"$\theta = 0$",
    ]


def test_every_run_of_the_window_is_a_dot_at_its_change_of_theta():
    dots = draw("theta_window").axes[0].lines[0]
    assert dots.get_xdata().tolist() == pytest.approx([-100, -50, 0, 50, 100])


def test_counts_over_the_noise_are_shares_of_the_noisy_runs():
    shares = draw("noise").axes[1].lines[0]
    assert shares.get_xydata().tolist() == [[14.0, 0.25], [15.0, 0.75]]


def test_a_cell_of_the_map_is_the_run_at_its_place():
    figure = draw("friction_map")
    meshes = [axes.collections[0] for axes in figure.axes[:3]]
    counts, mu_sapp, share = (np.ma.filled(mesh.get_array().astype(float), np.nan) for mesh in meshes)
    expected = [[0.1 * v - 0.5, 0.1 * v + 0.5] for v in (1.0, 2.0, 3.0)]
    np.testing.assert_allclose(np.reshape(mu_sapp, (3, 2)), expected)
    np.testing.assert_allclose(np.ravel(share), 25.0)
    assert np.isnan(np.ravel(counts)).tolist() == [True] + [False] * 5
    for axes, mesh in zip(figure.axes[:3], meshes, strict=True):
        assert all(tuple(line.get_xydata()[0]) == (0.25, 2.0) for line in axes.lines)
        below, above = mesh.get_coordinates()[1:3, 0, 1]
        assert (below + above) / 2 == pytest.approx(2.0)


def test_lines_of_the_resolution_are_medians_both_counts_and_the_papers_n():
    figure = draw("resolution")
    values = (100.0, 0.5, 2.7, 1.0)  # the front speed in km/s
    for axes, value in zip(figure.axes, values, strict=True):
        assert axes.lines[0].get_ydata() == pytest.approx([value] * 3)
        assert [12, 12] in [list(line.get_xdata()) for line in axes.lines]
        dots = next(line for line in axes.lines if line.get_marker() == ".")
        assert dots.get_xdata().tolist() == [2]  # the others are not predictable
    assert [300.0] * 3 in [list(line.get_ydata()) for line in figure.axes[0].lines]
    assert [1.44, 1.44] in [list(line.get_ydata()) for line in figure.axes[3].lines]


def test_counts_and_ratios_beside_the_law_are_the_tables():
    counts, ratios, rises = draw("event_law").axes
    assert [tuple(line.get_xydata()[0]) for line in counts.lines[:4]] == [(20.0, 16.0)] * 4
    assert ratios.lines[0].get_ydata().tolist() == [0.8, 0.8]
    [bars] = ratios.collections
    np.testing.assert_allclose([segment[:, 1] for segment in bars.get_segments()], [[0.7, 0.9]] * 2)
    assert rises.lines[0].get_ydata().tolist() == [1.25, 1.25]


def test_a_cell_of_the_model_comparison_has_range_largest_error_and_median_time():
    (axes,) = draw("model_comparison").axes
    texts = [text.get_text() for text in axes.texts]
    assert texts[:6] == ["0.45", "8 %", "1.1 µs", "0.48\N{EN DASH}0.49", "exact", "2 ms"]
    heads = [label.get_text() for label in axes.get_xticklabels()]
    assert heads == ["front\nlaw", "paper's\nchain"]
    assert len([patch for patch in axes.patches if not patch.get_fill()]) == 2  # a frame for each question


def test_a_row_of_the_definitions_names_what_a_reading_changes():
    (axes,) = draw("definitions").axes
    seven, eight = (
        [f"{n}   0.500", f"{n}   -", f"{n}   0.500", six] for n, six in ((7, "4 of 6"), (8, "1 of 6"))
    )
    assert [text.get_text() for text in axes.texts] == [*seven, *seven, *eight]
    assert [label.get_text() for label in axes.get_yticklabels()] == [
        "our reading",
        "global slip: in which F_X drops by more than 3 N",
        "|theta|: 0.9",
    ]
