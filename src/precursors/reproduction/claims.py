"""All claims of the paper that a run could contradict. Numbers are in the order of SCENES."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd
import scipy

from precursors.model import printed
from precursors.model.chain import FloatArray
from precursors.reproduction.claim import CHOSE, Claim, Finding, in_draws
from precursors.reproduction.inputs import LEADING, SCENES, TRAILING, UNIFORM
from precursors.reproduction.tables import Tables, before_global, one, rows, up_to_global

# A unit of the last digit of mu_sapp, which the paper says "appears to have" its value.
LAST_DIGIT = 0.01
# The smallest mu_s that is printed as 0.70.
MU_S = 0.695
# Times whose steps vary by less than this (standard deviation over mean) would be called periodic.
PERIODIC = 0.05
# Probability by chance below which a trend counts as one.
CHANCE = 0.05
# "Approximately" 200 N and 2 ms.
NEAR_LOAD, NEAR_TIME = 0.05, 0.25
# A length is a whole number of blocks: a straight line passes it by half a block at most.
HALF_A_BLOCK = 0.5
# L_p/L from which the length of the experiment's precursors grows faster (Sect. 6.1).
KINK = 0.7


def printed_count(scene: str, count: int, t: Tables) -> Finding:
    """Events of Fig. 13."""
    return in_draws(
        t,
        lambda runs: runs["events_counted"][[scene]],
        lambda counts: (counts == count).all(axis=1),
        count,
    )


def printed_friction(scene: str, t: Tables) -> Finding:
    """mu_sapp."""
    return in_draws(
        t,
        lambda runs: runs["mu_sapp"][[scene]],
        lambda friction: ((friction - printed.MU_SAPP).abs() <= LAST_DIGIT).all(axis=1),
        printed.MU_SAPP,
    )


def chaos(t: Tables) -> Finding:
    """Largest Lyapunov exponent, above its uncertainty."""
    exponent, uncertainty = (
        one(t["lyapunov"], column, scene=UNIFORM) for column in ("exponent_per_s", "uncertainty_per_s")
    )
    return Finding(exponent, exponent > uncertainty, uncertainty)


def line_of_lengths(slips: pd.DataFrame, along: str) -> FloatArray:
    """Slope and offset of the straight line through the lengths along a column; needed are two events."""
    slips.iloc[1]
    return np.polyfit(slips[along], slips["front"], 1)


def variation_of_steps(times: pd.Series) -> float:
    """Standard deviation of the steps between times over their mean: 0 for a period."""
    steps = np.diff(times)
    return float(np.std(steps) / np.mean(steps))


def aperiodic_global_slips(t: Tables) -> Finding:
    """Intervals between the global slips."""
    variation = variation_of_steps(rows(t[f"{UNIFORM}_slips"], is_global=True)["onset_s"])
    return Finding(variation, variation > PERIODIC)


def aperiodic_precursors(t: Tables) -> Finding:
    """Intervals between the precursors."""
    variation = variation_of_steps(before_global(t, UNIFORM)["onset_s"])
    return Finding(variation, variation > PERIODIC)


def drops(t: Tables) -> Finding:
    """Smallest drop of F_X in a slip event of each scene (the last event may be cut off)."""
    smallest = [(s["load_before_N"] - s["load_after_N"]).min() for s in (t[f"{x}_slips"] for x in SCENES)]
    return Finding(smallest, min(smallest) > 0)


def lengths_rise(t: Tables) -> Finding:
    """Probability that lengths in random order rise as much: one-sided test of Kendall's tau."""
    lengths = up_to_global(t, UNIFORM)["front"].to_numpy(float)
    by_chance = float(scipy.stats.kendalltau(range(len(lengths)), lengths, alternative="greater").pvalue)
    return Finding(by_chance, by_chance < CHANCE)


def linear_length(t: Tables) -> Finding:
    """Largest distance of the lengths before the global slip from a straight line in time [blocks]."""
    counted = rows(before_global(t, UNIFORM), counted=True)
    line = line_of_lengths(counted, "onset_s")
    distance = float(np.abs(counted["front"] - np.polyval(line, counted["onset_s"])).max())
    return Finding(distance, distance <= HALF_A_BLOCK)


