"""Events counted and mu_sapp where one of the paper's words is read in another way."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from precursors.figures import style

ROW_MM = 6.0
MARGIN_MM = 26.0
LOADINGS = 3
# Shades by how many of the two numbers of a cell are the paper's.
OF_TWO = ListedColormap(["white", "#D6EAF7", style.SKY])
# The column that says what a reading has instead of ours.
CHANGED = {
    "global slip": "global_slip",
    "short event": "short",
    "length": "front",
    "size of theta": "degree",
    "switching": "switching",
}
SYMBOLS = {
    "F_X": "$F_X$",
    "|F| <= mu_k w": r"$|F| \leq \mu_k w$",
    "size of theta": r"$|\theta|$",
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw a row for each reading of definitions.csv, and a column for each loading and
    for the count of six.

    The first row is ours, and each other one has one change.
    """
    readings = [table.iloc[i : i + LOADINGS] for i in range(0, len(table), LOADINGS)]
    of_two = (
        table["events_counted_is_papers"].astype(int)
        + table["mu_sapp_is_papers_within_a_digit"]
    )
    with style.page(style.PAGE_MM, MARGIN_MM + ROW_MM * len(readings)) as figure:
        axes = figure.subplots()
        edges: dict[str, Any] = {"edgecolors": style.GREY, "linewidth": 0.4}
        shades = of_two.to_numpy().reshape(-1, LOADINGS)
        axes.pcolormesh(shades, cmap=OF_TWO, vmin=-0.5, vmax=OF_TWO.N - 0.5, **edges)
        for row, reading in enumerate(readings):
            numbers = zip(reading["events_counted"], reading["mu_sapp"], strict=True)
            texts = [f"{_number(n, '.0f')}   {_number(mu, '.3f')}" for n, mu in numbers]
            for column, text in enumerate(
                [*texts, f"{reading['numbers_within_a_digit'].iloc[0]} of 6"]
            ):
                axes.text(column + 0.5, row + 0.5, text, ha="center", va="center")
        axes.set_yticks(
            [row + 0.5 for row in range(len(readings))],
            [_name(r.iloc[0]) for r in readings],
        )
        heads = [r"$\theta < 0$", r"$\theta = 0$", r"$\theta > 0$", "the paper's"]
        axes.set_xticks([column + 0.5 for column in range(LOADINGS + 1)], heads)
        axes.xaxis.tick_top()
        axes.tick_params(length=0)
        axes.set(xlim=(0, LOADINGS + 1), ylim=(len(readings), 0))
        axes.set_title(r"Events counted and $\mu_{\mathrm{sapp}}$")
        labels = {2: "both are the paper's", 1: "one is", 0: "none is"}
        key = [
            Patch(facecolor=OF_TWO(n), label=text, edgecolor=style.GREY, linewidth=0.4)
            for n, text in labels.items()
        ]
        style.draw_key(figure, key)
    return figure


def _name(reading: pd.Series) -> str:
    """What a reading has instead of ours."""
    if reading["changed"] not in CHANGED:
        return "our reading"
    name = f"{reading['changed']}: {reading[CHANGED[reading['changed']]]}"
    for words, symbol in SYMBOLS.items():
        name = name.replace(words, symbol)
    return name


def _number(value: float, form: str) -> str:
    return "-" if pd.isna(value) else f"{value:{form}}"
