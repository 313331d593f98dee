"""What the larger chain answers: where creep runs away, what depends on N, on the loading and on the push."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import combinations, product
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import median_interval
from precursors.analysis.slip_rows import first_global, up_to_first_global
from precursors.analysis.slips import find_precursors, find_slips
from precursors.hierarchy.larger import LargerChain, critical_length, simulate_larger
from precursors.hierarchy.models import LIMIT, longest_run
from precursors.model.chain import Chain, parse_theta
from precursors.model.checks import Until
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

KINK = 0.7  # of L: beyond it the experiment's precursors grow faster
SAME = 0.01  # two coefficients that are closer are the same: a unit of the last digit that the paper prints
RESAMPLES = 2000
STEP = 0.25  # of `simulate_larger` where friction falls; medians do not need the default
LONGEST = 2.5  # longest run, in times in which the drive reaches mu_s F_Z
SLIP: Until = "global slip"
ADDED = ("weakening_velocity", "relaxation_time", "push_height")
POINT = ["study", *ADDED, "theta", "n_blocks", "critical_length"]


def nucleation_table(slider: Mapping[str, Any], study: Mapping[str, Any]) -> pd.DataFrame:
    """Length at which smooth growth ends, beside the theory: a row for each pair of v_c and t_v.

    Creep of length l behind the drive needs F_X = mu_s F_Z l/L. So the load at which the first event begins
    gives the length that crept until then. Columns: the pair, n_blocks, theory and measured (l_c / L [1]),
    and ratio, measured over theory.
    """
    rows = []
    for n, (weakening_velocity, relaxation_time) in product(study["n_blocks"], study["pairs"]):
        chain = Chain.from_slider(**{**slider, "theta": 0.0, "n_blocks": n})
        larger = LargerChain(chain, weakening_velocity, relaxation_time)
        theory = critical_length(larger) / chain.length
        run = simulate_larger(larger, 1.6 * theory * static_load_time(chain), step=STEP)
        measured = find_slips(run)["load_before"].iloc[0] / (chain.mu_s * chain.normal_load)
        row = {"weakening_velocity": weakening_velocity, "relaxation_time": relaxation_time}
        row |= {"n_blocks": chain.n_blocks, "theory": theory, "measured": measured}
        rows.append(row | {"ratio": measured / theory})
    return pd.DataFrame(rows)


def static_load_time(chain: Chain) -> float:
    """Time [s] in which the drive reaches mu_s F_Z against all springs in a row."""
    return longest_run(chain) / LIMIT


def points_of(study: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The points of a study: each pair of v_c and t_v with each push_height, n_blocks and theta."""
    heights, blocks, thetas = study.get("push_height", [0.0]), study["n_blocks"], study["theta"]
    names = ("weakening_velocity", "relaxation_time", "push_height", "n_blocks", "theta")
    every = product(study["pairs"], heights, blocks, thetas)
    return [dict(zip(names, (*pair, *others), strict=True)) for pair, *others in every]


def larger_tables(
    slider: Mapping[str, Any], settings: Mapping[str, Any], full: str
) -> dict[str, pd.DataFrame]:
    """Medians, differences of loadings, and where creep runs away: by file name, which ends in `full`."""
    studies = settings["studies"].items()
    runs = pd.concat([run_study(slider, name, study, settings) for name, study in studies])
    return {
        f"larger{full}": medians_table(runs),
        f"larger_differences{full}": differences_table(runs),
        f"larger_nucleation{full}": nucleation_table(slider, settings["nucleation"]),
    }


