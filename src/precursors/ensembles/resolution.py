"""Resolution: which numbers of the paper depend on how finely the slider is cut into blocks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from precursors.analysis.horizon import horizon
from precursors.analysis.run_statistics import share_interval, statistics
from precursors.ensembles.study import Study, stack
from precursors.model.chain import Chain, FloatArray
from precursors.solver.simulate import simulate

QUANTITIES = ("events_counted", "mu_sapp", "time_s", "front_speed_m_per_s")
# Numbers that are carried on to infinite N as a + b/N.
CARRIED_ON = ("mu_sapp", "time_s", "front_speed_m_per_s")
# Numbers whose growth with N is told octave by octave.
COUNTS = ("events_counted", "n_events")
# Samples of a bootstrap, and the ends of its 95 % interval.
SAMPLES, ENDS = 1000, (0.025, 0.975)
# Largest N for which the predictability time is part of every run of the workflow: its work grows as N^2.
PREDICTED_UP_TO = 30


def resolution_study(
    sliders: Mapping[str, Mapping[str, Any]], duration: float, settings: Mapping[str, Any]
) -> Study:
    """Chains of more and more blocks with the loading of some scenes.

    The first member of each chain has the normal loads of Eq. 7, the others have them with noise.

    Parameters
    ----------
    sliders : mapping
        Scene to arguments of `Chain.from_slider`.
    duration : float
        Time limit of a run [s].
    settings : mapping
        Section `resolution` of the configuration.
    """
    blocks: list[dict[str, Any]] = []
    for scene, slider in sliders.items():
        for n_blocks, n_runs in zip(settings["n_blocks"], settings["runs"], strict=True):
            draw = np.arange(n_runs)
            noise = np.where(draw == 0, 0.0, settings["noise"])
            block = {**slider, "n_blocks": n_blocks, "duration": duration, "scene": scene}
            blocks.append(block | {"load_noise": noise, "draw": draw, "group": len(blocks)})
    return Study(stack(blocks), seed=settings["seed"])


def estimated_mu_sapp(n_blocks: ArrayLike, mu_s: float, mu_k: float) -> FloatArray:
    """Estimate mu_k + 2 (mu_s - mu_k) / N of the apparent static friction coefficient [1].

    The load is the kinetic friction of all blocks, and above it the drop of the load when one block slides.
    """
    return mu_k + 2.0 * (mu_s - mu_k) / np.asarray(n_blocks, float)


def front_speed(members: pd.DataFrame, length: float) -> pd.Series:
    """Mean speed of the front of the first global slip from block 1 to block N [m/s]; NaN without one.

    Parameters
    ----------
    members : DataFrame
        Columns n_blocks and crossing_time_s.
    length : float
        Length L of the contact [m].
    """
    distance = length * (members["n_blocks"] - 1) / members["n_blocks"]
    return distance / members["crossing_time_s"].where(members["crossing_time_s"] > 0)


def resolution_table(members: pd.DataFrame, length: float) -> pd.DataFrame:
    """Statistics of each number over the runs with the same scene and number of blocks.

    Parameters
    ----------
    members : DataFrame
        The gathered study.
    length : float
        Length L of the contact [m].

    Returns
    -------
    DataFrame
        One row per scene, theta, n_blocks and quantity: the value without noise; what `statistics` has of the
        runs with a global slip; how many runs there are, n_runs.
    """
    members = members.assign(front_speed_m_per_s=front_speed(members, length))
    rows = []
    for (scene, theta, n_blocks), runs in members.groupby(["scene", "theta", "n_blocks"], sort=False):
        for quantity in QUANTITIES:
            point = {"scene": scene, "theta": theta, "n_blocks": n_blocks, "quantity": quantity}
            without_noise = runs.loc[runs["load_noise"] == 0.0, quantity].item()
            reached = runs.loc[runs["reached"], quantity]
            rows.append(point | {"without_noise": without_noise, "n_runs": len(runs)} | statistics(reached))
    return pd.DataFrame(rows)


def readings_table(members: pd.DataFrame) -> pd.DataFrame:
    """The two readings of global slip: all blocks at the same instant, or each at some time.

    Returns
    -------
    DataFrame
        One row per scene, theta and n_blocks: runs; without_global_slip, how many never have all blocks slide
        at once; earlier, the share (with its interval) of runs in which every block slid in an event before
        all slid at once; medians of events and mu_sapp by each reading, and of pulse_share, the share of the
        blocks that slide at once in the first event in which every block slides.
    """
    rows = []
    for (scene, theta, n_blocks), runs in members.groupby(["scene", "theta", "n_blocks"], sort=False):
        each = runs["sliding_each"] > 0
        earlier = each & (runs["sliding_each"] < n_blocks)
        low, high = share_interval(int(earlier.sum()), len(runs))
        medians = {
            "events_at_once": runs.loc[runs["reached"], "n_events"].median(),
            "events_each": runs.loc[each, "n_events_each"].median(),
            "mu_sapp_at_once": runs["mu_sapp"].median(),
            "mu_sapp_each": runs["mu_sapp_each"].median(),
            "pulse_share": (runs["sliding_each"] / runs["n_blocks"])[each].median(),
        }
        counted = {"runs": len(runs), "without_global_slip": int((~runs["reached"]).sum())}
        shares = {"earlier": earlier.mean(), "earlier_low": low, "earlier_high": high}
        rows.append({"scene": scene, "theta": theta, "n_blocks": n_blocks} | counted | shares | medians)
    return pd.DataFrame(rows)


def predictability_table(
    sliders: Mapping[str, Mapping[str, Any]], n_blocks: Iterable[int], duration: float, tolerance: float
) -> pd.DataFrame:
    """Predictability time of the chain without noise, up to its first global slip, against N.

    Returns
    -------
    DataFrame
        One row per scene and N: horizon_s and global_slip_s [s], the end of the slip; predictable, whether
        the horizon is not before it, so that the numbers of this run do not depend on rounding.
    """
    rows = []
    for scene, slider in sliders.items():
        for n in n_blocks:
            run = simulate(Chain.from_slider(**{**slider, "n_blocks": n}), duration, until="global slip")
            found = {"horizon_s": horizon(run, tolerance), "global_slip_s": run.duration}
            predictable = found["horizon_s"] >= run.duration
            rows.append({"scene": scene, "n_blocks": n, **found, "predictable": predictable})
    return pd.DataFrame(rows)


def with_estimates(table: pd.DataFrame, slider: Mapping[str, Any]) -> pd.DataFrame:
    """A table of `resolution_table` with a column estimate: of mu_sapp, and of the front's speed [m/s].

    The front of a global slip is about as fast as long waves in the chain, sqrt(E S L/M); NaN for numbers
    that nothing is expected of.
    """
    friction = estimated_mu_sapp(table["n_blocks"], slider["mu_s"], slider["mu_k"])
    modulus, section = slider["youngs_modulus"], slider["cross_section"]
    wave_speed = np.sqrt(modulus * section * slider["length"] / slider["slider_mass"])
    is_friction, is_speed = (table["quantity"] == name for name in ("mu_sapp", "front_speed_m_per_s"))
    return table.assign(estimate=np.where(is_friction, friction, np.where(is_speed, wave_speed, np.nan)))


def extrapolation_table(members: pd.DataFrame, length: float, from_n_blocks: int) -> pd.DataFrame:
    """Carry numbers on to an infinite number of blocks as a + b/N, by least squares over the medians.

    Parameters
    ----------
    members : DataFrame
        The gathered study.
    length : float
        Length L of the contact [m].
    from_n_blocks : int
        Smallest number of blocks that takes part.

    Returns
    -------
    DataFrame
        One row per scene and quantity: a (the limit) and b, with the ends of their bootstrap intervals;
        n_points, how many N took part.
    """
    members = members.assign(front_speed_m_per_s=front_speed(members, length))
    members = members[(members["n_blocks"] >= from_n_blocks) & members["reached"]]
    rows = []
    for scene, of_scene in members.groupby("scene", sort=False):
        for quantity in CARRIED_ON:
            n_blocks, medians, samples = bootstrap_medians(of_scene, quantity)
            (b, a), (b_all, a_all) = (np.polyfit(1.0 / n_blocks, y, 1) for y in (medians, samples))
            (a_low, a_high), (b_low, b_high) = np.quantile(a_all, ENDS), np.quantile(b_all, ENDS)
            found = {"a": a, "a_low": a_low, "a_high": a_high, "b": b, "b_low": b_low, "b_high": b_high}
            rows.append({"scene": scene, "quantity": quantity, **found, "n_points": len(n_blocks)})
    return pd.DataFrame(rows)


def exponents_table(members: pd.DataFrame) -> pd.DataFrame:
    """Local exponents of the counts: log2 of the ratio of the medians at 2 N and at N.

    Returns
    -------
    DataFrame
        One row per scene, count and octave, from n_blocks to twice as many: exponent, with the ends of its
        bootstrap interval.
    """
    rows = []
    for scene, of_scene in members[members["reached"]].groupby("scene", sort=False):
        for quantity in COUNTS:
            n_blocks, medians, samples = bootstrap_medians(of_scene, quantity)
            for i, n in enumerate(n_blocks):
                for j in np.flatnonzero(n_blocks == 2 * n):
                    low, high = np.quantile(np.log2(samples[j] / samples[i]), ENDS)
                    exponent = np.log2(medians[j] / medians[i])
                    octave = {"scene": scene, "quantity": quantity, "n_blocks": int(n)}
                    rows.append(octave | {"exponent": exponent, "low": low, "high": high})
    return pd.DataFrame(rows)


def bootstrap_medians(members: pd.DataFrame, quantity: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Numbers of blocks, the median of each, and medians of `SAMPLES` resamplings, shape (len, SAMPLES)."""
    random = np.random.default_rng(0)
    groups = [(n, values.dropna().to_numpy(float)) for n, values in members.groupby("n_blocks")[quantity]]
    groups = [(n, values) for n, values in groups if len(values)]
    medians = [np.median(values) for _, values in groups]
    samples = [
        np.median(values[random.integers(len(values), size=(SAMPLES, len(values)))], axis=1)
        for _, values in groups
    ]
    return np.array([n for n, _ in groups], float), np.array(medians), np.array(samples)
