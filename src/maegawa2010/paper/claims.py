"""All claims of the paper that a run could contradict. Numbers are in the order of
SCENES.

`claims.csv` has each statement in our words, and the rule by which it holds. This module
has a function of the same name, which evaluates the claim from the tables.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import scipy

from maegawa2010 import printed
from maegawa2010.paper.claim import Find, Finding, in_ensembles, judged, shown
from maegawa2010.paper.committed import agreement
from maegawa2010.paper.inputs import LEADING, SCENES, TRAILING, UNIFORM
from maegawa2010.paper.tables import Tables, before_global, cell, rows
from precursors.analysis.slips import until_global
from precursors.model.chain import FloatArray
from precursors.support.files import read_table

# The smallest mu_s that is printed as 0.70.
MU_S = 0.695
# Times count as periodic if the standard deviation of their intervals, over the mean, is
# below this.
PERIODIC = 0.05
# A trend is significant below this probability by chance.
CHANCE = 0.05
# Relative tolerances of the paper's "approximately" 200 N and 2 ms.
NEAR_LOAD = 0.05
NEAR_TIME = 0.25
# A row of at least this many blocks stands for a slider: its mu_sapp is near mu_k.
CUT_FINELY = 160
# Lengths are whole numbers of blocks, so rounding alone takes them up to half a block
# away from a straight line.
HALF_A_BLOCK = 0.5

FINDINGS: dict[str, Find] = {}


def of_claim(find: Find) -> Find:
    """Register a function under the name of its claim."""
    return FINDINGS.setdefault(find.__name__.replace("_", "-"), find)


def quantity(name: str, *scenes: str) -> Callable[[Any], Any]:
    """Function that takes a quantity from a table of runs: one row for each member of an
    ensemble, one column for each scene given, or for all three."""
    return lambda runs: runs[name][list(scenes or SCENES)]


def printed_count(scene: str, t: Tables) -> Finding:
    """Events of Fig. 13."""
    count = printed.SCENES[scene]["events_counted"]
    return in_ensembles(
        t,
        quantity("events_counted", scene),
        lambda counts: counts == count,
    )


def printed_friction(scene: str, t: Tables) -> Finding:
    """mu_sapp."""
    return in_ensembles(
        t,
        quantity("mu_sapp", scene),
        lambda friction: (friction - printed.MU_SAPP).abs() <= printed.LAST_DIGIT,
    )


for scene, side in {
    TRAILING: "trailing",
    UNIFORM: "uniform",
    LEADING: "leading",
}.items():
    FINDINGS[f"count-{side}"] = partial(printed_count, scene)
    FINDINGS[f"friction-{side}"] = partial(printed_friction, scene)


@of_claim
def chaos(t: Tables) -> Finding:
    """Largest Lyapunov exponent, above its uncertainty."""
    exponent, uncertainty = (
        cell(t["lyapunov"], column, scene=UNIFORM)
        for column in ("exponent_per_s", "uncertainty_per_s")
    )
    return Finding([exponent, uncertainty], exponent > uncertainty)


def line_of_lengths(slips: pd.DataFrame, along: str) -> FloatArray:
    """Slope and offset of the straight line through the lengths against a column.

    Raises
    ------
    IndexError
        If there are fewer than two events.
    """
    slips.iloc[1]
    return np.polyfit(slips[along], slips["front"], 1)


def not_periodic(times: pd.Series) -> Finding:
    """Standard deviation of the intervals between times, over their mean."""
    steps = np.diff(times)
    variation = float(np.std(steps) / np.mean(steps))
    return Finding(variation, variation > PERIODIC)


@of_claim
def stick_slip_is_not_periodic(t: Tables) -> Finding:
    """Intervals between the global slips."""
    return not_periodic(rows(t[f"{UNIFORM}_slips"], is_global=True)["onset_s"])


@of_claim
def precursors_are_not_periodic(t: Tables) -> Finding:
    """Intervals between the precursors."""
    return not_periodic(before_global(t, UNIFORM)["onset_s"])


@of_claim
def lengths_tend_to_increase(t: Tables) -> Finding:
    """Probability that lengths in random order rise as much, with the global slip and
    without it."""
    partial = before_global(t, UNIFORM)["front"]
    slips = t[f"{UNIFORM}_slips"]
    lengths = slips["front"][until_global(slips["is_global"])]
    by_chance = [chance_of_rise(lengths), chance_of_rise(partial)]
    below = [chance < CHANCE for chance in by_chance]
    return Finding(by_chance, all(below) if len(set(below)) == 1 else None)


def chance_of_rise(values: pd.Series) -> float:
    """Probability that values in random order rise as much: one-sided test of Kendall's
    tau."""
    order = range(len(values))
    return float(scipy.stats.kendalltau(order, values, alternative="greater").pvalue)


@of_claim
def length_is_linear_in_time(t: Tables) -> Finding:
    """Largest distance of the lengths before the global slip from a straight line in
    time [blocks]."""
    counted = rows(before_global(t, UNIFORM), counted=True)
    line = line_of_lengths(counted, "onset_s")
    distance = float(
        np.abs(counted["front"] - np.polyval(line, counted["onset_s"])).max()
    )
    return Finding(distance, distance <= HALF_A_BLOCK)


@of_claim
def count_grows_with_theta(t: Tables) -> Finding:
    """Increase with theta of the counts of Fig. 13, in each member and in the medians of
    the noise ensemble."""
    by_member = in_ensembles(
        t,
        quantity("events_counted"),
        lambda counts: counts.diff(axis=1).iloc[:, 1:] > 0,
    )
    medians = [
        rows(t["noise_differences"], quantity="events_counted", scene=a, other=b)
        for b, a in pairwise(SCENES)
    ]
    low, high = (pd.concat(medians)[name] for name in ("low", "high"))
    if (low <= 0).any() and by_member.holds:
        return replace(by_member, holds=None if (high > 0).all() else False)
    return by_member


@of_claim
def growth_falls_with_theta(t: Tables) -> Finding:
    """Growth of the length in Fig. 13 with the load [blocks/N]."""
    counted = [rows(t[f"{scene}_slips"], counted=True) for scene in SCENES]
    growth = [line_of_lengths(slips, "load_before_N")[0] for slips in counted]
    return Finding(growth, all(before > after for before, after in pairwise(growth)))


@of_claim
def friction_independent_with_ten_blocks(t: Tables) -> Finding:
    """Differences of the medians of mu_sapp in the noise ensemble.

    Their intervals decide. The note and the shares compare the three mu_sapp of each
    member.
    """
    by_member = in_ensembles(
        t,
        spread_of_friction,
        lambda span: span <= printed.LAST_DIGIT,
    )
    pairs = rows(t["noise_differences"], quantity="mu_sapp")
    agree = "agree" if by_member.holds else "do not agree"
    return replace(
        by_member,
        ours=pairs["difference"],
        holds=all_same(pairs),
        note=f"The values of the three runs {agree}: they differ by"
        f" {shown(by_member.ours)}.",
    )


@of_claim
def friction_independent_of_loading(t: Tables) -> Finding:
    """Largest difference of the medians of mu_sapp with many blocks."""
    pairs = t["resolution_differences"]
    fine = pairs[pairs["n_blocks"] >= CUT_FINELY]
    largest = fine["difference"].abs().groupby(fine["n_blocks"]).max()
    note = f"Largest difference with {', '.join(map(str, largest.index))} blocks."
    if "committed_resolution" in t:
        note += f" The study is committed: {agreement(t['committed_resolution'])}."
    return Finding(largest, all_same(fine), note=note)


def all_same(pairs: pd.DataFrame) -> bool | None:
    """Whether the interval of every difference is within the tolerance; None if none is
    outside but one crosses the limit."""
    verdicts = set(pairs["verdict"])
    holds = not pairs.empty and "different" not in verdicts
    return None if holds and "undecided" in verdicts else holds


def spread_of_friction(runs: pd.DataFrame) -> pd.DataFrame:
    """Largest less smallest mu_sapp of each member; NaN where one is missing."""
    friction = quantity("mu_sapp")(runs)
    return pd.DataFrame(np.ptp(friction.to_numpy(), axis=1), friction.index)


@of_claim
def friction_underestimated(t: Tables) -> Finding:
    """mu_sapp against the smallest mu_s that is printed as 0.70."""
    return in_ensembles(t, quantity("mu_sapp"), lambda friction: friction < MU_S)


@of_claim
def waves(t: Tables) -> Finding:
    """mu_sapp of a chain without inertia, which has no waves.

    If this mu_sapp is below mu_s, too, waves may or may not be the cause.
    """
    overdamped = rows(t["model_comparison"], model="overdamped", question="mu_sapp")
    without = np.array([cell(overdamped, "value", scene=scene) for scene in SCENES])
    return Finding(without, True if (without >= MU_S).all() else None)


@of_claim
def first_global_slip_is_at_the_largest_load(t: Tables) -> Finding:
    """Largest F_X [N] of the whole run, against F_X at the first global slip."""
    first = [
        rows(t[f"{scene}_slips"], is_global=True)["load_before_N"].iloc[0]
        for scene in SCENES
    ]
    largest = [t[f"{scene}_trace"]["tangential_load_N"].max() for scene in SCENES]
    return Finding(largest, bool(np.less_equal(largest, first).all()))


@of_claim
def short_events(t: Tables) -> Finding:
    """Events before the first global slip that Fig. 13 leaves out."""

    def short(runs: pd.DataFrame) -> pd.DataFrame:
        every = quantity("events_to_global_slip")(runs)
        return every - quantity("events_counted")(runs)

    for_all = in_ensembles(t, short, lambda n: n > 0)
    for_one = in_ensembles(t, short, lambda n: (n > 0).any(axis=1).to_frame())
    shares = [f"{100 * s.k / s.n:.0f} %" for s in for_one.shares.values()]
    note = f"For at least one theta: {', '.join(shares)}."
    return replace(for_all, note=note)


@of_claim
def precursors_in_later_periods(t: Tables) -> Finding:
    """Share of the stick phases between global slips that have a partial slip."""
    is_global = t[f"{UNIFORM}_slips"]["is_global"]
    share = float(np.mean(np.diff(np.flatnonzero(is_global)) > 1))
    return Finding(share, share > 0.5)


@of_claim
def no_rapid_growth(t: Tables) -> Finding:
    """Growth of L_p with F_X beyond 0.7 L, over the growth before.

    In the experiment this ratio is large for all three loadings.
    """
    by_member = in_ensembles(
        t,
        quantity("speedup"),
        lambda speedup: (speedup <= 1.0).any(axis=1).to_frame(),
    )
    others = t["digits_members"].query("draw > 0").groupby("scene")["speedup"]
    medians = shown(others.median()[list(SCENES)])
    note = f"Medians of the sliders with the same printed inputs: {medians}."
    return replace(by_member, note=note)


@of_claim
def load_of_the_experiment(t: Tables) -> Finding:
    """F_X at the first global slip."""
    return in_ensembles(
        t,
        quantity("global_slip_load_N", UNIFORM),
        lambda load: (load / printed.FIRST_GLOBAL_SLIP_N - 1).abs() <= NEAR_LOAD,
    )


@of_claim
def slip_duration_of_the_experiment(t: Tables) -> Finding:
    """Duration of the first global slip."""
    return in_ensembles(
        t,
        lambda runs: (runs["global_slip_end_s"] - runs["global_slip_s"])[[UNIFORM]],
        lambda time: (time / printed.SLIP_DURATION_S - 1).abs() <= NEAR_TIME,
    )


def evaluate(tables: Tables) -> pd.DataFrame:
    """Compare every claim of claims.csv with the tables: one row per claim, see
    `judged`.

    Raises
    ------
    ValueError
        In one line: a claim has no function, or the tables lack its numbers.
    """
    stated = read_table(Path(__file__).with_name("claims.csv"), dtype=str).fillna("")
    if missing := set(stated["claim"]) - set(FINDINGS):
        raise ValueError(f"claim {min(missing)} has no function in claims.py")
    return pd.DataFrame(
        judged(claim, FINDINGS[claim["claim"]], tables)
        for claim in stated.to_dict("records")
    )


def differences(claims: pd.DataFrame, expected: pd.DataFrame) -> list[str]:
    """Write a line for each claim whose verdict is missing or not the expected one."""
    new, old = (
        dict(zip(table["claim"], table["verdict"], strict=True))
        for table in (claims, expected)
    )
    return [
        f"{name}: is {new.get(name, 'missing')}, expected {old.get(name, 'none')}"
        for name in {**new, **old}
        if new.get(name) != old.get(name)
    ]
