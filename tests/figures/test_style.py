"""Files of figures are reproducible, and colours and markers are distinct."""

from io import BytesIO

import matplotlib
import numpy as np
import pandas as pd
import pytest
from colours import SIGHTS, alike
from figures.test_pictures import one_length, slips
from matplotlib import image

from maegawa2010.methods import ROWS
from precursors import Chain, plot, simulate
from precursors.figures import precursor_lengths, scene, style


def small_figure():
    """Draw a line, labels and a pale band."""
    with style.page(85.0, 40.0) as figure:
        axes = figure.add_subplot()
        axes.plot([0.0, 1.0], [0.0, 1.0])
        axes.axvspan(0.1, 0.2, color=style.pale(style.BLACK, 0.5))
    return figure


def test_figure_files_are_reproducible_under_user_settings(tmp_path, caplog):
    figure = small_figure()
    for ending in ("png", "svg", "pdf", "eps"):
        style.save(figure, tmp_path / f"first.{ending}")
    with matplotlib.rc_context({"font.size": 20}):
        figure = small_figure()
        for ending in ("svg", "png"):
            style.save(figure, tmp_path / f"second.{ending}")
    files = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert files["first.png"] == files["second.png"]
    assert files["first.svg"] == files["second.svg"]
    assert files["first.eps"].startswith(b"%!PS-Adobe-3.0 EPSF")
    for content in files.values():
        for word in (b"dc:date", b"Software", b"Creation", b"Matplotlib v"):
            assert word not in content
    assert caplog.messages == []
    assert image.imread(tmp_path / "first.png").shape[1] == int(300 * 85 / 25.4)


def test_savefig_ignores_user_settings_of_size_and_fonts(tmp_path):
    figure = plot(simulate(Chain.from_slider(), 1.0))
    figure.savefig(tmp_path / "plain.png")
    theirs = {"savefig.bbox": "tight", "savefig.dpi": 50, "pdf.fonttype": 3}
    with matplotlib.rc_context(theirs):
        for ending in ("png", "pdf"):
            figure.savefig(tmp_path / f"theirs.{ending}")
    files = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert files["theirs.png"] == files["plain.png"]
    assert b"/Type3" not in files["theirs.pdf"]


def test_figure_displays_in_a_notebook_without_font_warnings(caplog):
    figure = plot(simulate(Chain.from_slider(), 1.0))
    assert figure._repr_png_().startswith(b"\x89PNG")
    figure.canvas.print_figure(BytesIO())  # as the back end of Jupyter does
    assert caplog.messages == []


def test_svg_has_text_and_a_title(tmp_path):
    figure = one_length()
    style.save(figure, tmp_path / "figure.svg", title="Fig. 13")
    svg = (tmp_path / "figure.svg").read_text("utf-8")
    assert "<title>Fig. 13</title>" in svg
    assert "short events, not counted</text>" in svg


@pytest.mark.parametrize(
    ("theta", "text"),
    [
        (-5 / 6, "-5/6"),
        (1 / 13, "0.07692"),
        (0.833, "0.833"),
    ],
)
def test_theta_is_a_fraction_only_with_a_small_denominator(theta, text):
    assert style.theta_text(theta) == rf"$\theta = {text}$"


def test_law_uses_measured_loads_and_axis_covers_the_data():
    run = simulate(Chain.from_slider(weights=[20.0, 40.0, 60.0]), until="global slip")
    axes = plot(run, "lengths", data=[[-5.0, 0.2], [300.0, 1.0]]).axes[0]
    drawn = [list(line.get_xdata()) for line in axes.lines]
    assert [0.0, 9.0, 27.0, 54.0] in drawn  # mu_k W
    low, high = axes.get_xlim()
    assert low <= -5.0
    assert high >= 300.0
    frame = pd.DataFrame({"F_X [N]": [0.0, 120.5], "t [s]": [0.0, 15.0]})
    assert plot(run, data=frame).axes[0].get_xlim() == (0.0, 15.0)
    with pytest.raises(ValueError, match="data must have two columns"):
        plot(run, data=[1.0, 2.0])


def test_magnified_view_includes_measured_loads():
    run = simulate(Chain.from_slider(), 4.0)
    inside, beyond = [[2.0, 140.0], [2.7, 180.0]], [[3.9, 900.0]]
    figure = plot(run, data=inside + beyond)
    (view,) = (
        each for each in figure.axes if each.get_title("left") == scene.MAGNIFIED
    )
    assert inside in [line.get_xydata().tolist() for line in view.lines]
    assert view.get_ylim()[1] < 250.0


def test_measured_lengths_above_1_are_refused():
    point = style.Measured("measured", np.array([[50.0, 30.0]]))
    with pytest.raises(ValueError, match="between 0 and 1"):
        precursor_lengths.draw([slips()], [point])


def test_every_method_with_a_line_has_its_own_marker():
    markers = [row["marker"] for row in ROWS.values() if row["color"] != style.GREY]
    assert all(markers)
    assert len(set(markers)) == len(markers)
    black = [name for name, row in ROWS.items() if row["color"] == style.BLACK]
    assert black == ["exact"]


MEANINGS = (
    [
        "TRAILING",
        "UNIFORM",
        "LEADING",
        "PARTIAL",
        "GLOBAL",
        "BACKWARD",
        "MEASURED",
        "BLACK",
        "GREY",
    ],
    {*style.OTHERS} | {row["color"] for row in ROWS.values()},
)


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("names", MEANINGS)
def test_colours_are_distinct_for_every_type_of_sight(sight, names):
    colors = {name: getattr(style, name, name) for name in names}
    assert alike(colors, sight) == []
