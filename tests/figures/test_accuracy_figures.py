"""The charts of speed and accuracy show what their tables say, failures as failures."""

from __future__ import annotations

import itertools

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from precursors.figures import style
from precursors.figures.growth import draw_growth, read_growth
from precursors.figures.work_precision import COLUMNS, Work, draw_work_precision, read_work_precision
from precursors.methods import METHODS

THETAS = (-5 / 6, 0.0, 5 / 6)
ALL, ALL_SLIPS = 100, 10
# Method, seconds, error of the load, of the time, transitions right, slips right; as many found as there are.
POINTS = [
    ("exact", 1e-3, 1e-12, 1e-15, ALL, ALL_SLIPS),
    ("rk4", 2e-3, 2.0, 1e-2, 20, 4),
    ("rk4", 2e-2, 1e-1, 1e-3, 60, ALL_SLIPS),
    ("rk4", 2e-1, 1e-2, 1e-4, ALL, ALL_SLIPS),
    ("rk4", 2e0, 1e-3, 1e-5, ALL, ALL_SLIPS),
    ("scipy_rk45", 1e-1, 0.0, np.nan, 0, 1),
]


# Of methods whose package may be missing.
FULL_LABELS = {
    "heyoka": "heyoka.py, Taylor series",
    "cvode_adams": "SUNDIALS CVODE, Adams",
    "cvode_bdf": "SUNDIALS CVODE, BDF",
}


def methods_table(thetas=THETAS, extents=("global slip", "end")) -> pd.DataFrame:
    rows = [
        {
            "theta": theta,
            "until": until,
            "method": method,
            "label": f"label of {method}",
            "value": 1e-6,
            "evaluations": np.nan if method == "exact" else 1e5 * seconds,
            "seconds": seconds if until == "global slip" else 5 * seconds,
            "error_load_N": load,
            "error_time_s": time,
            "transitions_right": right,
            "transitions_found": ALL,
            "transitions_true": ALL,
            "slips_right": slips,
            "slips_found": ALL_SLIPS,
            "slips_true": ALL_SLIPS,
        }
        for theta, until, (method, seconds, load, time, right, slips) in itertools.product(
            thetas, extents, POINTS
        )
    ]
    return pd.DataFrame(rows)


def one_theta(**options) -> pd.DataFrame:
    return methods_table(thetas=(0.0,), **options)


def panels(figure: Figure) -> np.ndarray:
    return np.array(figure.axes).reshape(3, -1)


def points(axes: Axes, name: str) -> list[tuple[float, float]]:
    (line,) = [line for line in axes.lines if line.get_gid() == name]
    return [(float(x), float(y)) for x, y in line.get_xydata()]


def line_of(axes: Axes, name: str) -> Line2D:
    (line,) = [line for line in axes.lines if line.get_gid() == name]
    return line


@pytest.fixture(scope="module")
def figure() -> Figure:
    return draw_work_precision(methods_table())


