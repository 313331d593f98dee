"""Spread of mu_sapp and of the events kept over ensembles of chains that are all but the same."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator

from precursors.ensembles.spread import UNPERTURBED
from precursors.figures import style

HEIGHT_MM = 92.0
# Room between the ensembles of two parameters, in ensembles.
GAP = 1.0
# And at the ends of the axis.
EDGE = 1.2
SHADES = LinearSegmentedColormap.from_list("share", ["white", style.SKY, style.BLUE])
MEMBER_COLUMNS = {
    "scene": str,
    "question": str,
    "perturbation": str,
    "size": float,
    "theta": float,
    "events_kept": int,
    "mu_sapp": float,
}
QUANTILES = ("q05", "q25", "q50", "q75", "q95")
SPREAD_COLUMNS = {
    **dict.fromkeys(("scene", "question", "perturbation", "quantity"), str),
    **dict.fromkeys(("size", *QUANTILES), float),
}
SYMBOLS = {
    "mu_s": r"$\mu_s$",
    "mu_k": r"$\mu_k$",
    "K": "$K$",
    "V": "$V$",
    "k": "$k$",
    "theta": r"$\theta$",
}
SIZE_LABELS = {
    "loads": "Relative noise in the normal loads [-]",
    "start": r"Noise in the initial positions, in units of $\mu_s F_Z/(Nk)$ [-]",
    "parameters": "Parameter that is changed, by up to {sizes} from left to right ($\\theta$: absolute)",
}
BINS = {"mu_sapp": 0.005, "events_kept": 1.0}  # their widths
UNCHANGED_LINE: dict[str, Any] = {
    "color": style.GREY,
    "linewidth": 0.6,
    "linestyle": (0, (1, 2)),
    "zorder": 1,
}


@dataclass(frozen=True)
class Ensemble:
    """Members that were changed alike, their row of mu_sapp in spread.csv, and their place on the axis."""

    position: float
    members: pd.DataFrame
    mu_sapp: Mapping[Hashable, Any]


def read_members(path: str | Path) -> pd.DataFrame:
    """Read the table of the members (tables/spread_members.csv).

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return style.read_columns(path, MEMBER_COLUMNS)


def draw_spread(members: pd.DataFrame, spread: pd.DataFrame, question: str) -> Figure:
    """Draw what the members of one question make of mu_sapp and of the events kept.

    Parameters
    ----------
    members : DataFrame
        See `read_members`.
    spread : DataFrame
        tables/spread.csv, see `SPREAD_COLUMNS`.
    question : {"loads", "theta", "start", "parameters"}
        Which of its questions.

    Raises
    ------
    ValueError
        If there is no member of the question.
    """
    asked = members[members["question"] == question]
    if asked.empty:
        raise ValueError(f"the table has no member of the question {question!r}")
    with style.styled():
        if question == "theta":
            return _draw_sweep(asked)
        mu_sapp = spread[(spread["question"] == question) & (spread["quantity"] == "mu_sapp")]
        return _draw_ensembles(asked, mu_sapp, question)


def _draw_ensembles(members: pd.DataFrame, mu_sapp: pd.DataFrame, question: str) -> Figure:
    """Bands of mu_sapp, and shares of each count, one column a scene."""
    scenes = list(members.groupby("scene", sort=False))
    figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
    axes = figure.subplots(2, len(scenes), sharex=True, sharey="row", squeeze=False, height_ratios=[1.3, 1])
    for column, (scene, of_scene) in zip(axes.T, scenes, strict=True):
        alone = of_scene[of_scene["perturbation"] == UNPERTURBED].iloc[0]
        changed = of_scene[of_scene["perturbation"] != UNPERTURBED]
        groups = _grouped(changed, mu_sapp[mu_sapp["scene"] == scene])
        ensembles = [ensemble for group in groups for ensemble in group]
        _draw_bands(column[0], ensembles, alone["mu_sapp"])
        _draw_counts(column[1], ensembles, alone["events_kept"])
        column[0].set_title(style.theta_text(alone["theta"]), fontsize=8)
        _label_sizes(column[1], groups)
    _label_rows(axes)
    shades = figure.colorbar(ScalarMappable(Normalize(0, 100), SHADES), ax=axes, aspect=40, pad=0.015)
    shades.set_label("Share of the runs [%]", fontsize=7)
    shades.outline.set_linewidth(0.6)  # type: ignore[operator]
    axes[1, 0].legend(*axes[0, 0].get_legend_handles_labels(), loc="best", handlelength=1.2)
    sizes = np.unique(members.loc[members["perturbation"] != UNPERTURBED, "size"])
    span = f"{_power(sizes[0])} .. {_power(sizes[-1])}"
    figure.supxlabel(SIZE_LABELS[question].format(sizes=span), fontsize=8)
    style.lay_out(figure)
    return figure


def _grouped(members: pd.DataFrame, mu_sapp: pd.DataFrame) -> list[list[Ensemble]]:
    """Ensembles parameter by parameter, from the smallest size to the largest."""
    groups, position = [], 0.0
    known = mu_sapp.set_index(["perturbation", "size"])[list(QUANTILES)].to_dict("index")
    for perturbation, alike in members.groupby("perturbation", sort=False):
        sizes = list(alike.groupby("size"))
        groups.append(
            [
                Ensemble(position + i, ensemble, known[perturbation, size])
                for i, (size, ensemble) in enumerate(sizes)
            ]
        )
        position += len(sizes) + GAP
    return groups


