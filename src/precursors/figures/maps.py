"""Maps of events kept, mu_sapp and the share of global slips over theta and one parameter more."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.model.chain import FloatArray

HEIGHT_MM = 62.0


@dataclass(frozen=True)
class Axis:
    """The second axis of a map: its column, what the figure calls it, a slider's value, and its scale."""

    column: str
    label: str
    value: Callable[[Mapping[str, float]], float]
    logarithmic: bool = False


def _stiffness_ratio(slider: Mapping[str, float]) -> float:
    """K/k with k = N E S/L (Eq. 10)."""
    spring = slider["n_blocks"] * slider["youngs_modulus"] * slider["cross_section"] / slider["length"]
    return slider["drive_stiffness"] / spring


AXES = {
    "map_theta_n_blocks": Axis("n_blocks", "Number of blocks $N$ [-]", lambda slider: slider["n_blocks"]),
    "map_theta_friction_ratio": Axis(
        "friction_ratio", r"$\mu_k/\mu_s$ [-]", lambda slider: slider["mu_k"] / slider["mu_s"]
    ),
    "map_theta_stiffness_ratio": Axis("stiffness_ratio", "$K/k$ [-]", _stiffness_ratio, logarithmic=True),
    "map_theta_drive_velocity": Axis(
        "drive_velocity", "$V$ [m/s]", lambda slider: slider["drive_velocity"], logarithmic=True
    ),
}
PANELS = {
    "events_kept": "Events kept [-]",
    "mu_sapp": r"$\mu_\mathrm{sapp}$ [-]",
    "share_global": "Share of global slips [%]",
}


def read_map(path: str | Path, name: str) -> pd.DataFrame:
    """Read the table of a map.

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    numbers = ["theta", AXES[name].column, "mu_sapp", "events_kept", "n_global", "n_all_events"]
    return style.read_columns(path, {**dict.fromkeys(numbers, float), "reached": bool})


def draw_map(table: pd.DataFrame, name: str, sliders: Sequence[Mapping[str, float]] = ()) -> Figure:
    """Draw the three panels of a map, white where a run met no global slip; crosses are scenes.

    Parameters
    ----------
    table : DataFrame
        One row per run, see `read_map`.
    name : str
        A key of `AXES`.
    sliders : sequence of mapping
        Arguments of `Chain.from_slider` of the scenes to mark.
    """
    axis = AXES[name]
    scenes = [slider["theta"] for slider in sliders], [axis.value(slider) for slider in sliders]
    share = 100.0 * table["n_global"] / table["n_all_events"].where(table["n_all_events"] > 0)
    kept = table["events_kept"].where(table["reached"])
    table = table.assign(share_global=share, events_kept=kept)
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
        panels = figure.subplots(1, len(PANELS), sharey=True)
        for panel, (quantity, label) in zip(panels, PANELS.items(), strict=True):
            _draw_panel(panel, table, axis, quantity, label)
            panel.plot(*scenes, "+", color="white", markersize=7, markeredgewidth=2.2)
            panel.plot(*scenes, "+", color=style.BLACK, markersize=6)
        panels[0].set_ylabel(axis.label)
        style.lay_out(figure)
    return figure


def _draw_panel(axes: Axes, table: pd.DataFrame, axis: Axis, quantity: str, label: str) -> None:
    thetas, seconds = np.unique(table["theta"]), np.unique(table[axis.column])
    ordered = table.sort_values([axis.column, "theta"])[quantity].to_numpy(float)
    values = ordered.reshape(len(seconds), len(thetas))
    known = values[np.isfinite(values)]
    norm: Normalize
    if quantity == "events_kept":
        norm = LogNorm(max(1.0, known.min()), known.max())
    else:
        norm = Normalize(*np.quantile(known, [0.01, 0.99]))
    theta, second = _edges(thetas), _edges(seconds, axis.logarithmic)
    image = axes.pcolormesh(theta, second, values, norm=norm, cmap="viridis", rasterized=True)
    if axis.logarithmic:
        axes.set_yscale("log")
    axes.set_xlim(theta[0], theta[-1])
    axes.set_ylim(second[0], second[-1])
    axes.set_xlabel(r"$\theta$ [-]")
    bar = axes.figure.colorbar(image, ax=axes, location="top", aspect=25, use_gridspec=False)
    bar.set_label(label, fontsize=8)
    bar.ax.tick_params(labelsize=7)
    if quantity == "events_kept":
        ticks = [t for t in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if known.min() <= t <= known.max()]
        bar.set_ticks(ticks, labels=[str(t) for t in ticks])
        bar.minorticks_off()


def _edges(centres: FloatArray, logarithmic: bool = False) -> FloatArray:
    """Borders of the cells around evenly spaced values, or values evenly spaced in their logarithms."""
    places = np.log(centres) if logarithmic else centres
    half = np.diff(places) / 2
    borders = np.concatenate([[places[0] - half[0]], places[:-1] + half, [places[-1] + half[-1]]])
    return np.exp(borders) if logarithmic else borders