def counts_grow(t: Tables) -> Finding:
    """Counts of Fig. 13 from theta to theta, in each draw and by the medians of the noise ensemble."""
    by_draw = in_draws(
        t,
        lambda runs: runs["events_counted"][list(SCENES)],
        lambda counts: (counts.diff(axis=1).iloc[:, 1:] > 0).all(axis=1),
    )
    pairs = [(UNIFORM, TRAILING), (LEADING, UNIFORM)]
    medians = [rows(t["noise_differences"], quantity="events_counted", scene=a, other=b) for a, b in pairs]
    low, high = (pd.concat(medians)[name] for name in ("low", "high"))
    if (low <= 0).any() and by_draw.holds:
        return replace(by_draw, holds=None if (high > 0).all() else False)
    return by_draw


def growth_falls(t: Tables) -> Finding:
    """Growth of the length in Fig. 13 with the load [blocks/N]."""
    counted = [rows(t[f"{scene}_slips"], counted=True) for scene in SCENES]
    growth = [line_of_lengths(slips, "load_before_N")[0] for slips in counted]
    return Finding(growth, bool((np.diff(growth) < 0).all()))


def friction_constant(t: Tables) -> Finding:
    """Differences of the medians of mu_sapp in the noise ensemble; each with a verdict of its interval."""
    pairs = rows(t["noise_differences"], quantity="mu_sapp")
    verdicts = set(pairs["verdict"])
    holds = False if "different" in verdicts else None if "undecided" in verdicts else len(pairs) > 0
    return Finding(pairs["difference"], holds, LAST_DIGIT)


def friction_underestimated(t: Tables) -> Finding:
    """mu_sapp against the smallest mu_s that is printed alike."""
    return in_draws(
        t,
        lambda runs: runs["mu_sapp"][list(SCENES)],
        lambda friction: (friction < MU_S).all(axis=1),
        MU_S,
    )


def waves_needed(t: Tables) -> Finding:
    """mu_sapp of a chain without inertia, which has no waves."""
    overdamped = rows(t["model_comparison"], model="overdamped", question="mu_sapp")
    without = np.array([one(overdamped, "value", scene=scene) for scene in SCENES])
    return Finding(without, bool((without >= MU_S).all()), MU_S)


def largest_loads(t: Tables) -> list[float]:
    """Largest F_X of each scene in all the time simulated [N]."""
    return [t[f"{scene}_trace"]["tangential_load_N"].max() for scene in SCENES]


def bounded_in_motion(t: Tables) -> Finding:
    """Largest F_X over F_Z, sliding included."""
    normal_loads = [t[f"{scene}_slips"]["normal_load_N"].iloc[0] for scene in SCENES]
    ratio = np.divide(largest_loads(t), normal_loads)
    return Finding(ratio, bool((ratio <= MU_S).all()), MU_S)


def first_is_largest(t: Tables) -> Finding:
    """Largest F_X of all, against that at the first global slip."""
    first = [up_to_global(t, scene)["load_before_N"].iloc[-1] for scene in SCENES]
    largest = largest_loads(t)
    return Finding(largest, bool(np.less_equal(largest, first).all()), first)


def short_events(t: Tables) -> Finding:
    """Events before the first global slip that Fig. 13 leaves out."""
    return in_draws(
        t,
        lambda runs: (runs["events_to_global_slip"] - runs["events_counted"])[list(SCENES)],
        lambda short: (short > 0).all(axis=1),
    )


def caused_by_friction_drop(t: Tables) -> Finding:
    """Median of the events counted over theta, where mu_k/mu_s is largest and smallest."""
    counts = t["map_theta_friction_ratio"].dropna(subset=["events_counted"])
    medians = counts.groupby("friction_ratio")["events_counted"].median().sort_index(ascending=False)
    return Finding(medians.iloc[[0, -1]], bool(medians.iloc[0] > medians.iloc[-1]))


def later_precursors(t: Tables) -> Finding:
    """Share of the stick phases between global slips that have a partial slip."""
    share = float(np.mean(np.diff(np.flatnonzero(t[f"{UNIFORM}_slips"]["is_global"])) > 1))
    return Finding(share, share > 0.5)


