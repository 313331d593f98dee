"""Convergence with N: which numbers of the paper depend on how finely the slider is cut
into blocks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import mannwhitneyu

from precursors.analysis.horizon import horizon
from precursors.ensembles.noise import draws, noise_table, with_noise
from precursors.ensembles.study import Study, gather, stack
from precursors.model.chain import Chain, FloatArray
from precursors.solver.simulate import simulate

# All slip events up to the first global slip; those of Fig. 13, which are never shorter
# than one before; and those that are longer than all before.
COUNTS = ("events_to_global_slip", "events_counted", "records")
# Numbers that are extrapolated to infinite N as a + b/N.
EXTRAPOLATED = ("mu_sapp", "time_s", "front_speed_m_per_s")
QUANTITIES = (*COUNTS, *EXTRAPOLATED)
# Samples of a bootstrap, and the ends of its 95 % interval.
SAMPLES = 1000
ENDS = (0.025, 0.975)
POINT = ["scene", "theta", "n_blocks"]


def resolution_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Chains of more and more blocks with the loading of some scenes.

    Draw 0 of each chain has the normal loads of Eq. 7, the others have them with noise.
    Chains with as many blocks as the scene are those of `noise_study`.
    """
    blocks: list[dict[str, Any]] = []
    sizes = list(zip(settings["n_blocks"], settings["runs"], strict=True))
    for scene, slider in sliders.items():
        for n_blocks, runs in sizes:
            if n_blocks != slider["n_blocks"]:
                block = {**slider, "n_blocks": n_blocks, "duration": duration}
                block |= {"scene": scene, **draws(runs), "group": len(blocks)}
                blocks.append(block)
    return Study(stack(blocks), seed=settings["seed"])


def resolution_tables(
    chunks: Iterable[pd.DataFrame],
    noise: pd.DataFrame,
    slider: Mapping[str, Any],
    uniform: str,
    extrapolate_from: int,
) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name; `noise` has the members with the scenes'
    own N."""
    gathered = gather(chunks)
    runs = pd.concat([noise, gathered]).sort_values("n_blocks", kind="stable")
    members = with_front_speed(runs, slider["length"])
    given = {"mu_sapp": slider["mu_k"]}
    limits = extrapolation_table(members, extrapolate_from, given)
    return {
        "resolution_members": gathered,
        "resolution": noise_table(members, POINT, QUANTITIES),
        "counts_by_n": counts_table(members, uniform),
        "resolution_limits": limits.assign(wave_speed_m_per_s=wave_speed(slider)),
    }


def with_front_speed(members: pd.DataFrame, length: float) -> pd.DataFrame:
    """Add the mean speed of the front of the first global slip from block 1 to block N
    [m/s].

    It is NaN without such a front. `length` is that of the contact, L [m].
    """
    distance = length * (members["n_blocks"] - 1) / members["n_blocks"]
    speed = distance / members["crossing_time_s"].where(members["crossing_time_s"] > 0)
    return members.assign(front_speed_m_per_s=speed)


def wave_speed(slider: Mapping[str, float]) -> float:
    """Speed of long waves in a slider, sqrt(E S L/M) [m/s]."""
    stiffness = slider["youngs_modulus"] * slider["cross_section"]
    return math.sqrt(stiffness * slider["length"] / slider["slider_mass"])


def counts_table(members: pd.DataFrame, uniform: str) -> pd.DataFrame:
    """Counts of events against N, one row per n_blocks and scene.

    Each row has the median of each count, also over that of the scene `uniform`, with
    the probability by chance of such a difference from this scene (two-sided test of
    Mann and Whitney), and the median of the share of events that are counted.
    """
    runs = with_noise(members)
    rows = []
    for (n_blocks, scene, theta), own in runs.groupby(
        ["n_blocks", "scene", "theta"], sort=False
    ):
        even = runs[(runs["n_blocks"] == n_blocks) & (runs["scene"] == uniform)]
        row = {"n_blocks": n_blocks, "scene": scene, "theta": theta, "runs": len(own)}
        for count in COUNTS:
            row[count] = own[count].median()
            row[f"{count}_over_uniform"] = own[count].median() / even[count].median()
            row[f"{count}_p"] = mannwhitneyu(own[count], even[count]).pvalue
        rows.append(
            row
            | {
                "share_counted": (
                    own["events_counted"] / own["events_to_global_slip"]
                ).median()
            }
        )
    return pd.DataFrame(rows).sort_values(["n_blocks", "theta"], ignore_index=True)


def predictability_table(
    sliders: Mapping[str, Mapping[str, Any]],
    n_blocks: Iterable[int],
    duration: float,
    tolerance: float,
) -> pd.DataFrame:
    """Predictability time (horizon_s) and end of the first global slip, without noise:
    a row per scene and N.

    Where the horizon is not before the end, the run is `predictable`: its numbers do
    not depend on rounding.
    """
    rows = []
    for scene, slider in sliders.items():
        for n in n_blocks:
            run = simulate(
                Chain.from_slider(**{**slider, "n_blocks": n}),
                duration,
                until="global slip",
            )
            found = {
                "horizon_s": horizon(run, tolerance),
                "global_slip_s": run.duration,
            }
            predictable = found["horizon_s"] >= run.duration
            rows.append(
                {"scene": scene, "n_blocks": n, **found, "predictable": predictable}
            )
    return pd.DataFrame(rows)


def extrapolation_table(
    members: pd.DataFrame, from_n_blocks: int, given: Mapping[str, float]
) -> pd.DataFrame:
    """Extrapolate numbers to an infinite number of blocks as a + b/N, by least squares
    over the medians.

    Chains with fewer than `from_n_blocks` blocks are left out. The limit a is fitted,
    or `given` by the quantity. One row per scene and quantity has a, b, the ends of
    their bootstrap intervals, whether a is given, misfit, the largest distance of a
    median from the law, and how many N took part.
    """
    rows = []
    large = with_noise(members[members["n_blocks"] >= from_n_blocks])
    for scene, of_scene in large.groupby("scene", sort=False):
        for quantity in EXTRAPOLATED:
            numbers = of_scene.dropna(subset=quantity).groupby("n_blocks")[quantity]
            medians = numbers.median()
            random = np.random.default_rng(0)
            # Medians of as many resamplings, a row for each N.
            samples = [
                np.median(
                    random.choice(values.to_numpy(float), (SAMPLES, len(values))),
                    axis=1,
                )
                for _, values in numbers
            ]
            limit = given.get(quantity)
            inverse = 1.0 / medians.index.to_numpy(float)
            fit = _line(inverse, medians.to_numpy(), limit)
            fits = _line(inverse, np.array(samples), limit)
            row = {"scene": scene, "quantity": quantity}
            for name, value, drawn in zip("ab", fit, fits, strict=True):
                low, high = np.quantile(drawn, ENDS)
                row |= {name: value, f"{name}_low": low, f"{name}_high": high}
            row |= {"n_points": len(medians), "given": limit is not None}
            misfit = np.abs(medians - fit[0] - fit[1] * inverse).max()
            rows.append(row | {"misfit": misfit})
    return pd.DataFrame(rows)


def _line(x: FloatArray, y: FloatArray, given: float | None) -> tuple[Any, Any]:
    """Offset a and slope b of the line a + b x through y, shape (len(x), ...), with any
    offset or a `given` one."""
    if given is None:
        b, a = np.polyfit(x, y, 1)
        return a, b
    b = x @ (y - given) / (x @ x)
    return np.full_like(b, given), b
