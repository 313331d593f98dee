"""Make the explorer's page: the runs' detail as data, empty Bokeh figures, and a script that links them.

Bokeh is used because its JavaScript comes in its wheel, takes coordinates in double precision, and has a
quarter of the size of Plotly's. The script decides what is in view and hands it to the figures.
"""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from os import PathLike
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from bokeh.document import Document
from bokeh.models import (
    ColumnDataSource,
    CrosshairTool,
    FixedTicker,
    HoverTool,
    PanTool,
    Range1d,
    ResetTool,
    SaveTool,
    WheelZoomTool,
)
from bokeh.models.annotations.geometry import Span
from bokeh.plotting import figure
from bokeh.resources import INLINE
from bokeh.settings import settings
from numpy.typing import NDArray

from precursors.analysis.load_curve import load_curve
from precursors.analysis.slips import find_precursors, find_slips
from precursors.figures import style
from precursors.figures.explorer.detail import find_slides
from precursors.solver.run import Run
from precursors.support.files import write_whole

NARROWEST = 10e-6  # s, the narrowest window: half of the shortest slip
COLORS = {"partial": style.BLUE, "global": style.VERMILION, "backward": style.ORANGE, "grey": style.GREY}


@dataclass(frozen=True)
class Scene:
    """A run as the explorer shows it.

    Parameters
    ----------
    name, title : str
        Name of the scene, and what it is in words.
    theta : float
        Degree of non-uniformity of its normal loading.
    run : Run
        The run.
    """

    name: str
    title: str
    theta: float
    run: Run


def write_explorer(scenes: Sequence[Scene], path: str | PathLike[str]) -> None:
    """Write the explorer of some scenes as one HTML file that needs no other and no network.

    Raises
    ------
    ValueError
        If there is no scene.
    OSError
        If the file cannot be written.
    """
    if not scenes:
        raise ValueError("the explorer has no scene: allowed is at least one")
    place = files("precursors.figures.explorer")
    page = Template(place.joinpath("page.html").read_text(encoding="utf-8")).substitute(
        style=place.joinpath("explorer.css").read_text(encoding="utf-8"),
        bokeh="\n".join(f"<script>{script}</script>" for script in INLINE.js_raw[:1]),
        figures=_numbered_afresh(_json(_figures())),
        data=_json({"colors": COLORS, "scenes": [_scene_data(scene) for scene in scenes]}),
        scenes="\n".join(_choice(scene) for scene in scenes),
        script=place.joinpath("explorer.js").read_text(encoding="utf-8"),
    )
    with write_whole(path) as temporary:
        Path(temporary).write_text(page, encoding="utf-8")


def _scene_data(scene: Scene) -> dict[str, Any]:
    """Everything the script needs to know of a scene; arrays as base64 of little-endian doubles."""
    run = scene.run
    slips = find_slips(run)
    slides = find_slides(run, slips["onset"].to_numpy())
    times, loads = load_curve(run)
    kept = slips.index.isin(find_precursors(slips).index)
    return {
        "name": scene.name,
        "title": scene.title,
        "theta": theta_text(scene.theta),
        "sign": int(np.sign(scene.theta)),
        "blocks": run.chain.n_blocks,
        "length_mm": run.chain.length * style.MM_PER_M,
        "duration": run.duration,
        "narrowest": NARROWEST,
        "curve": {"time": _packed(times), "load": _packed(loads)},
        "slides": {name: _packed(slides[name]) for name in slides},
        "events": {
            "onset": _packed(slips["onset"]),
            "end": _packed(slips["end"].fillna(run.duration)),
            "before": _packed(slips["load_before"]),
            "after": _packed(slips["load_after"].fillna(np.nan)),
            "front": _packed(slips["front"]),
            "is_global": _packed(slips["is_global"]),
            "kept": _packed(kept),
        },
    }


def theta_text(theta: float) -> str:
    """Write theta for reading, with its sign."""
    sign = "+" if theta > 0 else "\N{MINUS SIGN}" if theta < 0 else ""
    return f"\N{GREEK SMALL LETTER THETA} = {sign}{style.fraction_text(abs(theta))}"


def _figures() -> dict[str, Any]:
    """The empty figures as Bokeh's JSON, with the element of the page that each goes to."""
    settings.simple_ids = True
    x_range = Range1d(start=0, end=1, min_interval=NARROWEST, name="window")
    ticker = FixedTicker(ticks=[], minor_ticks=[], name="ticks")
    crosshair = Span(dimension="height", line_color=style.GREY, line_width=1, line_alpha=0.6)
    roots = {
        "load": _load_figure(x_range, ticker, crosshair),
        "raster": _raster_figure(x_range, ticker, crosshair),
        "lengths": _lengths_figure(),
    }
    document = Document()
    for root in roots.values():
        document.add_root(root)
    places = {root.id: f"{name}-figure" for name, root in roots.items()}
    item = {"docid": "explorer", "roots": places, "root_ids": list(places)}
    return {"documents": {"explorer": document.to_json(deferred=False)}, "items": [item]}


def _numbered_afresh(text: str) -> str:
    """Number the models from 1: Bokeh goes on counting from one document of a process to the next."""
    numbers: dict[str, int] = {}
    return re.sub(r'"p\d+"', lambda found: f'"p{numbers.setdefault(found[0], len(numbers) + 1)}"', text)


def _empty(name: str, *columns: str) -> ColumnDataSource:
    return ColumnDataSource({column: [] for column in columns}, name=name)


