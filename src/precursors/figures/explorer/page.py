"""Write the explorer: a page that solves the chain in the browser while its parameters change.

The page holds no run. `solver.js` is the twin of `solver/plain.py`; `explorer.js` links it to the sliders
and figures. Bokeh draws: its JavaScript comes in its wheel and takes coordinates in double precision.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from math import log10
from os import PathLike
from string import Template
from typing import Any

from bokeh.document import Document
from bokeh.models import ColumnDataSource, FixedTicker, HoverTool, PanTool, Range1d, SaveTool, WheelZoomTool
from bokeh.models.annotations.geometry import Span
from bokeh.plotting import figure
from bokeh.resources import INLINE
from bokeh.settings import settings

from precursors.figures import style
from precursors.support.files import write_text

NARROWEST = 10e-6  # s, the narrowest window: half of the shortest slip
COLORS = {"partial": style.BLUE, "global": style.VERMILION, "backward": style.ORANGE, "grey": style.GREY}
LOAD, LENGTH = "Tangential load F\u2093 [N]", "Propagation length L\u209a/L"
# Slider of the page: parameter, label, smallest, largest, step, and whether it is logarithmic.
SLIDERS = (
    ("theta", "\u03b8", -1, 1, 0.001, False),
    ("mu_s", "\u03bc<sub>s</sub>", 0.05, 1.5, 0.001, False),
    ("mu_k", "\u03bc<sub>k</sub>", 0, 1.4, 0.001, False),
    ("n_blocks", "N", 1, 40, 1, False),
    ("drive_stiffness", "K [N/m]", 1e4, 1e8, 0.01, True),
    ("drive_velocity", "V [m/s]", 1e-6, 1e-1, 0.01, True),
)


@dataclass(frozen=True)
class Scene:
    """A button of the page: its name, its title, and the arguments of `Chain.from_slider` it stands for."""

    name: str
    title: str
    slider: Mapping[str, Any]


def write_explorer(scenes: Sequence[Scene], duration: float, path: str | PathLike[str]) -> None:
    """Write the explorer as one HTML file that needs no other file and no network.

    Parameters
    ----------
    scenes : sequence of Scene
        The scenes that have a button; the page opens with the first.
    duration : float
        Time that is simulated [s].
    path : path-like
        The file.

    Raises
    ------
    OSError
        If the file cannot be written.
    """

    def part(name: str) -> str:
        return files("precursors.figures.explorer").joinpath(name).read_text(encoding="utf-8")

    data = {
        "colors": COLORS,
        "duration": duration,
        "narrowest": NARROWEST,
        "scenes": {scene.name: dict(scene.slider) for scene in scenes},
    }
    page = Template(part("page.html")).substitute(
        style=part("explorer.css"),
        bokeh="\n".join(f"<script>{script}</script>" for script in INLINE.js_raw[:1]),
        figures=_numbered_afresh(_json(_figures())),
        data=_json(data),
        scenes="\n".join(_button(scene) for scene in scenes),
        sliders="\n".join(_slider(*slider) for slider in SLIDERS),
        solver=part("solver.js"),
        script=part("explorer.js"),
    )
    write_text(path, page)


def _button(scene: Scene) -> str:
    theta = f"\u03b8 = {style.fraction_text(scene.slider['theta'])}"
    name, text = html.escape(scene.name), html.escape(f"{theta}: {scene.title}")
    return f'<button type="button" data-scene="{name}">{text}</button>'


def _slider(name: str, label: str, low: float, high: float, step: float, logarithmic: bool) -> str:
    """A range of the page; a logarithmic one holds the decimal exponent."""
    low, high = (log10(low), log10(high)) if logarithmic else (low, high)
    kind = " data-logarithmic" if logarithmic else ""
    return (
        f'<label>{label} <output id="{name}-value"></output>'
        f'<input type="range" id="{name}" min="{low:g}" max="{high:g}" step="{step:g}"{kind}></label>'
    )


def _figures() -> dict[str, Any]:
    """The empty figures as Bokeh's JSON, with the element of the page that each belongs to."""
    settings.simple_ids = True
    window = Range1d(start=0, end=1, min_interval=NARROWEST, name="window")
    ticker = FixedTicker(ticks=[], minor_ticks=[], name="ticks")
    cursor = Span(name="cursor", dimension="height", location=None, line_color=style.ORANGE, line_width=2)
    roots = {
        "load": _load_figure(window, ticker, cursor),
        "raster": _raster_figure(window, ticker, cursor),
        "lengths": _lengths_figure(),
        "profile": _profile_figure(),
    }
    document = Document()
    for root in roots.values():
        document.add_root(root)
    places = {root.id: f"{name}-figure" for name, root in roots.items()}
    item = {"docid": "explorer", "roots": places, "root_ids": list(places)}
    return {"documents": {"explorer": document.to_json(deferred=False)}, "items": [item]}


