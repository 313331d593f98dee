"""The ladder of models as a chart: questions down, models across, error and cost in each cell."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from precursors.figures import style

WIDTH_MM = 175.0
ROW_MM, HEAD_MM = 13.0, 18.0
LADDER_COLUMNS = {
    "scene": str,
    "question": str,
    "rung": int,
    "label": str,
    "value": float,
    "error": float,
    "error_unit": str,
    "tolerance": float,
    "is_answer": bool,
    "is_smallest": bool,
    "cost_s": float,
}
ANSWERED, MISSED, SILENT = "#CDE7DC", "#F6DDD0", "#F2F2F2"
QUESTION_LABELS = {
    "first_load": "Load of the\nfirst precursor",
    "events_kept": "Number of\nevents kept",
    "mu_sapp": r"$\mu_\mathrm{sapp}$",
    "front_loads": "$L_p$ against $F_X$",
    "slip_duration": "Duration of the\nglobal slip",
    "waveform": "Waveform $F_X(t)$",
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
    """Draw the largest error over the scenes and the median cost of each model for each question.

    Green cells answer within the tolerance in every scene; the smallest model that does has a frame.

    Parameters
    ----------
    ladder : DataFrame
        See `read_ladder`.
    """
    questions = list(dict.fromkeys(ladder["question"]))
    models = list(ladder.sort_values("rung")["label"].unique())
    with style.styled():
        figure = style.new_figure(WIDTH_MM, HEAD_MM + ROW_MM * len(questions))
        axes = figure.subplots()
        for y, question in enumerate(questions):
            for x, model in enumerate(models):
                cell = ladder[(ladder["question"] == question) & (ladder["label"] == model)]
                _draw_cell(axes, x, y, cell)
        axes.set_xlim(-0.5, len(models) - 0.5)
        axes.set_ylim(len(questions) - 0.5, -0.5)
        axes.set_xticks(range(len(models)), [label.replace(" ", "\n", 1) for label in models])
        axes.set_yticks(range(len(questions)), [_row_label(ladder, question) for question in questions])
        axes.tick_params(length=0, top=False, labeltop=True, labelbottom=False)
        axes.spines[:].set_visible(False)
        style.lay_out(figure)
    return figure


def _draw_cell(axes: Axes, x: int, y: int, cell: pd.DataFrame) -> None:
    answered = len(cell) > 0 and bool(cell["is_answer"].all())
    color = SILENT if cell.empty else ANSWERED if answered else MISSED
    axes.add_patch(Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, facecolor=color, edgecolor="none"))
    if cell.empty:
        axes.text(x, y, "\N{EN DASH}", ha="center", va="center", color=style.GREY)
        return
    if cell["is_smallest"].any():
        frame = Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, fill=False, edgecolor=style.GREEN, linewidth=1.4)
        axes.add_patch(frame)
    error = _error_text(float(cell["error"].max()), str(cell["error_unit"].iloc[0]))
    axes.text(x, y - 0.16, error, ha="center", va="center", fontsize=7.5)
    cost = _time_text(float(cell["cost_s"].median()))
    axes.text(x, y + 0.22, cost, ha="center", va="center", fontsize=6.5, color=style.GREY)


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