def _plain_figure(name: str, height: int, **options: Any) -> Any:
    plot = figure(
        name=name, height=height, sizing_mode="stretch_width", toolbar_location="above", tools="", **options
    )
    plot.toolbar.logo = None
    plot.toolbar.autohide = True
    plot.outline_line_color = style.BLACK
    for axis in plot.axis:
        axis.axis_label_text_font_style = "normal"
        axis.axis_label_text_color = axis.major_label_text_color = style.BLACK
    plot.grid.grid_line_alpha = 0.5
    return plot


def _time_figure(name: str, height: int, x_range: Range1d, ticker: FixedTicker, crosshair: Span) -> Any:
    """Figure over time, which the mouse wheel and dragging zoom and pan."""
    plot = _plain_figure(name, height, x_range=x_range, y_range=Range1d(start=0, end=1))
    wheel = WheelZoomTool(dimensions="width")
    pan = PanTool(dimensions="width")
    plot.add_tools(pan, wheel, SaveTool(), CrosshairTool(overlay=crosshair))
    plot.toolbar.active_scroll, plot.toolbar.active_drag = wheel, pan
    plot.xaxis.ticker = plot.xgrid.ticker = ticker
    # Both panels end at the same pixel, whatever their labels.
    plot.min_border_left = plot.min_border_right = 70
    return plot


def _load_figure(x_range: Range1d, ticker: FixedTicker, crosshair: Span) -> Any:
    plot = _time_figure("load", 300, x_range, ticker, crosshair)
    plot.yaxis.axis_label = "Tangential load F_X [N]"
    plot.xaxis.major_label_text_font_size = "0px"
    plot.xaxis.major_tick_line_color = None
    line = plot.line(
        "time", "load", source=_empty("curve", "time", "load"), color=style.BLACK, line_width=1.3
    )
    events = plot.scatter(
        "onset",
        "before",
        source=_empty("onsets", "onset", "before", "event", "length", "what", "color"),
        size=6,
        fill_color="color",
        line_color=None,
    )
    plot.add_layout(
        Span(
            name="first global slip",
            dimension="height",
            location=None,
            line_color=style.VERMILION,
            line_dash="dashed",
            line_width=1,
        )
    )
    plot.add_tools(
        HoverTool(
            renderers=[line],
            mode="vline",
            line_policy="interp",
            point_policy="follow_mouse",
            tooltips=[("t", "$snap_x{0.000000000} s"), ("F_X", "$snap_y{0.0000} N")],
        ),
        HoverTool(
            renderers=[events],
            tooltips=[
                ("event", "@event, @what"),
                ("onset", "@onset{0.000000000} s"),
                ("F_X at onset", "@before{0.0000} N"),
                ("L_p", "@length{0.0} mm"),
            ],
        ),
    )
    return plot


def _raster_figure(x_range: Range1d, ticker: FixedTicker, crosshair: Span) -> Any:
    plot = _time_figure("raster", 270, x_range, ticker, crosshair)
    plot.yaxis.axis_label = "Block"
    columns = ("left", "right", "bottom", "top", "color")
    shown = ("event", "block", "mode", "start", "end", "load", "length", "lasts")
    slides = plot.quad(
        left="left",
        right="right",
        bottom="bottom",
        top="top",
        fill_color="color",
        line_color=None,
        source=_empty("slides", *columns, *shown),
    )
    plot.ygrid.grid_line_color = None
    plot.yaxis.ticker = FixedTicker(ticks=[], minor_ticks=[], name="blocks")
    plot.add_tools(
        HoverTool(
            renderers=[slides],
            tooltips=[
                ("block", "@block slides @mode"),
                ("from", "@start{0.000000000} s"),
                ("lasts", "@lasts{0.000} \N{MICRO SIGN}s"),
                ("F_X", "@load{0.0000} N"),
                ("event", "@event"),
                ("L_p", "@length{0.0} mm"),
            ],
        )
    )
    return plot


def _lengths_figure() -> Any:
    plot = _plain_figure("lengths", 520, x_range=Range1d(start=0, end=1), y_range=Range1d(start=0, end=1.06))
    plot.xaxis.axis_label = "Tangential load F_X [N]"
    plot.yaxis.axis_label = "Propagation length L_p/L"
    pan, wheel = PanTool(), WheelZoomTool()
    plot.add_tools(pan, wheel, ResetTool(), SaveTool())
    plot.toolbar.active_drag, plot.toolbar.active_scroll = pan, wheel
    columns = ("load", "reached", "event", "scene", "what", "onset", "length", "color", "fill", "size")
    short = plot.scatter(
        "load",
        "reached",
        marker="x",
        size=7,
        color="color",
        alpha=0.7,
        source=_empty("short", *columns),
    )
    kept = plot.scatter(
        "load",
        "reached",
        size="size",
        line_color="color",
        fill_color="fill",
        line_width=1.4,
        source=_empty("kept", *columns),
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
    plot.add_tools(
        HoverTool(
            renderers=[kept, short],
            tooltips=[
                ("scene", "@scene"),
                ("event", "@event, @what"),
                ("F_X", "@load{0.0000} N"),
                ("L_p", "@length{0.0} mm"),
                ("onset", "@onset{0.000000000} s"),
            ],
        )
    )
    return plot


def _choice(scene: Scene) -> str:
    """The button that shows a scene."""
    label = html.escape(f"{theta_text(scene.theta)}: {scene.title}")
    return f'<button type="button" data-scene="{html.escape(scene.name)}">{label}</button>'


def _packed(values: Any) -> str:
    doubles: NDArray = np.ascontiguousarray(values, dtype="<f8")
    return base64.b64encode(doubles.tobytes()).decode("ascii")


def _json(value: object) -> str:
    """JSON that may stand inside a script element."""
    return json.dumps(value, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