def growth(slips: pd.DataFrame) -> tuple[float, float]:
    """Growth of L_p/L with the load [1/N] before and after the last event of Fig. 13 with L_p/L <= KINK.

    It ends with the first event of the whole length: from there on the length cannot grow.
    """
    counted = rows(slips, counted=True)
    length, load = (counted["front"] / counted["n_blocks"]).to_numpy(), counted["load_before_N"].to_numpy()
    until = int(np.argmax(length == length.max())) + 1
    length, load = length[:until], load[:until]
    kink = np.flatnonzero(length <= KINK)[-1]
    rise, span = np.diff(length[[0, kink, -1]]), np.diff(load[[0, kink, -1]])
    return rise[0] / span[0], rise[1] / span[1]


def no_rapid_growth(t: Tables) -> Finding:
    """Growth beyond KINK against that before."""
    before, beyond = zip(*(growth(t[f"{scene}_slips"]) for scene in SCENES), strict=True)
    return Finding(beyond, bool(np.less_equal(beyond, before).all()), before)


def load_of_the_experiment(t: Tables) -> Finding:
    """F_X at the first global slip."""
    return in_draws(
        t,
        lambda runs: runs["load_N"][[UNIFORM]],
        lambda load: ((load / printed.FIRST_GLOBAL_SLIP_N - 1).abs() <= NEAR_LOAD).all(axis=1),
        printed.FIRST_GLOBAL_SLIP_N,
    )


def duration_of_the_experiment(t: Tables) -> Finding:
    """Duration of the first global slip."""
    return in_draws(
        t,
        lambda runs: (runs["end_s"] - runs["time_s"])[[UNIFORM]],
        lambda time: ((time / printed.SLIP_DURATION_S - 1).abs() <= NEAR_TIME).all(axis=1),
        printed.SLIP_DURATION_S,
    )


