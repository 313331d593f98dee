"""The failure gallery and the step sweep carry what their tables say, and nothing leaves the paper."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from precursors.accuracy.failures import WAYS
from precursors.figures import style
from precursors.figures.failure_gallery import PANELS, draw_failure_gallery, pretty, read_numbers
from precursors.figures.step_sweep import draw_step_sweep, read_step_sweep

THETAS = {"fig11": -5 / 6, "fig10": 0.0, "fig12": 5 / 6}


def numbers() -> pd.DataFrame:
    """Numbers that can be told apart, one for each address: 1.25, 2.25 ... and exact values 2.75, 3.75 ..."""
    addresses = [
        (way, line.method or "a method", line.knob or "dt = 1e-07 s", line.quantity)
        for way, panel in PANELS.items()
        for line in panel.sentences
    ]
    table = pd.DataFrame(list(dict.fromkeys(addresses)), columns=["way", "method", "knob", "quantity"])
    row = np.arange(len(table))
    return table.assign(unit="1", value=row + 1.25, exact=row + 2.75)


def curves() -> dict[str, pd.DataFrame]:
    x = np.array([0.1, 0.2, 0.4])
    table = pd.concat(
        [
            pd.DataFrame({"curve": name, "x": x, "y": factor * x})
            for name, factor in (("exact", 1), ("bad", 2))
        ]
    )
    return dict.fromkeys(PANELS, table)


def sweep_table() -> pd.DataFrame:
    rows = [
        (scene, theta, method, step, kept, 0.1 * kept, 2.0, right, 10)
        for scene, theta in THETAS.items()
        for method, step, kept, right in (
            ("exact", np.nan, 5, 10),
            ("rk4_skip", 1e-5, 7, 3),
            ("rk4_skip", 1e-7, 5, 10),
            ("rk4_skip", 1e-6, 6, 4),
            ("rk4", 1e-5, 8, 2),
        )
    ]
    columns = ["scene", "theta", "method", "step_s", "events_kept", "mu_sapp", "global_slip_time_s"]
    return pd.DataFrame(rows, columns=[*columns, "transitions_right", "transitions_true"])


@pytest.fixture(scope="module")
def gallery() -> Figure:
    return draw_failure_gallery(numbers(), curves())


@pytest.fixture(scope="module")
def sweep_figure() -> Figure:
    return draw_step_sweep(sweep_table())


def words(axes) -> str:
    return " ".join(text.get_text() for text in axes.texts)


class TestGallery:
    def test_there_is_a_panel_for_every_way_to_fail_in_their_order(self) -> None:
        assert list(PANELS) == [way.name for way in WAYS]

    def test_the_rule_lists_every_way_to_fail_in_their_order(self) -> None:
        rules = Path(__file__).parents[2] / "workflow/rules/failures.smk"
        listed = rules.read_text(encoding="utf-8").partition("WAYS_TO_FAIL = [")[2].partition("]")[0]
        assert [line.strip(' ",') for line in listed.split("\n") if line.strip()] == list(PANELS)

    def test_every_panel_prints_a_number_of_its_own_rows(self, gallery: Figure) -> None:
        table = numbers()
        table["value"] += 77777.0
        others = draw_failure_gallery(table, curves())
        for way, before, after in zip(PANELS, gallery.axes, others.axes, strict=True):
            assert words(before) != words(after), way

    def test_numbers_stand_as_they_are_in_the_table(self, gallery: Figure) -> None:
        assert "1.250; theory" in words(gallery.axes[0])
        assert "2.750" in words(gallery.axes[0])
        table = numbers()
        [row] = table.index[
            (table["way"] == "merged_transitions") & (table["quantity"] == "transitions right")
        ]
        assert f"{row + 1.25:.0f} of {row + 2.75:.0f} transitions right" in words(gallery.axes[10])

    def test_every_axis_has_two_labels_at_least(self, gallery: Figure) -> None:
        gallery.draw_without_rendering()
        for way, axes in zip(PANELS, gallery.axes, strict=True):
            for axis in (axes.xaxis, axes.yaxis):
                low, high = sorted(axis.get_view_interval())
                read = [
                    t for t in axis.get_major_ticks() if t.label1.get_text() and low <= t.get_loc() <= high
                ]
                assert len(read) >= 2, (way, axis.axis_name)

    def test_titles_of_a_row_stand_at_the_same_height(self, gallery: Figure) -> None:
        heights = {axes.texts[-1].xyann[1] for axes in gallery.axes}
        assert len(heights) == 1

    def test_numbers_are_found_whatever_the_order_of_the_rows(self, gallery: Figure) -> None:
        others = draw_failure_gallery(numbers()[::-1], curves())
        assert [words(axes) for axes in others.axes] == [words(axes) for axes in gallery.axes]

    def test_a_number_that_is_there_twice_is_refused(self) -> None:
        table = numbers()
        twice = pd.concat([table, table[table["way"] == "stiffness"].assign(knob="another")])
        with pytest.raises(ValueError, match=r"stiffness: 2 numbers are 'fastest rate': needed is one"):
            draw_failure_gallery(twice, curves())

    def test_every_sentence_finds_its_number_in_the_numbers_of_its_way(self) -> None:
        way = next(way for way in WAYS if way.name == "stiffness")
        table = pd.DataFrame(map(asdict, way.measure().numbers))
        for line in PANELS[way.name].sentences:
            assert line.find(table)["quantity"] == line.quantity

    def test_curves_are_those_of_the_tables_in_the_units_of_the_axes(self, gallery: Figure) -> None:
        for axes, (way, panel) in zip(gallery.axes, PANELS.items(), strict=True):
            lines = {line.get_label(): line for line in axes.lines}
            np.testing.assert_allclose(lines["bad"].get_xdata(), np.array([0.1, 0.2, 0.4]) * panel.scale[0])
            np.testing.assert_allclose(
                lines["bad"].get_ydata(), np.array([0.2, 0.4, 0.8]) * panel.scale[1], err_msg=way
            )
            assert to_hex(lines["exact"].get_color()) == style.BLACK
            assert to_hex(lines["bad"].get_color()) == style.VERMILION.lower()

    def test_no_text_leaves_the_paper_or_runs_into_the_next_panel(self, gallery: Figure) -> None:
        gallery.draw_without_rendering()
        page = gallery.bbox
        for axes in gallery.axes:
            right = min(
                [page.x1]
                + [
                    text.get_window_extent().x0
                    for other in gallery.axes
                    if other.get_subplotspec().rowspan == axes.get_subplotspec().rowspan
                    and other.get_position().x0 > axes.get_position().x1
                    for text in other.texts
                ]
            )
            for text in axes.texts:
                box = text.get_window_extent()
                assert page.x0 <= box.x0 <= box.x1 <= right, text.get_text()
                assert page.y0 <= box.y0 <= box.y1 <= page.y1, text.get_text()

    def test_a_missing_number_or_curve_is_named(self) -> None:
        table, some = numbers(), curves()
        with pytest.raises(ValueError, match="creep: 0 numbers are"):
            draw_failure_gallery(table[table["way"] != "creep"], some)
        del some["stiffness"]
        with pytest.raises(ValueError, match="stiffness: "):
            draw_failure_gallery(table, some)

    def test_numbers_without_a_right_value_are_read(self, tmp_path: Path) -> None:
        table = numbers()
        table.loc[3, "exact"] = np.nan
        table.to_csv(tmp_path / "failures.csv", index=False)
        pd.testing.assert_frame_equal(read_numbers(tmp_path / "failures.csv"), table)
        table.drop(columns="knob").to_csv(tmp_path / "failures.csv", index=False)
        with pytest.raises(ValueError, match="column knob is missing"):
            read_numbers(tmp_path / "failures.csv")

    @pytest.mark.parametrize(
        ("text", "mathematics"),
        [
            ("dt = 1e-07 s", r"$\Delta t$ = $10^{-7}$ s"),
            ("2.3e+10 /s", r"$2.3\times10^{10}$ /s"),
            ("1.0e-10 s", "$10^{-10}$ s"),
            ("1.2e-10 s", r"$1.2\times10^{-10}$ s"),
            ("21e-10", r"$21\times10^{-10}$"),
            ("0.35 s", "0.35 s"),
        ],
    )
    def test_powers_of_ten_are_written_as_mathematics(self, text: str, mathematics: str) -> None:
        assert pretty(text) == mathematics


class TestStepSweep:
    def test_each_scene_has_its_column_in_the_order_of_the_table(self, sweep_figure: Figure) -> None:
        titles = [axes.get_title() for axes in sweep_figure.axes[:3]]
        assert titles == [style.theta_text(theta) for theta in THETAS.values()]

    def test_lines_are_the_exact_values(self, sweep_figure: Figure) -> None:
        for axes, exact in zip(sweep_figure.axes, np.repeat([5.0, 0.5, 100.0], 3), strict=True):
            line = next(line for line in axes.lines if line.get_label() == "exact")
            assert set(line.get_ydata()) == {exact}

    def test_points_are_green_only_where_every_transition_is_right(self, sweep_figure: Figure) -> None:
        for axes in sweep_figure.axes[:3]:
            drawn = {line.get_label(): line for line in axes.lines}
            right = drawn["all transitions right"]
            assert right.get_xdata().tolist() == [1e-7]
            assert to_hex(right.get_color()) == style.GREEN.lower()
            wrong = drawn["RK4, waits in closed form: some transition wrong"]
            assert wrong.get_xdata().tolist() == [1e-5, 1e-6]
            assert wrong.get_ydata().tolist() == [7, 6]
            assert drawn["RK4, every step"].get_ydata().tolist() == [8]

    def test_the_last_row_is_in_per_cent(self, sweep_figure: Figure) -> None:
        drawn = {line.get_label(): line for line in sweep_figure.axes[6].lines}
        assert drawn["RK4, every step"].get_ydata().tolist() == [20]

    def test_a_scene_without_an_exact_value_is_refused(self) -> None:
        table = sweep_table()
        with pytest.raises(ValueError, match="scene fig12 has no exact value"):
            draw_step_sweep(table[~((table["method"] == "exact") & (table["scene"] == "fig12"))])

    def test_the_table_is_read_with_its_types(self, tmp_path: Path) -> None:
        sweep_table().to_csv(tmp_path / "sweep.csv", index=False)
        pd.testing.assert_frame_equal(read_step_sweep(tmp_path / "sweep.csv"), sweep_table())


def test_drawing_twice_gives_the_same_bytes(gallery: Figure, sweep_figure: Figure, tmp_path: Path) -> None:
    for first, second in (
        (gallery, draw_failure_gallery(numbers(), curves())),
        (sweep_figure, draw_step_sweep(sweep_table())),
    ):
        for figure, name in ((first, "a"), (second, "b")):
            style.save(figure, tmp_path / f"{name}.svg")
        assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
