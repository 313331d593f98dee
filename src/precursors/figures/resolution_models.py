"""What the number of blocks makes of the paper's numbers, with viscosity and with interface springs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

from precursors.figures import style
from precursors.figures.resolution import LABELS, SCALES, draw_experiments_mu_sapp, mark_papers_n

HEIGHT_MM = 132.0
QUANTITIES = ("events_kept", "mu_sapp", "front_speed_m_per_s")
VALUES = ["viscous_time_s", "viscosity_N_s_per_m", "interface_stiffness_N_per_m"]
COLUMNS = {
    "model": str,
    "theta": float,
    **dict.fromkeys(VALUES, float),
    "n_blocks": int,
    "quantity": str,
    "q05": float,
    "q50": float,
    "q95": float,
    "n": int,
}
RUN_COLUMNS = {
    "model": str,
    "theta": float,
    **dict.fromkeys(VALUES, float),
    "n_blocks": int,
    "quantity": str,
    "value": float,
}
ROWS = {
    (True, False): "viscosity alone",
    (False, True): "interface springs alone",
    (True, True): "both",
}
COLORS = (style.VERMILION, style.BLUE, style.GREEN, style.PURPLE, style.ORANGE, style.SKY)
MARKERS = ("o", "s", "^", "v", "D", "P")
DASHES = ("-", "--", ":")
# So many runs have a band; fewer are dots.
MANY = 10
DOTS: dict[str, Any] = {
    "linestyle": "none",
    "marker": ".",
    "markersize": 3,
    "markeredgewidth": 0,
    "alpha": 0.7,
}


def draw_resolution_models(table: pd.DataFrame, runs: pd.DataFrame, papers_n: int) -> Figure:
    """Draw three numbers against N: medians, and of the runs bands of 5 to 95 %, or dots where they are few.

    The paper's chain is grey.

    Parameters
    ----------
    table : DataFrame
        tables/resolution_models.csv, see `COLUMNS`; further theta are drawn dashed and dotted.
    runs : DataFrame
        tables/resolution_models_runs.csv, see `RUN_COLUMNS`.
    papers_n : int
        Number of blocks that a dotted line marks.
    """
    damped = (table["viscous_time_s"] > 0.0) | (table["viscosity_N_s_per_m"] > 0.0)
    sprung = table["interface_stiffness_N_per_m"] > 0.0
    kinds = [kind for kind in ROWS if ((damped == kind[0]) & (sprung == kind[1])).any()] or [(False, False)]
    plain = table[~damped & ~sprung]
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM * len(kinds) / len(ROWS))
        axes = figure.subplots(len(kinds), len(QUANTITIES), sharex=True, sharey="col", squeeze=False)
        for row, kind in zip(axes, kinds, strict=True):
            of_kind = table[(damped == kind[0]) & (sprung == kind[1])] if any(kind) else table.iloc[:0]
            for panel, quantity in zip(row, QUANTITIES, strict=True):
                dots = runs[runs["quantity"] == quantity]
                _draw_models(panel, plain[plain["quantity"] == quantity], dots, quantity, "paper's chain")
                _draw_models(panel, of_kind[of_kind["quantity"] == quantity], dots, quantity)
                _finish(panel, quantity, papers_n)
            row[0].legend(loc="lower right", handlelength=1.4, labelspacing=0.25, borderaxespad=0.2)
            draw_experiments_mu_sapp(row[1])
            row[1].set_title(_title(of_kind, kind), fontsize=8)
        handles, labels = axes[0, 1].get_legend_handles_labels()
        shown = [(h, text) for h, text in zip(handles, labels, strict=True) if text.startswith("experiment")]
        axes[0, 1].legend(*zip(*shown, strict=True), loc="upper right", handlelength=1.4)
        _draw_ticks(axes, sorted(table["n_blocks"].unique()))
        style.lay_out(figure)
    return figure


def _draw_models(
    axes: Axes, table: pd.DataFrame, runs: pd.DataFrame, quantity: str, label: str | None = None
) -> None:
    """A line with its runs for each model and theta; the paper's chain, which has a label, in grey."""
    scale = SCALES.get(quantity, 1.0)
    names = [name for name in VALUES if len(set(table[name])) > 1] or VALUES
    for i, (_, model) in enumerate(table.groupby("model", sort=False)):
        look: dict[str, Any] = {"color": COLORS[i % len(COLORS)], "marker": MARKERS[i % len(MARKERS)]}
        if label:
            look = {"color": style.GREY, "marker": None}
        for dashes, (theta, chain) in zip(DASHES, model.groupby("theta", sort=False), strict=False):
            n, low, middle, high = (chain[name] for name in ("n_blocks", "q05", "q50", "q95"))
            band: dict[str, Any] = {"color": look["color"], "alpha": 0.15, "linewidth": 0}
            axes.fill_between(n, low * scale, high * scale, where=chain["n"] >= MANY, **band)
            few = runs["n_blocks"].isin(n[chain["n"] < MANY])
            dots = runs[few & (runs["model"] == model["model"].iloc[0]) & (runs["theta"] == theta)]
            axes.plot(dots["n_blocks"], dots["value"] * scale, **DOTS, color=look["color"])
            name = (label or _name(model.iloc[0], names)) if dashes == "-" else None
            axes.plot(n, middle * scale, **look, markersize=2.8, linestyle=dashes, label=name)


def _name(row: pd.Series, names: list[str]) -> str:
    """Those values of a model that tell it from the others of its row, in the units of docs/models.md."""
    row = row.where(row.index.isin(names), 0.0)
    parts = []
    if row["viscous_time_s"]:
        parts.append(rf"$t_v = {row['viscous_time_s'] * 1e6:.3g}$ µs")
    if row["viscosity_N_s_per_m"]:
        parts.append(rf"$\eta = {row['viscosity_N_s_per_m']:.3g}$ N s/m")
    if row["interface_stiffness_N_per_m"]:
        parts.insert(0, rf"$K_t = {row['interface_stiffness_N_per_m'] * 1e-6:.4g}$ MN/m")
    return ", ".join(parts)


def _title(table: pd.DataFrame, kind: tuple[bool, bool]) -> str:
    """What the models of a row have in common."""
    if kind != (True, True) or len(set(table["viscosity_N_s_per_m"])) > 1:
        return ROWS.get(kind, "")
    return rf"{ROWS[kind]}, $\eta = {table['viscosity_N_s_per_m'].iloc[0]:.3g}$ N s/m"


def _finish(axes: Axes, quantity: str, papers_n: int) -> None:
    axes.set_xscale("log")
    axes.set_ylabel(LABELS[quantity])
    mark_papers_n(axes, papers_n)
    if quantity == "events_kept":
        axes.set_yscale("log")
        ticks = [1, 2, 5, 10, 20, 50, 100]
        axes.set_yticks(ticks, [str(tick) for tick in ticks])


def _draw_ticks(axes: np.ndarray, n_blocks: list[int]) -> None:
    for panel in axes.flat:
        panel.set_xticks(n_blocks, [str(n) for n in n_blocks])
        panel.xaxis.set_minor_locator(NullLocator())
        panel.yaxis.set_minor_formatter(NullFormatter())
    for panel in axes[-1]:
        panel.set_xlabel("Number of blocks $N$ [-]")