NAMES = {TRAILING: ("trailing", -1), UNIFORM: ("uniform", 0), LEADING: ("leading", 1)}
CLAIMS = (
    *(
        Claim(
            f"count-{name}",
            "Sect. 5.2, Fig. 13",
            f"theta = {sign * printed.THETA:g}: Fig. 13 has {printed.EVENTS_COUNTED[sign]} events.",
            "equal, the first global slip included",
            partial(printed_count, scene, printed.EVENTS_COUNTED[sign]),
            kind=CHOSE,
        )
        for scene, (name, sign) in NAMES.items()
    ),
    *(
        Claim(
            f"friction-{name}",
            "Sects. 5.2 and 6.2, Fig. 13",
            f"theta = {sign * printed.THETA:g}: mu_sapp appears to be {printed.MU_SAPP:g}.",
            f"within {LAST_DIGIT:g}",
            partial(printed_friction, scene),
            kind=CHOSE,
        )
        for scene, (name, sign) in NAMES.items()
    ),
    Claim(
        "chaos",
        "Sect. 5.1",
        "The stick-slip under uniform loading appears to be chaotic.",
        "its largest Lyapunov exponent exceeds its uncertainty",
        chaos,
        "1/s",
    ),
    Claim(
        "stick-slip-is-not-periodic",
        "Sect. 5.1",
        "The stick-slip under uniform loading is not periodic.",
        "intervals between global slips: standard deviation over mean above 0.05",
        aperiodic_global_slips,
    ),
    Claim(
        "precursors-are-not-periodic",
        "Sect. 5.1",
        "The precursors under uniform loading are not periodic.",
        "intervals between precursors: standard deviation over mean above 0.05",
        aperiodic_precursors,
    ),
    Claim(
        "every-slip-drops-the-load",
        "Sect. 5.1, Figs. 10-12",
        "Partial slips and drops of F_X come at the same times.",
        "smallest drop of F_X in a slip event above 0",
        drops,
        "N",
    ),
    Claim(
        "lengths-tend-to-increase",
        "Sect. 5.1, Fig. 10",
        "Under uniform loading the length tends to increase after every partial slip.",
        "Kendall's test: probability by chance below 0.05",
        lengths_rise,
    ),
    Claim(
        "length-is-linear-in-time",
        "Sects. 3.2.1 and 5.1, Figs. 4 and 10",
        "As in the experiment, the length under uniform loading grows linearly until the global slip.",
        "distance from a straight line at most half a block",
        linear_length,
        "blocks",
    ),
    Claim(
        "count-grows-with-theta",
        "Sects. 5.2 and 7 (2), Fig. 13",
        "The smaller theta, the fewer precursors come in the first stick phase.",
        "counts increase from theta to theta; with noise, so do their medians, by more than their interval",
        counts_grow,
    ),
    Claim(
        "growth-falls-with-theta",
        "Sects. 5.2 and 7 (2), Fig. 13",
        "The smaller theta, the faster the length of the precursors grows.",
        "slope of the straight line through Fig. 13 decreases from theta to theta",
        growth_falls,
        "blocks/N",
    ),
    Claim(
        "friction-independent-of-loading",
        "Sects. 5.2, 6.2 and 7 (4)",
        "mu_sapp does not depend on the normal loading, as far as the simulation supports it.",
        "with noise, medians of any two loadings differ by at most 0.01, interval included",
        friction_constant,
    ),
    Claim(
        "friction-underestimated",
        "Sects. 6.2 and 7 (4)",
        "mu_sapp is smaller than mu_s for the three normal loadings.",
        "below the smallest mu_s that is printed as 0.70",
        friction_underestimated,
    ),
    Claim(
        "waves",
        "Sect. 6.2",
        "Waves bring about the global slip before the strain is maximal, and so make mu_sapp less than mu_s.",
        "a chain without inertia, hence without waves, has mu_sapp = mu_s",
        waves_needed,
    ),
    Claim(
        "eq15-in-motion",
        "Sect. 6.2, Eq. 15",
        "F_X never exceeds mu_s F_Z, although blocks slide and Eq. 15 is derived for rest.",
        "largest F_X/F_Z in the 10 s simulated at most the smallest mu_s that is printed as 0.70",
        bounded_in_motion,
    ),
    Claim(
        "first-global-slip-is-at-the-largest-load",
        "Sects. 3.2.2 and 5.2, Eq. 1",
        "The largest F_X, which gives mu_sapp, is that at the first global slip.",
        "no larger F_X in the 10 s simulated",
        first_is_largest,
        "N",
    ),
    Claim(
        "short-events",
        "Sects. 5.2 and 6.1",
        "The simulation has short events, which Fig. 13 leaves out.",
        "more than 0 before the first global slip for the three normal loadings",
        short_events,
    ),
    Claim(
        "static-and-kinetic-friction",
        "Sect. 6.1",
        "The difference between static and kinetic friction causes the precursors.",
        "more events in Fig. 13 at the largest mu_k/mu_s than at the smallest (median over theta)",
        caused_by_friction_drop,
    ),
    Claim(
        "precursors-in-later-periods",
        "Sects. 3.2.1 and 5.1",
        "As in the experiment under uniform loading, precursors come in later stick phases, too.",
        "in more than half of the stick phases between global slips",
        later_precursors,
    ),
    Claim(
        "no-rapid-growth",
        "Sect. 6.1, Figs. 8 and 13",
        "The fast growth of the experiment beyond L_p/L = 0.7 is missing from the simulation.",
        "growth of L_p/L beyond 0.7 at most that before",
        no_rapid_growth,
        "1/N",
    ),
    Claim(
        "load-of-the-experiment",
        "Sects. 3.2.1 and 5.1, Fig. 4",
        "As in the experiment under uniform loading, the first global slip comes at about 200 N.",
        "within 5 %",
        load_of_the_experiment,
        "N",
    ),
    Claim(
        "slip-duration-of-the-experiment",
        "Sects. 3.2.1 and 5.1",
        "As in the experiment, a global slip lasts about 2 ms.",
        "within 25 %",
        duration_of_the_experiment,
        "s",
    ),
)


def evaluate(tables: Tables) -> pd.DataFrame:
    """Compare every claim with the tables: one row per claim, see `Claim.row`."""
    return pd.DataFrame([claim.row(tables) for claim in CLAIMS])


def differences(found: pd.DataFrame, expected: pd.DataFrame) -> list[str]:
    """Say in a line each which claims are new, missing, or of another verdict than expected."""
    new, old = (table.set_index("claim")["verdict"] for table in (found, expected))
    both = [name for name in new.index if name in old.index]
    return [
        *(f"{name}: is not among the expected claims" for name in new.index.difference(old.index)),
        *(f"{name}: is missing" for name in old.index.difference(new.index)),
        *(f"{name}: is {new[name]!r}, expected {old[name]!r}" for name in both if new[name] != old[name]),
    ]