def _load_figure(window: Range1d, ticker: FixedTicker, cursor: Span) -> Any:
    plot = _plain_figure("load", 300, x_range=window)
    _over_time(plot, ticker, cursor)
    plot.yaxis.axis_label = LOAD
    plot.xaxis.major_label_text_font_size = "0px"
    line = plot.line("time", "load", source=_empty("curve", "time", "load"), color=style.BLACK)
    own = _empty("own", "time", "load")
    plot.line("time", "load", source=own, color=style.GREEN, line_dash="dashed")
    events = plot.scatter(
        "onset",
        "before",
        source=_empty("onsets", "onset", "before", "event", "length", "kind", "color"),
        size=6,
        fill_color="color",
        line_color=None,
    )
    point = [("t", "$snap_x{0.000000000} s"), ("F\u2093", "$snap_y{0.0000} N")]
    plot.add_tools(
        HoverTool(
            renderers=[line], mode="vline", line_policy="interp", point_policy="follow_mouse", tooltips=point
        ),
        HoverTool(renderers=[events], tooltips=_event_tooltips("before", "onset")),
    )
    return plot


def _raster_figure(window: Range1d, ticker: FixedTicker, cursor: Span) -> Any:
    plot = _plain_figure("raster", 270, x_range=window)
    _over_time(plot, ticker, cursor)
    plot.yaxis.axis_label = "Block"
    columns = ("left", "right", "bottom", "top", "color", "event", "block", "way", "start", "lasts", "load")
    slides = plot.quad(
        left="left",
        right="right",
        bottom="bottom",
        top="top",
        fill_color="color",
        line_color=None,
        source=_empty("slides", *columns),
    )
    plot.ygrid.grid_line_color = None
    plot.yaxis.ticker = FixedTicker(ticks=[], minor_ticks=[], name="blocks")
    told = [
        ("block", "@block slides @way"),
        ("from", "@start{0.000000000} s"),
        ("lasts", "@lasts{0.000} \u00b5s"),
        ("F\u2093", "@load{0.0000} N"),
        ("event", "@event"),
    ]
    plot.add_tools(HoverTool(renderers=[slides], tooltips=told))
    return plot


def _lengths_figure() -> Any:
    plot = _plain_figure("lengths", 300, x_range=Range1d(start=0, end=1), y_range=Range1d(start=0, end=1.06))
    plot.xaxis.axis_label, plot.yaxis.axis_label = LOAD, LENGTH
    columns = ("load", "reached", "event", "kind", "onset", "length")
    short = plot.scatter(
        "load", "reached", marker="x", size=8, color=style.GREY, source=_empty("short", *columns)
    )
    counted = plot.scatter(
        "load", "reached", size=10, color=style.BLUE, source=_empty("counted", *columns), line_width=1.4
    )
    plot.scatter(
        "load",
        "reached",
        size=20,
        line_color=style.ORANGE,
        fill_color=None,
        line_width=2.5,
        source=_empty("chosen", "load", "reached"),
    )
    plot.add_tools(HoverTool(renderers=[counted, short], tooltips=_event_tooltips("load", "onset")))
    return plot


def _profile_figure() -> Any:
    plot = _plain_figure("profile", 270, x_range=Range1d(start=0, end=1), y_range=Range1d(start=0, end=1))
    plot.xaxis.axis_label, plot.yaxis.axis_label = "Block", "Velocity [m/s]"
    bars = _empty("profile source", "block", "velocity", "color")
    plot.vbar(x="block", top="velocity", width=0.8, color="color", source=bars)
    return plot


def _event_tooltips(load: str, onset: str) -> list[tuple[str, str]]:
    return [
        ("event", "@event, @kind"),
        ("onset", f"@{onset}{{0.000000000}} s"),
        ("F\u2093", f"@{load}{{0.0000}} N"),
        ("L\u209a", "@length{0.0} mm"),
    ]


def _plain_figure(name: str, height: int, **options: Any) -> Any:
    options = {"y_range": Range1d(start=0, end=1), **options}
    plot = figure(
        name=name, height=height, sizing_mode="stretch_width", toolbar_location="above", tools="", **options
    )
    plot.toolbar.logo = None
    plot.toolbar.autohide = True
    plot.add_tools(SaveTool())
    for axis in plot.axis:
        axis.axis_label_text_font_style = "normal"
    # Panels below each other end at the same pixel, whatever their labels.
    plot.min_border_left = 70
    plot.min_border_right = 20
    return plot


def _over_time(plot: Any, ticker: FixedTicker, cursor: Span) -> None:
    """Let the wheel zoom along time, and dragging pan."""
    wheel, pan = WheelZoomTool(dimensions="width"), PanTool(dimensions="width")
    plot.add_tools(pan, wheel)
    plot.toolbar.active_scroll, plot.toolbar.active_drag = wheel, pan
    plot.xaxis.ticker = plot.xgrid.ticker = ticker
    plot.add_layout(cursor)


def _empty(name: str, *columns: str) -> ColumnDataSource:
    return ColumnDataSource({column: [] for column in columns}, name=name)


def _numbered_afresh(text: str) -> str:
    """Number the models from 1: Bokeh goes on counting from one document of a process to the next."""
    numbers: dict[str, int] = {}
    return re.sub(r'"p\d+"', lambda found: f'"p{numbers.setdefault(found[0], len(numbers) + 1)}"', text)


def _json(value: object) -> str:
    """JSON that may stand inside a script element."""
    return json.dumps(value, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
