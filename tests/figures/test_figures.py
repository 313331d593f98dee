"""The figures carry what the tables say, and drawing a table twice gives the same bytes."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import FillBetweenPolyCollection, LineCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from precursors import figures
from precursors.figures import style
from precursors.figures.chain_schematic import draw_chain_schematic
from precursors.figures.precursor_lengths import PrecursorLengths, draw_precursor_lengths
from precursors.figures.scene import GLOBAL, MOST_ARROWS, PARTIAL, draw_scene

N_BLOCKS = 10
LENGTH_M = 0.1
NORMAL_LOAD_N = 400.0
LOADING_RATE = 80.0
FRONTS = [1, 2, 3, 4, 5, 2, 6, 4, 3, 8, 3, 9, 8, 3, 1, 10]
LOADS_N = [28.00, 47.38, 64.98, 78.96, 92.72, 99.38, 112.89, 118.37, 129.04, 142.13, 149.68, 164.73, 164.39]
LOADS_N += [170.02, 174.92, 194.31]
N_KEPT = 9
FIRST_GLOBAL_S = 2.739

# Positions pass through no arithmetic but a unit conversion.
ROUNDING = 1e-12


def slip_table(fronts: list[int], loads_N: list[float], drop_N: float = 1.5) -> pd.DataFrame:
    """Slips of a load that grows at 80 N/s and drops by the same amount in each; front N is a global slip."""
    front, load = np.array(fronts, dtype=int), np.array(loads_N, dtype=float)
    onset = (load + drop_N * np.arange(len(load))) / LOADING_RATE
    is_global = front == N_BLOCKS
    longest = np.maximum.accumulate(front) if len(front) else front
    n_counted = int(np.flatnonzero(is_global)[0]) + 1 if is_global.any() else len(front)
    return pd.DataFrame(
        {
            "onset_s": onset,
            "end_s": onset + 1e-4,
            "load_before_N": load,
            "load_after_N": load - drop_N,
            "front": front,
            "is_global": is_global,
            "kept": (front >= longest) & (np.arange(len(front)) < n_counted),
        }
    )


def trace_table(slips: pd.DataFrame, duration: float = 10.0) -> pd.DataFrame:
    """Corners of the load: its start, both ends of each drop, and the end of the run."""
    last_s, last_N = (slips["end_s"].iloc[-1], slips["load_after_N"].iloc[-1]) if len(slips) else (0.0, 0.0)
    times = [0.0, *slips[["onset_s", "end_s"]].to_numpy().ravel(), duration]
    loads = [0.0, *slips[["load_before_N", "load_after_N"]].to_numpy().ravel()]
    loads.append(last_N + LOADING_RATE * (duration - last_s))
    return pd.DataFrame({"time_s": times, "tangential_load_N": loads})


def uniform_loading() -> pd.DataFrame:
    slips = slip_table(FRONTS, LOADS_N)
    slips.loc[slips["is_global"], "onset_s"] = FIRST_GLOBAL_S
    slips.loc[slips["is_global"], "end_s"] = FIRST_GLOBAL_S + 5e-4
    return slips


@pytest.fixture(name="slips")
def slips_under_uniform_loading() -> pd.DataFrame:
    return uniform_loading()


@pytest.fixture(scope="module")
def scene_figure() -> Figure:
    return draw(uniform_loading())


@pytest.fixture(scope="module")
def lengths_figure() -> Figure:
    return draw_precursor_lengths(three_scenes())


def three_scenes() -> list[PrecursorLengths]:
    return [
        PrecursorLengths(
            slip_table([1, 3, 2, 10], [51.3, 86.7, 120.0, 193.8]), -5 / 6, N_BLOCKS, NORMAL_LOAD_N
        ),
        PrecursorLengths(uniform_loading(), 0.0, N_BLOCKS, NORMAL_LOAD_N),
        PrecursorLengths(
            slip_table([1, 1, 2, 1, 10], [4.7, 8.0, 12.0, 30.0, 195.3]), 5 / 6, N_BLOCKS, NORMAL_LOAD_N
        ),
    ]


def draw(slips: pd.DataFrame, duration: float = 10.0) -> Figure:
    return draw_scene(slips, trace_table(slips, duration), N_BLOCKS, LENGTH_M, r"$\theta = 0$")


def fronts_drawn(axes: Axes, color: str) -> dict[float, float]:
    """Time of each vertical line of a colour, and how far it goes; all must start at the trailing edge."""
    drawn = {}
    for collection in axes.collections:
        if isinstance(collection, LineCollection) and to_hex(collection.get_color()[0]) == color.lower():
            for (x, y), (x_end, y_end) in collection.get_segments():
                assert (x, y) == (x_end, 0)
                drawn[float(x)] = float(y_end)
    return drawn


def broken_lines(axes: Axes) -> list[float]:
    return [float(line.get_xdata()[0]) for line in axes.lines if line.get_linestyle() == "--"]


def arrows(axes: Axes) -> list[tuple[float, float]]:
    return [tuple(child.xy) for child in axes.get_children() if isinstance(child, Annotation)]


def written(figure: Figure, path: Path) -> bytes:
    style.save(figure, path)
    return path.read_bytes()


class TestScene:
    def test_each_slip_is_a_line_from_the_trailing_edge_as_long_as_its_front(
        self, scene_figure: Figure, slips: pd.DataFrame
    ) -> None:
        _, lower = scene_figure.axes
        for is_global, color in ((False, PARTIAL), (True, GLOBAL)):
            expected = slips[slips["is_global"] == is_global]
            drawn = fronts_drawn(lower, color)
            np.testing.assert_allclose(list(drawn), expected["onset_s"], rtol=ROUNDING)
            np.testing.assert_allclose(list(drawn.values()), 10 * expected["front"], rtol=ROUNDING)

    def test_a_broken_line_marks_the_first_global_slip_in_both_panels_and_the_inset(
        self, slips: pd.DataFrame
    ) -> None:
        later = slips.iloc[[-1]].assign(onset_s=5.0, end_s=5.0005, kept=False)
        upper, lower = draw(pd.concat([slips, later], ignore_index=True)).axes
        (inset,) = upper.child_axes
        assert broken_lines(upper) == broken_lines(lower) == broken_lines(inset) == [FIRST_GLOBAL_S]

    def test_arrows_in_the_inset_point_at_the_drops_before_the_global_slip(
        self, scene_figure: Figure, slips: pd.DataFrame
    ) -> None:
        (inset,) = scene_figure.axes[0].child_axes
        start, end = inset.get_xlim()
        assert start < FIRST_GLOBAL_S < end
        seen = slips[(slips["onset_s"] > start) & ~slips["is_global"]]
        assert 0 < len(seen) < len(slips)
        assert arrows(inset) == list(zip(seen["onset_s"], seen["load_before_N"], strict=True))

    def test_the_load_is_the_trace(self, scene_figure: Figure, slips: pd.DataFrame) -> None:
        trace = trace_table(slips)
        upper = scene_figure.axes[0]
        np.testing.assert_array_equal(upper.lines[0].get_xydata(), trace.to_numpy())

    def test_the_inset_hides_no_part_of_the_load(self, scene_figure: Figure, slips: pd.DataFrame) -> None:
        upper = scene_figure.axes[0]
        (inset,) = upper.child_axes
        bottom_of_labels = inset.get_tightbbox().y0
        highest = trace_table(slips)["tangential_load_N"].max()
        assert upper.transData.transform((0, highest))[1] < bottom_of_labels

    def test_axes_name_their_units(self, scene_figure: Figure) -> None:
        upper, lower = scene_figure.axes
        assert upper.get_ylabel().endswith("[N]")
        assert lower.get_ylabel().endswith("[mm]")
        assert lower.get_xlabel().endswith("[s]")

    @pytest.mark.parametrize("duration", [0.2, 1000.0])
    def test_the_time_axis_is_the_run(self, slips: pd.DataFrame, duration: float) -> None:
        lower = draw(slips[slips["end_s"] < duration], duration).axes[1]
        assert lower.get_xlim() == (0, duration)

    def test_a_run_that_stops_at_the_global_slip_keeps_its_line_off_the_frame(
        self, slips: pd.DataFrame
    ) -> None:
        lower = draw(slips, duration=slips["end_s"].iloc[-1]).axes[1]
        assert lower.get_xlim()[1] > 1.03 * FIRST_GLOBAL_S

    def test_a_run_without_global_slip_says_so_and_has_no_inset(self, slips: pd.DataFrame) -> None:
        upper, lower = draw(slips[~slips["is_global"]]).axes
        assert "no global slip" in upper.get_title(loc="left")
        assert not upper.child_axes
        assert broken_lines(upper) == broken_lines(lower) == []

    def test_a_run_without_any_slip_says_so(self) -> None:
        figure = draw(slip_table([], []), duration=0.3)
        assert [text.get_text() for text in figure.axes[1].texts] == ["no slip event"]

    def test_an_unfinished_event_is_a_band_to_the_end_of_the_run(self, slips: pd.DataFrame) -> None:
        onset = 4.0
        unfinished = slips.iloc[[0]].assign(
            onset_s=onset, end_s=np.nan, load_after_N=np.nan, front=7, kept=False
        )
        table = pd.concat([slips, unfinished], ignore_index=True)
        lower = draw_scene(table, trace_table(slips), N_BLOCKS, LENGTH_M).axes[1]
        (band,) = [item for item in lower.collections if isinstance(item, FillBetweenPolyCollection)]
        corners = band.get_paths()[0].get_extents()
        np.testing.assert_allclose(corners.get_points(), [[onset, 0], [10, 70]], rtol=ROUNDING)

    def test_an_event_that_starts_the_run_and_never_ends_is_drawn(self, tmp_path: Path) -> None:
        table = slip_table([N_BLOCKS], [0.0]).assign(end_s=np.nan, load_after_N=np.nan)
        trace = pd.DataFrame({"time_s": [0.0, 1.0], "tangential_load_N": [0.0, 0.0]})
        assert written(draw_scene(table, trace, N_BLOCKS, LENGTH_M), tmp_path / "x.png")

    def test_of_hundreds_of_events_the_largest_drops_have_the_arrows(self) -> None:
        rng = np.random.default_rng(1)
        n = 600
        slips = slip_table([*rng.integers(1, N_BLOCKS, n), N_BLOCKS], list(np.linspace(1, 190, n + 1)), 0.01)
        slips["load_after_N"] = slips["load_before_N"] - rng.random(n + 1)
        figure = draw(slips)
        (inset,) = figure.axes[0].child_axes
        seen = slips[(slips["onset_s"] > inset.get_xlim()[0]) & ~slips["is_global"]]
        drop = seen["load_before_N"] - seen["load_after_N"]
        marked = seen["onset_s"].isin([time for time, _ in arrows(inset)])
        assert marked.sum() == MOST_ARROWS < len(seen)
        assert drop[marked].min() > drop[~marked].max()
        assert len(fronts_drawn(figure.axes[1], PARTIAL)) == n

    def test_a_chain_of_one_block_slips_over_the_whole_length(self) -> None:
        table = slip_table([1], [280.0]).assign(is_global=True, kept=True)
        lower = draw_scene(table, trace_table(table), n_blocks=1, length_m=0.25).axes[1]
        assert list(fronts_drawn(lower, GLOBAL).values()) == [250.0]

    def test_a_trace_without_rows_is_refused(self, slips: pd.DataFrame) -> None:
        with pytest.raises(ValueError, match="trace has no rows"):
            draw_scene(slips, trace_table(slips).iloc[:0], N_BLOCKS, LENGTH_M)


class TestPrecursorLengths:
    def markers(self, figure: Figure, marker: str) -> list[np.ndarray]:
        return [line.get_xydata() for line in figure.axes[0].lines if line.get_marker() == marker]

    def test_there_is_one_circle_for_each_event_kept(
        self, lengths_figure: Figure, slips: pd.DataFrame
    ) -> None:
        circles = self.markers(lengths_figure, "o")
        assert [len(points) for points in circles] == [3, N_KEPT, 4]
        kept = slips[slips["kept"]]
        np.testing.assert_allclose(circles[1][:, 0], kept["load_before_N"], rtol=ROUNDING)
        np.testing.assert_allclose(circles[1][:, 1], kept["front"] / N_BLOCKS, rtol=ROUNDING)

    def test_circles_are_solid_dotted_and_open_as_in_the_paper(self, lengths_figure: Figure) -> None:
        figure = lengths_figure
        negative, zero, positive = [line for line in figure.axes[0].lines if line.get_marker() == "o"]
        assert negative.get_markerfacecolor() == negative.get_color()
        assert zero.get_markerfacecolor() == positive.get_markerfacecolor() == "none"
        (dots,) = self.markers(figure, ".")
        np.testing.assert_array_equal(dots, zero.get_xydata())

    def test_short_events_up_to_the_global_slip_are_faint_crosses_that_can_be_left_out(
        self, slips: pd.DataFrame
    ) -> None:
        after = slips.iloc[[0]].assign(onset_s=9.0, kept=False)
        scene = PrecursorLengths(pd.concat([slips, after], ignore_index=True), 0.0, N_BLOCKS, NORMAL_LOAD_N)
        (crosses,) = self.markers(draw_precursor_lengths([scene]), "x")
        assert len(crosses) == len(FRONTS) - N_KEPT
        assert self.markers(draw_precursor_lengths([scene], with_short_events=False), "x") == []

    def test_the_legend_counts_the_events(self, lengths_figure: Figure) -> None:
        legend = lengths_figure.axes[0].get_legend()
        assert [text.get_text() for text in legend.get_texts()] == [
            r"$\theta = -5/6$: 3 events",
            r"$\theta = 0$: 9 events",
            r"$\theta = 5/6$: 4 events",
            "short events, not counted",
        ]

    def test_the_upper_axis_is_the_friction_coefficient(self, lengths_figure: Figure) -> None:
        axes = lengths_figure.axes[0]
        (upper,) = axes.child_axes
        np.testing.assert_allclose(upper.get_xlim(), np.divide(axes.get_xlim(), NORMAL_LOAD_N), rtol=ROUNDING)
        assert "F_X/F_Z" in upper.get_xlabel()

    def test_a_line_marks_the_mean_apparent_friction_coefficient(self, lengths_figure: Figure) -> None:
        axes = lengths_figure.axes[0]
        expected = np.mean([193.8, 194.31, 195.3])
        lines = [line.get_xdata()[0] for line in axes.lines if line.get_linestyle() == "--"]
        np.testing.assert_allclose(lines, [expected], rtol=ROUNDING)
        assert f"{expected / NORMAL_LOAD_N:.3f}" in axes.texts[0].get_text()

    def test_different_normal_loads_have_no_common_friction_coefficient(self, slips: pd.DataFrame) -> None:
        figure = draw_precursor_lengths(
            [PrecursorLengths(slips, 0.0, 10, 400.0), PrecursorLengths(slips, 0.0, 10, 800.0)]
        )
        assert not figure.axes[0].child_axes
        first, second = (text.get_text() for text in figure.axes[0].get_legend().get_texts()[:2])
        assert "400" in first
        assert "800" in second

    def test_two_scenes_with_the_same_sign_of_theta_have_different_outlines(
        self, slips: pd.DataFrame
    ) -> None:
        figure = draw_precursor_lengths([PrecursorLengths(slips, theta, 10, 400.0) for theta in (0.2, 0.4)])
        assert [len(self.markers(figure, outline)) for outline in "os"] == [1, 1]

    def test_scenes_without_global_slip_or_any_slip_are_drawn(
        self, slips: pd.DataFrame, tmp_path: Path
    ) -> None:
        unfinished = PrecursorLengths(slips[~slips["is_global"]], 0.0, N_BLOCKS, NORMAL_LOAD_N)
        at_rest = PrecursorLengths(slip_table([], []), 0.5, N_BLOCKS, NORMAL_LOAD_N)
        figure = draw_precursor_lengths([unfinished, at_rest])
        labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
        assert labels[0].endswith(": 8 events, no global slip")
        assert labels[1].endswith(": 0 events, no global slip")
        assert written(figure, tmp_path / "x.png")

    def test_axes_name_their_units(self, lengths_figure: Figure) -> None:
        axes = lengths_figure.axes[0]
        assert axes.get_xlabel().endswith("[N]")
        assert axes.get_ylabel() == "Propagation length $L_p/L$ [-]"

    def test_no_scene_is_refused(self) -> None:
        with pytest.raises(ValueError, match="no scene"):
            draw_precursor_lengths([])


class TestChainSchematic:
    @pytest.mark.parametrize(
        ("n_blocks", "names"), [(1, "1"), (2, "12"), (3, "123"), (4, "12N"), (10, "12N"), (500, "12N")]
    )
    def test_each_block_drawn_has_its_load_friction_and_position(self, n_blocks: int, names: str) -> None:
        texts = {text.get_text() for text in draw_chain_schematic(n_blocks).axes[0].texts}
        for symbol in "wfx":
            assert {text for text in texts if text.startswith(f"${symbol}_") and "=" not in text} == {
                f"${symbol}_{name}$" for name in names
            }
        assert ("$\\cdots$" in texts) == ("N" in names)

    def test_drive_sections_and_edges_are_named(self) -> None:
        texts = " ".join(text.get_text() for text in draw_chain_schematic().axes[0].texts)
        for name in (
            "P",
            "$V$",
            "$K$",
            "$k$",
            "$F_X$",
            "loading section",
            "material section",
            "trailing edge",
        ):
            assert name in texts
        assert "leading edge" in texts

    def test_nothing_leaves_the_paper(self) -> None:
        figure = draw_chain_schematic()
        figure.draw_without_rendering()
        page = figure.bbox
        for text in figure.axes[0].texts:
            box = text.get_window_extent()
            assert page.x0 <= box.x0 <= box.x1 <= page.x1, text.get_text()
            assert page.y0 <= box.y0 <= box.y1 <= page.y1, text.get_text()

    def test_no_block_is_refused(self) -> None:
        with pytest.raises(ValueError, match="n_blocks = 0"):
            draw_chain_schematic(0)


class TestFiles:
    def test_drawing_twice_gives_the_same_bytes_whichever_file_is_first(
        self, scene_figure: Figure, lengths_figure: Figure, tmp_path: Path
    ) -> None:
        once = [draw_chain_schematic(), scene_figure, lengths_figure]
        again = [draw_chain_schematic(), draw(uniform_loading()), draw_precursor_lengths(three_scenes())]
        for first, second in zip(once, again, strict=True):
            png, svg = (written(first, tmp_path / f"first.{ending}") for ending in ("png", "svg"))
            assert written(second, tmp_path / "second.svg") == svg
            assert written(second, tmp_path / "second.png") == png

    def test_settings_of_the_user_change_nothing(
        self, scene_figure: Figure, slips: pd.DataFrame, tmp_path: Path
    ) -> None:
        plain = written(scene_figure, tmp_path / "a.png")
        with matplotlib.rc_context({"font.size": 20, "axes.facecolor": "red", "savefig.bbox": "tight"}):
            assert written(draw(slips), tmp_path / "b.png") == plain
            assert matplotlib.rcParams["font.size"] == 20

    @pytest.mark.parametrize("ending", ["png", "svg"])
    def test_files_name_no_date(self, tmp_path: Path, ending: str) -> None:
        content = written(draw_chain_schematic(), tmp_path / f"a.{ending}")
        for word in (b"dc:date", b"Software", b"Creation Time", b"Matplotlib v"):
            assert word not in content

    def test_other_endings_are_refused(self, tmp_path: Path) -> None:
        with pytest.raises(ValueError, match=r"\.gif.*allowed are \.png and \.svg"):
            style.save(draw_chain_schematic(), tmp_path / "a.gif")
        assert list(tmp_path.iterdir()) == []

    def test_no_module_needs_pyplot_whose_state_is_global(self) -> None:
        modules = list(Path(figures.__file__).parent.glob("*.py"))
        assert len(modules) > 1
        for module in modules:
            assert "pyplot" not in module.read_text(encoding="utf-8"), module.name


class TestTables:
    def test_a_slip_table_keeps_its_types_even_when_empty(self, slips: pd.DataFrame, tmp_path: Path) -> None:
        for table in (slips, slips.iloc[:0]):
            table.to_csv(tmp_path / "slips.csv", index=False)
            pd.testing.assert_frame_equal(style.read_slips(tmp_path / "slips.csv"), table)

    def test_a_missing_column_is_named(self, slips: pd.DataFrame, tmp_path: Path) -> None:
        slips.drop(columns="front").to_csv(tmp_path / "slips.csv", index=False)
        with pytest.raises(ValueError, match=r"slips\.csv: column front is missing"):
            style.read_slips(tmp_path / "slips.csv")

    def test_a_word_among_numbers_is_refused(self, slips: pd.DataFrame, tmp_path: Path) -> None:
        trace_table(slips).astype(object).replace(0.0, "much").to_csv(tmp_path / "trace.csv", index=False)
        with pytest.raises(ValueError, match=r"trace\.csv: .*much"):
            style.read_trace(tmp_path / "trace.csv")

    @pytest.mark.parametrize(
        ("theta", "text"),
        [(-5 / 6, "-5/6"), (0.0, "0"), (0.5, "1/2"), (1.0, "1"), (0.833, "0.833"), (0.8333, "0.8333")],
    )
    def test_theta_is_a_fraction_only_where_it_is_one(self, theta: float, text: str) -> None:
        assert style.theta_text(theta) == rf"$\theta = {text}$"
