"""Which model answers which question: questions down, models across; value, error and
cost in each cell."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from precursors.figures import style

WIDTH_MM = 178.0
ROW_MM = 14.0
HEAD_MM = 31.0
ANSWERED: dict[str, Any] = {"facecolor": "#C4C4C4"}
MISSED: dict[str, Any] = {
    "facecolor": "white",
    "edgecolor": style.GREY,
    "linewidth": 0.5,
}
SMALLEST: dict[str, Any] = {"fill": False, "edgecolor": style.BLACK, "linewidth": 1.4}
QUESTIONS = {
    "first_load": "First precursor,\nload [N]",
    "events_counted": style.EVENTS_LABEL,
    "mu_sapp": style.MU_SAPP_LABEL,
    "mu_sapp_band": "95 % of runs below\n" + style.MU_SAPP_LABEL,
    "front_loads": "$L_p$ against $F_X$,\nload at $L/2$ [N]",
    "slip_duration": "Global slip,\nduration [ms]",
    "waveform": "Waveform $F_X(t)$,\npeak [N]",
}
SCALES = {"slip_duration": 1e3}  # from the SI unit to what is shown
MODELS = {
    "statics": "statics",
    "front law": "front\nlaw",
    "rigid slider": "rigid\nslider",
    "overdamped chain": "over-\ndamped\nchain",
    "quasi-static chain": "quasi-\nstatic\nchain",
    "paper's chain": "paper's\nchain",
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw the values over the scenes, the largest error and the median cost of each
    model.

    The table is model_comparison.csv.
    """
    cells = table.groupby(["question", "label"]).agg(
        low=("value", "min"),
        high=("value", "max"),
        error=("error", "max"),
        error_unit=("error_unit", "first"),
        cost_s=("cost_s", "median"),
        is_answer=("is_answer", "all"),
        is_smallest=("is_smallest", "any"),
    )
    questions = table.drop_duplicates("question")
    models = sorted(table["label"].unique(), key=list(MODELS).index)
    with style.page(WIDTH_MM, HEAD_MM + ROW_MM * len(questions)) as figure:
        axes = figure.subplots()
        for y, question in enumerate(questions["question"]):
            for x, model in enumerate(models):
                if (question, model) in cells.index:
                    _draw_cell(
                        axes,
                        x,
                        y,
                        cells.loc[question, model],
                        SCALES.get(question, 1.0),
                    )
                else:
                    axes.text(
                        x, y, "\N{EN DASH}", ha="center", va="center", color=style.GREY
                    )
        axes.set(xlim=(-0.5, len(models) - 0.5), ylim=(len(questions) - 0.5, -0.5))
        axes.set_xticks(
            range(len(models)), [MODELS[model] for model in models], fontsize=7
        )
        axes.set_yticks(
            range(len(questions)), [_row_label(row) for _, row in questions.iterrows()]
        )
        axes.tick_params(length=0, top=False, labeltop=True, labelbottom=False)
        axes.spines[:].set_visible(False)
        entries = [
            Patch(**ANSWERED, label="within the tolerance in every scene"),
            Patch(**SMALLEST, label="smallest such model"),
            Patch(**MISSED, label="not within it"),
        ]
        lines = "In each cell: values of the scenes, $\\bf{largest\\ error}$, median time of all answers"
        style.draw_key(figure, entries, title=lines, title_fontsize=7)
    return figure


def _draw_cell(axes: Axes, x: float, y: int, cell: pd.Series, scale: float) -> None:
    axes.add_patch(_box(x, y, **(ANSWERED if cell["is_answer"] else MISSED)))
    if cell["is_smallest"]:
        axes.add_patch(_box(x, y, **SMALLEST))
    low = f"{cell['low'] * scale:.3g}"
    high = f"{cell['high'] * scale:.3g}"
    centred: dict[str, Any] = {"ha": "center", "va": "center"}
    axes.text(
        x,
        y - 0.26,
        low if low == high else f"{low}\N{EN DASH}{high}",
        fontsize=7,
        **centred,
    )
    error = _error_text(cell["error"], cell["error_unit"])
    axes.text(x, y + 0.02, error, fontsize=7, fontweight="bold", **centred)
    axes.text(x, y + 0.3, _time_text(cell["cost_s"]), fontsize=7, **centred)


def _box(x: float, y: int, **look: Any) -> Rectangle:
    return Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, **{"edgecolor": "none", **look})


def _row_label(row: pd.Series) -> str:
    within = _error_text(row["tolerance"], row["error_unit"])
    return f"{QUESTIONS.get(row['question'], row['question'])}\n(within {within})"


def _error_text(error: float, unit: str) -> str:
    if error == 0:
        return "exact"
    if unit != "1":
        return f"{error:g} {unit}" if error != 1 else f"1 {unit.removesuffix('s')}"
    if error < 1e-4:
        return rf"$10^{{{round(np.log10(error))}}}$"
    return f"{100 * error:.2g} %" if error < 1 else f"{100 * error:.0f} %"


def _time_text(seconds: float) -> str:
    for size, unit in ((1e-3, "ms"), (1e-6, "µs")):
        if seconds >= size:
            return (
                f"{seconds / size:.2g} {unit}"
                if seconds < 100 * size
                else f"{seconds / size:.0f} {unit}"
            )
    return "< 1 µs"