def _draw_bands(axes: Axes, ensembles: Sequence[Ensemble], unperturbed: float) -> None:
    """5 to 95 % as a thin line, 25 to 75 % as a thick one, the median as a tick."""
    at = np.array([ensemble.position for ensemble in ensembles])
    q = np.array([[ensemble.mu_sapp[name] for name in QUANTILES] for ensemble in ensembles]).T
    median: dict[str, Any] = {"marker": "_", "markersize": 5, "markeredgewidth": 1.0, "color": style.BLACK}
    axes.plot(at, q[2], linestyle="none", label="median of the runs", **median)
    axes.vlines(at, q[1], q[3], color=style.SKY, linewidth=3.0, zorder=1.9, label="25 to 75 %")
    axes.vlines(at, q[0], q[4], color=style.BLUE, linewidth=0.8, label="5 to 95 %")
    axes.axhline(unperturbed, **UNCHANGED_LINE, label="unperturbed")


def _draw_counts(axes: Axes, ensembles: Sequence[Ensemble], unperturbed: int) -> None:
    """The share of each count in each ensemble as a shade."""
    for ensemble in ensembles:
        counts, frequency = np.unique(ensemble.members["events_kept"], return_counts=True)
        for count, share in zip(counts, frequency / len(ensemble.members), strict=True):
            cell = (ensemble.position - 0.5, count - 0.5)
            axes.add_patch(Rectangle(cell, 1, 1, facecolor=SHADES(share), linewidth=0))
    axes.axhline(unperturbed, **UNCHANGED_LINE)


def _label_sizes(axes: Axes, groups: Sequence[Sequence[Ensemble]]) -> None:
    """Sizes below the axis, or the parameters where there are several."""
    ends = [group[-1].position for group in groups]
    axes.set_xlim(-EDGE, ends[-1] + EDGE)
    if len(groups) > 1:
        middles = [(group[0].position + group[-1].position) / 2 for group in groups]
        names = [group[0].members["perturbation"].iloc[0] for group in groups]
        axes.set_xticks(middles, [SYMBOLS.get(name, name) for name in names])
        axes.tick_params(axis="x", length=0)
        return
    sizes = [ensemble.members["size"].iloc[0] for ensemble in groups[0]]
    shown = slice(len(sizes) % 2 == 0, None, 2)
    axes.set_xticks(range(len(sizes))[shown], [_power(size) for size in sizes[shown]])


def _draw_sweep(members: pd.DataFrame) -> Figure:
    """Every run of the sweep as a dot over theta, with the histogram of all beside it."""
    scenes = list(members.groupby("scene", sort=False))
    figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
    axes = figure.subplots(
        2,
        2 * len(scenes),
        sharey="row",
        squeeze=False,
        width_ratios=[4, 1] * len(scenes),
        height_ratios=[1.3, 1],
    )
    for i, (_, of_scene) in enumerate(scenes):
        alone = of_scene[of_scene["perturbation"] == UNPERTURBED].iloc[0]
        runs = of_scene[of_scene["perturbation"] != UNPERTURBED]
        change = (runs["theta"] - alone["theta"]) * 1e3
        for row, (quantity, width) in enumerate(BINS.items()):
            dots, bars = axes[row, 2 * i], axes[row, 2 * i + 1]
            values = runs[quantity].dropna()
            bins = np.arange(values.min() - width / 2, values.max() + width, width)
            dots.plot(change, runs[quantity], ".", markersize=1.5, color=style.BLUE)
            dots.plot(0.0, alone[quantity], "o", markersize=3.5, color=style.VERMILION)
            bars.hist(values, bins=bins, orientation="horizontal", color=style.SKY)
            bars.set_xticks([])
            bars.tick_params(axis="y", length=0)
            dots.set_xlim(change.min(), change.max())
            dots.tick_params(axis="x", labelbottom=row == 1)
        axes[0, 2 * i].set_title(f"around {style.theta_text(alone['theta'])}", fontsize=8)
        axes[1, 2 * i + 1].set_xlabel("runs", fontsize=7)
    _label_rows(axes)
    figure.supxlabel(r"Change of $\theta$ [$10^{-3}$]", fontsize=8)
    style.lay_out(figure)
    return figure


def _label_rows(axes: np.ndarray) -> None:
    axes[0, 0].set_ylabel(r"$\mu_\mathrm{sapp}$ [-]")
    axes[1, 0].set_ylabel("Events kept [-]")
    axes[1, 0].yaxis.set_major_locator(MaxNLocator(integer=True))


def _power(size: float) -> str:
    """Write a size as a power of ten, with its factor if it is no whole power."""
    exponent = math.floor(math.log10(size) + 1e-9)
    factor = size / 10**exponent
    return (rf"$10^{{{exponent}}}$") if abs(factor - 1) < 1e-6 else rf"${factor:.3g}\times10^{{{exponent}}}$"
