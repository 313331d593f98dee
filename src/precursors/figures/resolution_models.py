"""The paper's numbers against the number of blocks, with viscosity and with interface springs."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from precursors.figures import style
from precursors.figures.resolution import BAND, SCALES, draw_experiments_mu_sapp, finish

HEIGHT_MM = 100.0
QUANTITIES = ("events_counted", "mu_sapp", "front_speed_m_per_s")
PLAIN = "paper's chain"
# Whether a model has viscosity, whether it has interface springs, and what such models are called.
KINDS = {
    (True, False): "viscosity alone",
    (False, True): "interface springs alone",
    (True, True): "both",
}
# Columns that tell the models of a kind apart, the factor to the unit that is shown, and the words.
VALUES = {
    "interface_stiffness_N_per_m": (1e-6, "$K_t = {:.4g}$ MN/m"),
    "viscous_time_s": (1e6, "$t_v = {:.3g}$ µs"),
    "viscosity_N_s_per_m": (1.0, r"$\eta = {:.3g}$ N s/m"),
}
COLORS = (style.VERMILION, style.BLUE, style.GREEN, style.PURPLE, style.ORANGE, style.SKY)
MARKERS = ("o", "s", "^", "v", "D", "P")
DASHES = ("-", "--", ":")
MANY = 10  # so many runs have a band; fewer are dots
DOTS: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": 3, "markeredgewidth": 0}
DOTS |= {"alpha": 0.7}


def draw(table: pd.DataFrame, runs: pd.DataFrame, papers_n: int) -> Figure:
    """Draw three numbers against N, a row of panels for each kind of model; the paper's chain is grey.

    Parameters
    ----------
    table : DataFrame
        resolution_models.csv: medians are lines, and 5 to 95 % of the runs are bands; the second and third
        theta are dashed and dotted.
    runs : DataFrame
        resolution_models_runs.csv: single runs, drawn as dots where they are few.
    papers_n : int
        Number of blocks that a dotted line marks.
    """
    damped = (table["viscous_time_s"] > 0.0) | (table["viscosity_N_s_per_m"] > 0.0)
    sprung = table["interface_stiffness_N_per_m"] > 0.0
    of_kind = {kind: table[(damped == kind[0]) & (sprung == kind[1])] for kind in KINDS}
    kinds = [kind for kind in KINDS if len(of_kind[kind])]
    with style.page(style.PAGE_MM, HEIGHT_MM * len(kinds) / len(KINDS)) as figure:
        axes = figure.subplots(len(kinds), len(QUANTITIES), sharex=True, sharey="col", squeeze=False)
        for row, kind in zip(axes, kinds, strict=True):
            for panel, quantity in zip(row, QUANTITIES, strict=True):
                dots = runs[runs["quantity"] == quantity]
                for models, is_plain in ((table[~damped & ~sprung], True), (of_kind[kind], False)):
                    _draw_models(panel, models[models["quantity"] == quantity], dots, quantity, is_plain)
                finish(panel, quantity, papers_n)
                panel.yaxis.set_minor_formatter(NullFormatter())
                if kind != kinds[len(kinds) // 2]:
                    panel.set_ylabel("")  # the middle row has the labels of all
            row[0].legend(loc="upper left", handlelength=1.4, labelspacing=0.25, borderaxespad=0.2)
            draw_experiments_mu_sapp(row[1])
            row[1].set_title(_title(of_kind[kind], kind))
        for panel in axes[-1]:
            panel.set_xlabel(style.BLOCKS_LABEL)
            style.set_ticks(panel.xaxis, sorted(table["n_blocks"].unique()))
        entries = [
            style.mark(f"median of the {PLAIN}", color=style.GREY),
            BAND,
            style.mark("one run", **DOTS),
            style.mark("experiment's $\\mu_\\mathrm{sapp}$", color=style.ORANGE, linestyle=":"),
            style.mark(f"$N = {papers_n}$", **style.DOTTED),
        ]
        style.draw_key(figure, entries)
    return figure


def _draw_models(axes: Axes, table: pd.DataFrame, runs: pd.DataFrame, quantity: str, is_plain: bool) -> None:
    """Draw a line with its runs for each model and theta; the paper's chain is grey."""
    scale = SCALES.get(quantity, 1.0)
    for i, (name, model) in enumerate(table.groupby("model", sort=False)):
        color, marker = (style.GREY, "") if is_plain else (COLORS[i % len(COLORS)], MARKERS[i % len(MARKERS)])
        for dashes, (theta, chain) in zip(DASHES, model.groupby("theta", sort=False), strict=False):
            style.draw_band(axes, chain, color, scale, where=chain["n"] >= MANY)
            few = runs["n_blocks"].isin(chain.loc[chain["n"] < MANY, "n_blocks"])
            dots = runs[few & (runs["model"] == name) & (runs["theta"] == theta)]
            axes.plot(dots["n_blocks"], dots["value"] * scale, **DOTS, color=color)
            look: dict[str, Any] = {"color": color, "marker": marker, "markersize": 2.8, "linestyle": dashes}
            shown = _name(model, table) if dashes == DASHES[0] and not is_plain else None
            axes.plot(chain["n_blocks"], chain["q50"] * scale, **look, label=shown)


def _name(model: pd.DataFrame, models: pd.DataFrame) -> str:
    """Those values of a model that tell it from the other models of its kind."""
    differing = [column for column in VALUES if len(set(models[column])) > 1] or list(VALUES)
    parts = []
    for column in differing:
        (factor, words), value = VALUES[column], model[column].iloc[0]
        parts += [words.format(value * factor)] if value else []
    return ", ".join(parts)


def _title(table: pd.DataFrame, kind: tuple[bool, bool]) -> str:
    """What the models of a row have in common."""
    viscosity = table["viscosity_N_s_per_m"]
    if kind != (True, True) or len(set(viscosity)) > 1:
        return KINDS[kind]
    return f"{KINDS[kind]}, {VALUES[str(viscosity.name)][1].format(viscosity.iloc[0])}"
