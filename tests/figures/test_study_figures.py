"""Figures of the studies show the columns of their tables, and failures as failures."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from figures import examples
from figures.examples import draw

from precursors.accuracy.failures import FAILURE_MODES
from precursors.ensembles.event_law import THETAS
from precursors.figures.event_law import THETA_COLORS
from precursors.figures.failure_gallery import PANELS, pretty
from precursors.methods import METHODS, SPARE, Method, with_looks

RULES = Path(__file__).parents[2] / "workflow/rules"


def points(axes, name):
    """Points of the line that has a label or an id."""
    (line,) = [line for line in axes.lines if name in (line.get_label(), line.get_gid())]
    return [(float(x), float(y)) for x, y in line.get_xydata()]


class TestWorkPrecision:
    def test_without_whole_runs_it_is_that_to_the_first_global_slip(self):
        figure = draw("work_precision", **examples.work_precision((0.0,), ("global slip",)))
        assert points(figure.axes[-1], "rk4 wrong") == [(2.0, 0.2), (20.0, 0.6)]
        assert figure.axes[-1].get_xlabel() == "Wall time to the end of the first global slip [ms]"

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
        chosen = replace(METHODS["rk4"], name="with a spare colour", look=(SPARE[0][0], "$P$"))
        every = list(with_looks([*METHODS.values(), chosen, *new]))
        for looks in zip(*(method.look for method in every), strict=True):
            assert len(set(looks)) == len(every)

    def test_evaluations_are_drawn_where_they_are_counted(self):
        load = draw("work_precision", work="evaluations").axes[3]
        assert points(load, "rk4 right") == [(2e3, 1e-1), (2e4, 1e-2), (2e5, 1e-3)]
        assert "exact right" not in [line.get_gid() for line in load.lines]

    def test_all_methods_fit_into_the_key(self):
        (row,) = examples.work_precision((0.0,), ("end",))["table"].head(1).to_dict("records")
        looks = [(m.name, m.label, *m.look) for m in METHODS.values()]
        rows = [row | dict(zip(("method", "label", "color", "marker"), look, strict=True)) for look in looks]
        figure = draw("work_precision", table=pd.DataFrame(rows))
        box, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
        assert min(box.x0, box.y0) >= 0
        assert (box.x1, box.y1) <= (width, height)


class TestFailureGallery:
    def test_panels_failure_modes_and_rule_have_the_same_order(self):
        rule = (RULES / "accuracy.smk").read_text(encoding="utf-8")
        listed = re.findall(r'"(\w+)"', rule.partition("FAILURE_MODES = [")[2].partition("]")[0])
        assert list(PANELS) == list(FAILURE_MODES) == listed

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


def test_each_theta_of_the_law_of_events_has_a_colour_and_a_marker():
    assert tuple(THETA_COLORS) == THETAS