def run_study(
    slider: Mapping[str, Any], name: str, study: Mapping[str, Any], common: Mapping[str, Any]
) -> pd.DataFrame:
    """Run every point of a study with noise in the normal loads: a row for each point and draw.

    A point without any number of `LargerChain` is the exact chain. The noise depends on the number of blocks
    and on the draw only. A run without a global slip has NaN.

    Parameters
    ----------
    slider : mapping
        Arguments of `Chain.from_slider`.
    name : str
        Name of the study, in the first column.
    study : mapping
        pairs (of v_c [m/s] and t_v [s]), n_blocks, theta, push_height [m] (optional) and runs.
    common : mapping
        seed, noise (relative) and smallest_drops [N] of all studies.
    """
    rows = []
    for point in points_of(study):
        chain = Chain.from_slider(**{**slider, "theta": point["theta"], "n_blocks": point["n_blocks"]})
        random = np.random.default_rng([common["seed"], chain.n_blocks])
        noise = common["noise"] * random.uniform(-1.0, 1.0, (study["runs"], chain.n_blocks))
        additions = {key: point[key] for key in ADDED}
        theory = (
            critical_length(LargerChain(chain, **additions)) / chain.length
            if point["weakening_velocity"]
            else np.nan
        )
        for draw, change in enumerate(noise):
            noisy = replace(chain, weights=chain.weights * (1.0 + change))
            limit = LONGEST * static_load_time(chain)
            if any(additions.values()):
                step = STEP if point["weakening_velocity"] else None
                run = simulate_larger(LargerChain(noisy, **additions), limit, SLIP, step)
            else:
                run = simulate(noisy, limit, SLIP)
            row = {"study": name, **point, "theta": parse_theta(point["theta"]), "critical_length": theory}
            rows.append(row | {"draw": draw} | numbers(run, common["smallest_drops"]))
    return pd.DataFrame(rows)


def numbers(run: Run, smallest_drops: Iterable[float]) -> dict[str, float]:
    """What is kept of a run up to its first global slip.

    events_counted is that of Fig. 13, mu_sapp Eq. 1, and events_over_x the number of events in which F_X
    falls by x [N] or more. growth says how much faster L_p grows with F_X beyond `KINK` L than before.
    """
    slips = find_slips(run)
    if first_global(slips) is None:
        return {}
    slips = up_to_first_global(slips)
    drop, last = slips["load_before"] - slips["load_after"], slips.iloc[-1]
    passed = slips["load_before"].to_numpy()[(slips["front"] >= KINK * run.chain.n_blocks).argmax()]
    rest = last["load_before"] - passed
    return {
        "events_counted": len(find_precursors(slips)),
        **{f"events_over_{x:g}N": int((drop >= x).sum()) for x in smallest_drops},
        "mu_sapp": last["largest_load"] / run.chain.normal_load,
        "growth": (1.0 - KINK) / KINK * passed / rest if rest > 0.0 else np.nan,
    }


def medians_table(runs: pd.DataFrame) -> pd.DataFrame:
    """Medians over the runs of a point with their 95 % intervals (name_low, name_high): a row for each point.

    runs is the number of runs, no_slip that of runs without a global slip; critical_length is l_c/L by the
    theory, NaN for the exact chain.
    """
    rows = []
    for point, of_point in runs.groupby(POINT, sort=False, dropna=False):
        row = dict(zip(POINT, point, strict=True))
        row |= {"runs": len(of_point), "no_slip": int(of_point["mu_sapp"].isna().sum())}
        for name in runs.columns.drop([*POINT, "draw"]):
            values = of_point[name].dropna()
            low, high = median_interval(values)
            row |= {name: values.median(), f"{name}_low": low, f"{name}_high": high}
        rows.append(row)
    return pd.DataFrame(rows)


def differences_table(runs: pd.DataFrame) -> pd.DataFrame:
    """Whether mu_sapp is the same for two loadings: a row for each pair of theta.

    difference is that of the medians (theta_b less theta_a), low and high its 95 % interval (bootstrap).
    verdict is "same" if the interval lies within `SAME` of 0, "different" if it lies beyond on one side, and
    "undecided" otherwise.
    """
    random, rows = np.random.default_rng(0), []
    keys = [key for key in POINT if key != "theta"]
    for point, of_point in runs.dropna(subset="mu_sapp").groupby(keys, sort=False, dropna=False):
        samples = {
            float(x): of_point.loc[of_point["theta"] == x, "mu_sapp"] for x in of_point["theta"].unique()
        }
        for a, b in combinations(sorted(samples), 2):
            drawn = [
                np.median(random.choice(samples[x], (RESAMPLES, len(samples[x]))), axis=1) for x in (a, b)
            ]
            low, high = np.quantile(drawn[1] - drawn[0], [0.025, 0.975])
            within, beyond = max(-low, high) < SAME, max(low, -high) > SAME
            row = dict(zip(keys, point, strict=True)) | {"theta_a": a, "theta_b": b}
            row |= {"difference": np.median(samples[b]) - np.median(samples[a]), "low": low, "high": high}
            rows.append(row | {"verdict": "same" if within else "different" if beyond else "undecided"})
    return pd.DataFrame(rows)
