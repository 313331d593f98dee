"""Which model answers which question: questions down, models across; value, error and
cost in each cell."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import EngFormatter

from precursors.figures import style
from precursors.figures.style import Options

ROW_MM = 14.0
HEAD_MM = 27.0
ANSWERED: Options = {"facecolor": "#C4C4C4", "edgecolor": "none"}
MISSED: Options = {"facecolor": "white", "edgecolor": style.GREY, "linewidth": 0.5}
SMALLEST: Options = {"fill": False, "edgecolor": style.BLACK, "linewidth": 1.4}
CENTRED: Options = {"ha": "center", "va": "center"}
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
    "law": "front law",
    "rigid": "rigid slider",
    "overdamped": "overdamped chain",
    "quasistatic": "quasi-static chain",
    "chain": "paper's chain",
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw the values over the scenes, the largest error and the median cost of each
    model.

    The table is model_comparison.csv.
    """
    cells = table.groupby(["question", "model"]).agg(
        low=("value", "min"),
        high=("value", "max"),
        error=("error", "max"),
        error_unit=("error_unit", "first"),
        cost_s=("cost_s", "median"),
        is_answer=("is_answer", "all"),
        is_smallest=("is_smallest", "any"),
    )
    questions = table.drop_duplicates("question")
    models = sorted(table["model"].unique(), key=list(MODELS).index)
    with style.page(style.PAGE_MM, HEAD_MM + ROW_MM * len(questions)) as figure:
        axes = figure.subplots()
        for y, question in enumerate(questions["question"]):
            for x, model in enumerate(models):
                if (question, model) in cells.index:
                    cell = cells.loc[question, model]
                    _draw_cell(axes, x, y, cell, SCALES.get(question, 1.0))
                else:
                    axes.text(x, y, "\N{EN DASH}", color=style.GREY, **CENTRED)
        axes.set(xlim=(-0.5, len(models) - 0.5), ylim=(len(questions) - 0.5, -0.5))
        axes.set_xticks(
            range(len(models)), [MODELS[model].replace(" ", "\n") for model in models]
        )
        labels = [_row_label(row) for _, row in questions.iterrows()]
        axes.set_yticks(range(len(labels)), labels)
        axes.tick_params(length=0, top=False, labeltop=True, labelbottom=False)
        axes.spines[:].set_visible(False)
        entries = [
            Patch(**ANSWERED, label="within the tolerance in every scene"),
            Patch(**SMALLEST, label="smallest such model"),
            Patch(**MISSED, label="not within it"),
        ]
        axes.set_xlabel(
            "In each cell: values of the scenes, $\\bf{largest\\ error}$, "
            "median time of all answers"
        )
        style.draw_key(figure, entries)
    return figure


def _draw_cell(axes: Axes, x: float, y: int, cell: pd.Series, scale: float) -> None:
    looks = [ANSWERED if cell["is_answer"] else MISSED]
    if cell["is_smallest"]:
        looks.append(SMALLEST)
    for look in looks:
        axes.add_patch(Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, **look))
    low = f"{cell['low'] * scale:.3g}"
    high = f"{cell['high'] * scale:.3g}"
    values = low if low == high else f"{low}\N{EN DASH}{high}"
    error = _error_text(cell["error"], cell["error_unit"])
    cost = EngFormatter("s", places=0)(cell["cost_s"])
    for height, text, weight in (
        (-0.26, values, "normal"),
        (0.02, error, "bold"),
        (0.3, cost, "normal"),
    ):
        axes.text(x, y + height, text, fontsize="small", fontweight=weight, **CENTRED)


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
