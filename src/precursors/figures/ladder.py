"""The ladder of models as a chart: questions down, models across; value, error and cost in each cell."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from precursors.figures import style
from precursors.model.scene_models import NO_ADDITION

WIDTH_MM = 175.0
ROW_MM, HEAD_MM = 14.0, 26.0
# Beyond the paper's chain: how far columns stand off, in their widths.
GAP = 0.2
LADDER_COLUMNS = {
    "scene": str,
    "question": str,
    "model_number": int,
    "label": str,
    "value": float,
    "unit": str,
    "error": float,
    "error_unit": str,
    "tolerance": float,
    "is_answer": bool,
    "is_smallest": bool,
    "cost_s": float,
    "addition": str,
}
DIM = "#5A5A5A"
ANSWERED, MISSED, SILENT = "#CDE7DC", "#F6DDD0", "#F2F2F2"
QUESTION_LABELS = {
    "first_load": "First precursor,\nload [N]",
    "events_kept": "Events kept [-]",
    "mu_sapp": "$\\mu_\\mathrm{sapp}$ [-]",
    "front_loads": "$L_p$ against $F_X$,\nload at $L/2$ [N]",
    "slip_duration": "Global slip,\nduration [ms]",
    "waveform": "Waveform $F_X(t)$,\npeak [N]",
}
# What values are shown in, as a multiple of their SI unit.
SCALES = {"slip_duration": 1e3}
HEADS = {
    "statics": "statics",
    "front law": "front\nlaw",
    "rigid slider": "rigid\nslider",
    "overdamped chain": "over-\ndamped\nchain",
    "quasi-static chain": "quasi-\nstatic\nchain",
    "paper's chain": "paper's\nchain",
    "with viscosity": "with\nviscosity",
    "with interface springs": "with\ninterface\nsprings",
    "with head mass": "with\nhead mass",
}


def read_ladder(path: str | Path) -> pd.DataFrame:
    """Read the table of the ladder (tables/ladder.csv).

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return style.read_columns(path, LADDER_COLUMNS)


def draw_ladder(ladder: pd.DataFrame) -> Figure:
    """Draw the values over the scenes, the largest error and the median cost of each model for each question.

    Green cells answer within the tolerance in every scene; the smallest model that does has a frame. Models
    that add to the paper's chain stand apart.

    Parameters
    ----------
    ladder : DataFrame
        See `read_ladder`.
    """
    questions = list(dict.fromkeys(ladder["question"]))
    models = ladder.sort_values("model_number").drop_duplicates("label")
    added = models["addition"] != NO_ADDITION
    places = np.arange(len(models)) + GAP * added.to_numpy()
    with style.styled():
        figure = style.new_figure(WIDTH_MM, HEAD_MM + ROW_MM * len(questions))
        axes = figure.subplots()
        for y, question in enumerate(questions):
            for x, model in zip(places, models["label"], strict=True):
                cell = ladder[(ladder["question"] == question) & (ladder["label"] == model)]
                _draw_cell(axes, x, y, cell)
        axes.set_xlim(places[0] - 0.5, places[-1] + 0.5)
        axes.set_ylim(len(questions) - 0.5, -0.5)
        heads = [_head(model) for _, model in models.iterrows()]
        axes.set_xticks(places, heads, fontsize=6.5)
        axes.set_yticks(range(len(questions)), [_row_label(ladder, question) for question in questions])
        axes.tick_params(length=0, top=False, labeltop=True, labelbottom=False)
        axes.spines[:].set_visible(False)
        style.lay_out(figure)
    return figure


def _head(model: pd.Series) -> str:
    """Name of a model, and the value of what it adds."""
    name = HEADS.get(str(model["label"]), str(model["label"]).replace(" ", "\n", 1))
    if model["addition"] == NO_ADDITION:
        return name
    value, _, unit = str(model["addition"]).partition(" ")
    number, unit = (float(value) * 1e-6, f"M{unit}") if float(value) >= 1e6 else (float(value), unit)
    return f"{name}\n{number:.3g} {unit}"


def _draw_cell(axes: Axes, x: float, y: int, cell: pd.DataFrame) -> None:
    answered = len(cell) > 0 and bool(cell["is_answer"].all())
    color = SILENT if cell.empty else ANSWERED if answered else MISSED
    axes.add_patch(Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, facecolor=color, edgecolor="none"))
    if cell.empty:
        axes.text(x, y, "\N{EN DASH}", ha="center", va="center", color=style.GREY)
        return
    if cell["is_smallest"].any():
        frame = Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, fill=False, edgecolor=style.GREEN, linewidth=1.4)
        axes.add_patch(frame)
    centred: dict[str, Any] = {"ha": "center", "va": "center"}
    values = cell["value"] * SCALES.get(str(cell["question"].iloc[0]), 1.0)
    axes.text(x, y - 0.26, _range_text(values.min(), values.max()), fontsize=6, **centred)
    error = _error_text(float(cell["error"].max()), str(cell["error_unit"].iloc[0]))
    axes.text(x, y + 0.02, error, fontsize=6.5, fontweight="bold", **centred)
    cost = _time_text(float(cell["cost_s"].median()))
    axes.text(x, y + 0.3, cost, fontsize=6, color=DIM, **centred)


def _range_text(low: float, high: float) -> str:
    """Values over the scenes, from the least to the largest."""
    first, last = f"{low:.3g}", f"{high:.3g}"
    return first if first == last else f"{first}\N{EN DASH}{last}"


def _row_label(ladder: pd.DataFrame, question: str) -> str:
    row = ladder[ladder["question"] == question].iloc[0]
    within = _error_text(float(row["tolerance"]), str(row["error_unit"]))
    return f"{QUESTION_LABELS.get(question, question)}\n(within {within})"


def _error_text(error: float, unit: str) -> str:
    if error == 0:
        return "exact"
    if unit != "1":
        return f"{error:g} {unit}" if error != 1 else f"1 {unit.removesuffix('s')}"
    if error < 1e-4:
        return rf"$10^{{{int(np.floor(np.log10(error) + 0.5))}}}$"
    return f"{100 * error:.2g} %" if error < 1 else f"{100 * error:.0f} %"


def _time_text(seconds: float) -> str:
    for size, unit in ((1e-3, "ms"), (1e-6, "µs")):
        if seconds >= size:
            return f"{seconds / size:.2g} {unit}" if seconds < 100 * size else f"{seconds / size:.0f} {unit}"
    return "< 1 µs"
