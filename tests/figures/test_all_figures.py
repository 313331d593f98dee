"""What holds for every figure: it can be read, it has a key, and the same tables give the same bytes."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import matplotlib
import pytest
from figures.examples import EXAMPLES, draw, save_small
from matplotlib import image
from matplotlib.testing.compare import compare_images
from matplotlib.text import Text

from precursors.figures import style

SMALLEST_PT = 7.0  # what journals ask for at the width on paper; indices and exponents are smaller
# Boxes of text are as high as the tallest letter of a font: so much of it may lie in another box.
SLACK_PX = 6.0
WITHOUT_KEY = {"fig09", "speed"}  # its curves are named where they end
SMALL = Path(__file__).parents[1] / "golden/small"
# Root mean square over all pixels and colours, of 255. The same release of Matplotlib draws the same picture.
SMALL_RMS = 0.3


@pytest.fixture(scope="module", params=EXAMPLES)
def named(request):
    return request.param, draw(request.param)


@pytest.fixture
def figure(named):
    return named[1]


def texts(figure):
    """All texts that are seen; a tick outside the limits of its axis is not."""
    figure.draw_without_rendering()
    hidden = set()
    for axes in figure.findobj(lambda artist: hasattr(artist, "xaxis")):
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            for tick in [*axis.get_major_ticks(), *axis.get_minor_ticks()]:
                labels = {tick.label1, tick.label2}
                hidden |= {t for t in labels if not t.get_visible() or not low <= tick.get_loc() <= high}
    shown = [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip() and t not in hidden]
    return [text for text in shown if text.axes is None or text.axes.axison or text in text.axes.texts]


def test_nothing_leaves_the_paper(figure):
    for text in texts(figure):
        box = text.get_window_extent()
        assert figure.bbox.x0 <= box.x0 <= box.x1 <= figure.bbox.x1, text.get_text()
        assert figure.bbox.y0 <= box.y0 <= box.y1 <= figure.bbox.y1, text.get_text()


def test_no_text_lies_on_another(figure):
    boxes = [(text.get_text(), text.get_window_extent().padded(-SLACK_PX / 2)) for text in texts(figure)]
    for (text, box), (other, other_box) in combinations(boxes, 2):
        assert box.width <= 0 or other_box.width <= 0 or not box.overlaps(other_box), (text, other)


def test_text_is_large_enough_to_read(figure):
    assert min(text.get_fontsize() for text in texts(figure)) >= SMALLEST_PT


def test_every_figure_has_a_key(named):
    name, figure = named
    keys = [*figure.legends, *(axes.get_legend() for axes in figure.axes if axes.get_legend())]
    assert bool(keys) == (name not in WITHOUT_KEY)
    for key in keys:
        assert all(text.get_text() for text in key.get_texts())


def test_drawing_twice_gives_the_same_bytes(named, tmp_path):
    name, figure = named
    style.save(figure, tmp_path / "first.svg")
    style.save(draw(name), tmp_path / "second.svg")
    assert (tmp_path / "first.svg").read_bytes() == (tmp_path / "second.svg").read_bytes()


def test_the_picture_is_the_one_that_is_kept(named, tmp_path):
    name, figure = named
    save_small(figure, tmp_path / f"{name}.png")
    assert compare_images(str(SMALL / f"{name}.png"), str(tmp_path / f"{name}.png"), tol=SMALL_RMS) is None


def test_every_format_has_the_same_bytes_whichever_file_is_first(tmp_path):
    endings = ("png", "svg", "pdf", "eps")
    for which, order in (("first", endings), ("second", endings[::-1])):
        figure = draw("fig13")
        for ending in order:
            style.save(figure, tmp_path / f"{which}.{ending}")
    for ending in endings:
        first, second = ((tmp_path / f"{which}.{ending}").read_bytes() for which in ("first", "second"))
        assert first == second, ending
        for word in (b"dc:date", b"Software", b"Creation", b"Matplotlib v"):
            assert word not in first


def test_an_eps_file_needs_no_transparency(figure, tmp_path, caplog, monkeypatch):
    monkeypatch.setitem(style._SETTINGS, "ps.fonttype", 3)  # of which a file is written ten times as fast
    style.save(figure, tmp_path / "figure.eps")
    assert caplog.messages == []
    assert (tmp_path / "figure.eps").read_bytes().startswith(b"%!PS-Adobe-3.0 EPSF")


def test_a_png_has_300_dots_per_inch(tmp_path):
    style.save(draw("fig13"), tmp_path / "figure.png")
    width = image.imread(tmp_path / "figure.png").shape[1]
    assert width == pytest.approx(300 * style.COLUMN_MM / style.MM_PER_INCH, abs=1)


def test_settings_of_the_user_change_nothing(tmp_path):
    style.save(draw("scene"), tmp_path / "a.png")
    with matplotlib.rc_context({"font.size": 20, "axes.facecolor": "red", "savefig.bbox": "tight"}):
        style.save(draw("scene"), tmp_path / "b.png")
        assert matplotlib.rcParams["font.size"] == 20
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_other_endings_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"must be a \.png, \.svg, \.pdf, \.eps file, but .*a\.gif"):
        style.save(draw("fig09"), tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("theta", "text"),
    [(-5 / 6, "-5/6"), (0.0, "0"), (0.5, "1/2"), (1.0, "1"), (0.833, "0.833"), (0.8333, "0.8333")],
)
def test_theta_is_a_fraction_only_if_it_is_one(theta, text):
    assert style.theta_text(theta) == rf"$\theta = {text}$"
