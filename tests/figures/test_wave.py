"""The movie agrees with the run."""

from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from places import GOLDEN, RESULTS

from precursors import Chain, plot, simulate
from precursors.figures import style, wave

SVG = f"{{{wave.XMLNS}}}"
# Coordinates are written with one decimal.
PIXELS = 0.06


class TwoBlocks:
    """An event from 1 to 3 s: block 1 slides 1 m forward until 2 s, and block 2 slides
    backward in between."""

    transitions = np.array(
        [(0.5, 2, 1), (0.9, 2, 0), (1.0, 1, 1), (1.5, 2, -1), (2.0, 1, 0), (2.5, 2, 0)],
        dtype=[("time", float), ("block", int), ("mode", int)],
    )

    def at(self, times):
        positions = np.column_stack([times - times[0], 0.0 * times]) / 2.0
        return positions, positions


def drawn(**columns) -> ElementTree.Element:
    event = {"onset_s": 1.0, "end_s": 3.0, "front": 2, "load_before_N": 9.0}
    event |= {"n_blocks": 2, "slider_length_m": 0.1, "counted": True, "is_global": True}
    slips = pd.DataFrame([event | columns])
    return ElementTree.fromstring(wave.draw(TwoBlocks(), slips).svg)


def test_committed_wave_is_the_one_of_the_run():
    golden = GOLDEN / "wave.svg"
    drawn = RESULTS / "figures/wave.svg"
    assert golden.read_text("utf-8") == drawn.read_text("utf-8")
    assert golden.stat().st_size < 400_000


def test_bars_mark_when_and_which_way_blocks_slide():
    bars = drawn().findall(f"{SVG}rect[@class='lane']")
    width = wave.RIGHT - wave.LEFT
    spans = [
        (bar.get("fill"), float(bar.get("x")), float(bar.get("width"))) for bar in bars
    ]
    (ahead, x1, width1), (back, x2, width2) = spans
    assert (ahead, back) == (style.GLOBAL, style.BACKWARD)
    assert [x1, x2] == pytest.approx([wave.LEFT, wave.LEFT + 0.25 * width], abs=PIXELS)
    assert [width1, width2] == pytest.approx([0.5 * width] * 2, abs=PIXELS)
    assert float(bars[1].get("height")) < float(bars[0].get("height"))


def test_blocks_move_as_in_the_run_and_rest_at_the_end():
    first, second = drawn().findall(f"{SVG}g/{SVG}animateTransform")
    moved = [float(value) for value in first.get("values").split(";")]
    assert len(moved) == wave.MOVING + wave.RESTING
    assert np.diff(moved[: wave.MOVING]) == pytest.approx(
        wave.FARTHEST / (wave.MOVING - 1), abs=2 * PIXELS
    )
    assert set(moved[wave.MOVING - 1 :]) == {wave.FARTHEST}
    assert set(second.get("values").split(";")) == {"0.0"}


def test_run_without_a_slip_is_labelled():
    assert "no slip event" in "".join(drawn(end_s=np.nan).itertext())


def test_movie_shows_two_precursors_and_the_global_slip(tmp_path):
    run = simulate(Chain.from_slider(), until="global slip")
    movie = plot(run, "wave")
    words = "".join(ElementTree.fromstring(movie.svg).itertext())
    for name in ("blocks 1 to 4", "blocks 1 to 9", "global slip: all blocks at once"):
        assert words.count(name) == 2  # above the row, and in its panel
    movie.savefig(tmp_path / "wave.svg")
    with pytest.raises(ValueError, match=r"must end in \.svg"):
        movie.savefig(tmp_path / "wave.gif")
    with pytest.raises(ValueError, match="takes no title or look"):
        plot(run, "wave", title="mine")
