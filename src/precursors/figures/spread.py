"""Spread of mu_sapp and of the events counted over ensembles of chains that differ a little."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator

from precursors.figures import style

HEIGHT_MM, SWEEP_MM = 92.0, 69.0
UNPERTURBED = "none"
# Space between the ensembles of two parameters, and at the ends of the axis, in ensembles.
GAP, EDGE = 1.0, 1.2
SHADES = LinearSegmentedColormap.from_list("share", ["white", style.SKY, style.BLUE])
SYMBOLS = {"mu_s": r"$\mu_s$", "mu_k": r"$\mu_k$", "theta": r"$\theta$", "K": "$K$", "V": "$V$", "k": "$k$"}
SIZE_LABELS = {
    "loads": "Relative noise in the normal loads [-]",
    "start": r"Noise in the initial positions, in units of $\mu_s F_Z/(Nk)$ [-]",
    "parameters": "Parameter that is changed, by up to {} from left to right ($\\theta$: absolute)",
}
BINS = {"mu_sapp": 0.005, "events_counted": 1.0}  # their widths
MEDIAN: dict[str, Any] = {"marker": "_", "markersize": 5, "markeredgewidth": 1.0, "linestyle": "none"}
RUN: dict[str, Any] = {"color": style.BLUE, "marker": ".", "markersize": 1.5, "linestyle": "none"}
ALONE: dict[str, Any] = {"color": style.VERMILION, "marker": "o", "markersize": 3.5, "linestyle": "none"}


def draw(members: pd.DataFrame, spread: pd.DataFrame, question: str) -> Figure:
    """Draw the effect of small changes on mu_sapp and on the events counted, a column for each scene.

    Parameters
    ----------
    members : DataFrame
        spread_members.csv: one row per run.
    spread : DataFrame
        spread.csv: quantiles of each ensemble.
    question : {"loads", "theta", "start", "parameters"}
        Which changes. theta is a sweep, drawn run by run.
    """
    members = members[members["question"] == question]
    spread = spread[(spread["question"] == question) & (spread["quantity"] == "mu_sapp")]
    height = SWEEP_MM if question == "theta" else HEIGHT_MM
    with style.page(style.PAGE_MM, height) as figure:
        axes = _draw_sweep(figure, members) if question == "theta" else _draw_all(figure, members, spread)
        axes[0, 0].set_ylabel(style.MU_SAPP_LABEL)
        axes[1, 0].set_ylabel(style.EVENTS_LABEL)
        axes[1, 0].yaxis.set_major_locator(MaxNLocator(integer=True))
    return figure


def _draw_all(figure: Figure, members: pd.DataFrame, spread: pd.DataFrame) -> np.ndarray:
    """Draw mu_sapp of each ensemble as bars over its quantiles, and the share of each count as a shade."""
    scenes = members.groupby("scene", sort=False)
    grid: dict[str, Any] = {"sharex": True, "sharey": "row", "height_ratios": [1.3, 1]}
    axes = figure.subplots(2, len(scenes), squeeze=False, **grid)
    for (friction, counts), (scene, runs) in zip(axes.T, scenes, strict=True):
        alone = runs[runs["perturbation"] == UNPERTURBED].iloc[0]
        ensembles = spread[spread["scene"] == scene]
        group = ensembles["perturbation"].ne(ensembles["perturbation"].shift()).cumsum()
        ensembles = ensembles.assign(place=np.arange(len(ensembles)) + GAP * (group - 1))
        friction.set_title(style.theta_text(alone["theta"]))
        _draw_bars(friction, ensembles, alone["mu_sapp"])
        for _, ensemble in ensembles.iterrows():
            same = (runs["perturbation"] == ensemble["perturbation"]) & (runs["size"] == ensemble["size"])
            _draw_counts(counts, ensemble["place"], runs.loc[same, "events_counted"])
        counts.axhline(alone["events_counted"], **style.DOTTED)
        _label_ensembles(counts, ensembles)
    shades = figure.colorbar(ScalarMappable(Normalize(0, 100), SHADES), ax=axes, aspect=40, pad=0.015)
    shades.set_label("Share of the runs [%]", fontsize=7)
    shades.outline.set_linewidth(0.6)  # type: ignore[operator]
    axes[1, 0].legend(*axes[0, 0].get_legend_handles_labels(), loc="best", handlelength=1.2)
    sizes = f"{_power(spread['size'].min())} .. {_power(spread['size'].max())}"
    figure.supxlabel(SIZE_LABELS[spread["question"].iloc[0]].format(sizes), fontsize=8)
    return axes


def _draw_bars(axes: Axes, ensembles: pd.DataFrame, unperturbed: float) -> None:
    place = ensembles["place"]
    axes.plot(place, ensembles["q50"], color=style.BLACK, **MEDIAN, label="median of the runs")
    wide: dict[str, Any] = {"color": style.SKY, "linewidth": 3.0, "zorder": 1.9}
    axes.vlines(place, ensembles["q25"], ensembles["q75"], **wide, label="25 to 75 %")
    axes.vlines(place, ensembles["q05"], ensembles["q95"], color=style.BLUE, linewidth=0.8, label="5 to 95 %")
    axes.axhline(unperturbed, **style.DOTTED, label="unperturbed")


def _draw_counts(axes: Axes, place: float, counts: pd.Series) -> None:
    for count, share in counts.value_counts(normalize=True).items():
        cell = (place - 0.5, float(count) - 0.5)  # type: ignore[arg-type]
        axes.add_patch(Rectangle(cell, 1, 1, facecolor=SHADES(share), linewidth=0))


def _label_ensembles(axes: Axes, ensembles: pd.DataFrame) -> None:
    """Write the sizes below the axis, or the parameters if there are several."""
    axes.set_xlim(-EDGE, ensembles["place"].max() + EDGE)
    if len(set(ensembles["perturbation"])) > 1:
        middles = ensembles.groupby("perturbation", sort=False)["place"].mean()
        axes.set_xticks(middles, [SYMBOLS.get(name, name) for name in middles.index])
        axes.tick_params(axis="x", length=0)
    else:
        # Sizes between two powers of ten have no room for a label.
        exponents = np.log10(ensembles["size"])
        whole = ensembles[np.isclose(exponents, exponents.round())]
        shown = (whole if len(whole) else ensembles).iloc[::-2]
        axes.set_xticks(shown["place"], [_power(size) for size in shown["size"]])


def _draw_sweep(figure: Figure, members: pd.DataFrame) -> np.ndarray:
    """Draw every run as a dot over theta, and beside the dots their histogram."""
    scenes = members.groupby("scene", sort=False)
    grid: dict[str, Any] = {"sharey": "row", "height_ratios": [1.3, 1], "width_ratios": [4, 1] * len(scenes)}
    axes = figure.subplots(2, 2 * len(scenes), squeeze=False, **grid)
    for i, (_, of_scene) in enumerate(scenes):
        alone = of_scene[of_scene["perturbation"] == UNPERTURBED].iloc[0]
        runs = of_scene[of_scene["perturbation"] != UNPERTURBED]
        change = (runs["theta"] - alone["theta"]) * 1e3
        for row, (quantity, width) in enumerate(BINS.items()):
            dots, bars = axes[row, 2 * i], axes[row, 2 * i + 1]
            values = runs[quantity].dropna()
            bins = np.arange(values.min() - width / 2, values.max() + width, width)
            dots.plot(change, runs[quantity], **RUN)
            dots.plot(0.0, alone[quantity], **ALONE)
            bars.hist(values, bins=bins, orientation="horizontal", color=style.SKY)
            bars.set_xticks([])
            bars.tick_params(axis="y", length=0)
            dots.set_xlim(change.min(), change.max())
            dots.tick_params(axis="x", labelbottom=row == 1)
        axes[0, 2 * i].set_title(f"around {style.theta_text(alone['theta'])}")
        axes[1, 2 * i + 1].set_xlabel("runs", fontsize=7)
    figure.supxlabel(r"Change of $\theta$ [$10^{-3}$]", fontsize=8)
    entries = [style.mark("one run", **RUN | {"markersize": 4}), style.mark("unperturbed", **ALONE)]
    style.draw_key(figure, entries, loc="outside upper right")
    return axes


def _power(size: float) -> str:
    """Write a size as a power of ten, with its factor if it is no whole power."""
    exponent = math.floor(math.log10(size) + 1e-9)
    factor = size / 10**exponent
    return (rf"$10^{{{exponent}}}$") if abs(factor - 1) < 1e-6 else rf"${factor:.3g}\times10^{{{exponent}}}$"