class TestWorkPrecision:
    def test_there_is_a_column_for_each_theta_in_order(self, figure: Figure) -> None:
        titles = [axes.get_title() for axes in panels(figure)[0]]
        assert titles == [style.theta_text(theta) for theta in THETAS]

    @pytest.mark.parametrize("column", range(3))
    def test_errors_are_over_the_time_to_the_first_global_slip(self, figure: Figure, column: int) -> None:
        load, time, _ = panels(figure)[:, column]
        assert points(load, "rk4 right") == [(20.0, 1e-1), (200.0, 1e-2), (2000.0, 1e-3)]
        assert points(time, "rk4 right") == [(200.0, 1e-4), (2000.0, 1e-5)]
        assert points(load, "exact right") == [(1.0, 1e-12)]

    def test_the_part_that_is_right_is_over_the_time_of_the_whole_run(self, figure: Figure) -> None:
        right = panels(figure)[2, 1]
        assert points(right, "rk4 right") == [(1000.0, 1.0), (10000.0, 1.0)]
        assert points(right, "rk4 wrong") == [(10.0, 0.2), (100.0, 0.6)]
        assert points(right, "scipy_rk45 wrong") == [(500.0, 0.0)]
        assert right.get_title() == f"{ALL} transitions"
        assert right.get_xlabel() == "Wall time for the whole run [ms]"

    def test_without_whole_runs_it_is_that_to_the_first_global_slip(self) -> None:
        right = panels(draw_work_precision(one_theta(extents=("global slip",))))[2, 0]
        assert points(right, "rk4 wrong") == [(2.0, 0.2), (20.0, 0.6)]
        assert right.get_xlabel() == "Wall time to the end of the first global slip [ms]"

    def test_a_wrong_sequence_is_open_and_joined_to_nothing(self, figure: Figure) -> None:
        for axes in figure.axes:
            right, wrong = line_of(axes, "rk4 right"), line_of(axes, "rk4 wrong")
            assert right.get_linestyle() == "-"
            assert to_hex(right.get_markerfacecolor()) == style.GREEN.lower()
            assert wrong.get_linestyle() == "None"
            assert wrong.get_markerfacecolor() == "none"
        load, time, _ = panels(figure)[:, 0]
        assert points(load, "rk4 wrong") == [(2.0, 2.0)]
        assert points(time, "rk4 wrong") == [(2.0, 1e-2), (20.0, 1e-3)]

    def test_a_transition_too_many_makes_the_sequence_wrong(self) -> None:
        table = one_theta().assign(transitions_found=ALL + 1)
        load, time, right = panels(draw_work_precision(table))[:, 0]
        for axes in (time, right):
            assert points(axes, "exact right") == []
            assert len(points(axes, "exact wrong")) == 1
        assert len(points(load, "exact right")) == 1

    def test_an_error_that_is_none_or_unknown_is_not_drawn(self, figure: Figure) -> None:
        load, time, _ = panels(figure)[:, 0]
        assert points(load, "scipy_rk45 wrong") == []
        assert points(time, "scipy_rk45 wrong") == []

    def test_a_run_that_fails_at_once_does_not_set_the_scale(self) -> None:
        table = one_theta()
        table.loc[table["method"] == "scipy_rk45", "error_load_N"] = 1e-30
        load, _, _ = panels(draw_work_precision(table))[:, 0]
        assert 1e-14 < load.get_ylim()[0] < 1e-12

    def test_evaluations_are_drawn_where_they_are_counted(self) -> None:
        figure = draw_work_precision(one_theta(), Work.EVALUATIONS)
        load, _, right = panels(figure)[:, 0]
        assert points(load, "rk4 right") == [(2e3, 1e-1), (2e4, 1e-2), (2e5, 1e-3)]
        assert not [line for line in load.lines if line.get_gid() == "exact right"]
        assert right.get_xlabel() == "Evaluations of the forces for the whole run"

    def test_the_legend_names_the_methods_that_are_there_and_no_other(self, figure: Figure) -> None:
        (legend,) = figure.legends
        assert [text.get_text() for text in legend.get_texts()] == [
            "label of exact",
            "label of scipy_rk45",
            "label of rk4",
            "open: wrong sequence",
        ]

    def test_a_method_that_is_not_known_here_is_drawn_too(self) -> None:
        table = one_theta().replace({"method": {"rk4": "mine"}})
        assert len(points(panels(draw_work_precision(table))[0, 0], "mine right")) == 3

    def test_nothing_leaves_the_paper_with_all_methods_in_the_legend(self) -> None:
        (row,) = one_theta().query("method == 'exact' and until == 'end'").to_dict("records")
        names = {method.name: method.label for method in METHODS.values()} | FULL_LABELS
        figure = draw_work_precision(
            pd.DataFrame([row | {"method": name, "label": label} for name, label in names.items()])
        )
        box = figure.get_tightbbox()
        width, height = figure.get_size_inches()
        assert min(box.x0, box.y0) >= 0
        assert box.x1 <= width
        assert box.y1 <= height

    def test_a_table_is_read_as_it_was_written(self, tmp_path) -> None:
        methods_table().to_csv(tmp_path / "table.csv", index=False)
        pd.testing.assert_frame_equal(read_work_precision(tmp_path / "table.csv"), methods_table())

    @pytest.mark.parametrize("column", COLUMNS)
    def test_a_missing_column_is_named(self, tmp_path, column: str) -> None:
        methods_table().drop(columns=column).to_csv(tmp_path / "table.csv", index=False)
        with pytest.raises(ValueError, match=f"column {column} is missing"):
            read_work_precision(tmp_path / "table.csv")

    def test_a_table_without_rows_is_refused(self, tmp_path) -> None:
        methods_table().iloc[:0].to_csv(tmp_path / "table.csv", index=False)
        with pytest.raises(ValueError, match="has no rows"):
            read_work_precision(tmp_path / "table.csv")


class TestGrowth:
    table = pd.DataFrame(
        {
            "kind": ["natural", "driven", "driven", "natural", "front"],
            "n_blocks": [10, 100, 10, 100, 100],
            "seconds_per_transition": [2e-6, 5e-6, 3e-6, 4e-6, 9e-6],
        }
    )

    def test_there_is_a_line_for_each_kind_in_microseconds(self) -> None:
        (axes,) = draw_growth(self.table).axes
        drawn = {line.get_label(): line.get_xydata().tolist() for line in axes.lines}
        assert [*drawn] == ["natural start", "strained, fast drive", "first front through all blocks"]
        np.testing.assert_allclose(drawn["natural start"], [[10, 2], [100, 4]])
        np.testing.assert_allclose(drawn["strained, fast drive"], [[10, 3], [100, 5]])
        np.testing.assert_allclose(drawn["first front through all blocks"], [[100, 9]])

    def test_the_sizes_measured_are_the_ticks(self) -> None:
        (axes,) = draw_growth(self.table).axes
        assert [tick.get_text() for tick in axes.get_xticklabels()] == ["10", "100"]

    def test_an_unknown_kind_is_refused(self) -> None:
        with pytest.raises(ValueError, match="'falling': allowed are natural, driven, front"):
            draw_growth(self.table.replace({"kind": {"front": "falling"}}))

    def test_a_missing_column_is_named(self, tmp_path) -> None:
        self.table.drop(columns="kind").to_csv(tmp_path / "table.csv", index=False)
        with pytest.raises(ValueError, match="column kind is missing"):
            read_growth(tmp_path / "table.csv")
