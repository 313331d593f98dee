"""What the larger chain answers: where creep runs away, what depends on N, on the
loading and on the push."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import combinations, product
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import (
    compared,
    median_difference,
    median_interval,
)
from precursors.analysis.slips import find_precursors, find_slips, mu_sapp
from precursors.hierarchy.larger import LargerChain, critical_length, simulate_larger
from precursors.hierarchy.models import longest_run
from precursors.model.chain import Chain, parse_theta
from precursors.solver.run import Record
from precursors.solver.simulate import simulate

# fall of F_X, over F_X, that ends smooth growth: creep that trembles lets it fall by
# less
SEEN = 0.002
KINK = 0.7  # of L: beyond it the experiment's precursors grow faster
# two coefficients that are closer are the same: a unit of the last digit that the paper
# prints
SAME = 0.01
# Steps of `simulate_larger` for v_c > 0 and v_c = 0: medians of noisy runs do not need
# the defaults.
STEP = 0.25
STEP_OF_COULOMB = 0.01
PAIR = ["weakening_velocity", "relaxation_time"]
POINT = ["study", *PAIR, "push_height", "theta", "n_blocks", "critical_length"]


def nucleation_table(
    slider: Mapping[str, Any], study: Mapping[str, Any]
) -> pd.DataFrame:
    """Length at which smooth growth ends, beside the theory: a row for each pair of v_c
    and t_v.

    Creep of length l behind the drive needs F_X = mu_s F_Z l/L. So the load at which
    the first event begins gives the length that crept until then, if events in which
    F_X falls by less than `SEEN` are left out. Columns: the pair, n_blocks, theory and
    measured (l_c / L [1]), and ratio, measured over theory.
    """
    rows = []
    for n, pair in product(study["n_blocks"], study["pairs"]):
        chain = Chain.from_slider(**{**slider, "theta": 0.0, "n_blocks": n})
        larger = LargerChain(chain, *pair)
        theory = critical_length(larger) / chain.length
        # The drive reaches mu_s F_Z in a tenth of the longest run.
        run = simulate_larger(larger, 0.16 * theory * longest_run(chain), step=STEP)
        slips = find_slips(run)
        first = (slips["load_after"] < (1.0 - SEEN) * slips["load_before"]).argmax()
        measured = slips["load_before"].iloc[first] / (chain.mu_s * chain.normal_load)
        rows.append((*pair, n, theory, measured, measured / theory))
    return pd.DataFrame(
        rows, columns=[*PAIR, "n_blocks", "theory", "measured", "ratio"]
    )


def larger_tables(
    slider: Mapping[str, Any], settings: Mapping[str, Any]
) -> dict[str, pd.DataFrame]:
    """Medians, differences of loadings, and where creep runs away, by file name."""
    studies = settings["studies"].items()
    runs = pd.concat(
        [run_study(slider, name, study, settings) for name, study in studies]
    )
    return {
        "larger": medians_table(runs),
        "larger_differences": differences_table(runs),
        "larger_nucleation": nucleation_table(slider, settings["nucleation"]),
    }


def run_study(
    slider: Mapping[str, Any],
    name: str,
    study: Mapping[str, Any],
    common: Mapping[str, Any],
) -> pd.DataFrame:
    """Run every point of a study with noise in the normal loads: a row for each point
    and draw.

    The noise depends on the number of blocks and on the draw only. A run without a
    global slip has NaN. `slider` has the arguments of `Chain.from_slider`; `study`
    pairs (of v_c [m/s] and t_v [s]), n_blocks, theta, push_height [m] (optional) and
    runs; `common` seed, noise (relative) and smallest_drops [N].
    """
    heights = study.get("push_height", [0.0])
    rows = []
    for pair, height, theta, n in product(
        study["pairs"], heights, study["theta"], study["n_blocks"]
    ):
        chain = Chain.from_slider(**{**slider, "theta": theta, "n_blocks": n})
        larger = LargerChain(chain, pair[0], pair[1], push_height=height)
        theory = critical_length(larger) / chain.length
        point = dict(
            zip(
                POINT, (name, *pair, height, parse_theta(theta), n, theory), strict=True
            )
        )
        random = np.random.default_rng([common["seed"], n])
        for draw in range(study["runs"]):
            weights = chain.weights * (
                1.0 + common["noise"] * random.uniform(-1.0, 1.0, n)
            )
            run = run_to_slip(replace(larger, chain=replace(chain, weights=weights)))
            rows.append(point | {"draw": draw} | numbers(run, common["smallest_drops"]))
    return pd.DataFrame(rows)


def run_to_slip(larger: LargerChain) -> Record:
    """Run to the end of the first global slip; the paper's chain by its own solver,
    which is faster."""
    limit = longest_run(larger.chain) / 4.0
    v_c = larger.weakening_velocity
    if v_c or larger.relaxation_time or larger.push_height:
        return simulate_larger(
            larger, limit, "global slip", STEP if v_c else STEP_OF_COULOMB
        )
    return simulate(larger.chain, limit, "global slip")


def numbers(run: Record, smallest_drops: Iterable[float]) -> dict[str, float]:
    """What is kept of a run that ends with its first global slip.

    events_counted is that of Fig. 13, mu_sapp Eq. 1, and events_over_x the number of
    events in which F_X falls by x [N] or more. growth says how much faster L_p grows
    with F_X beyond `KINK` L than before.
    """
    slips = find_slips(run)
    if not slips["is_global"].any():
        return {}
    drop = slips["load_before"] - slips["load_after"]
    last = slips.iloc[-1]
    passed = slips["load_before"].to_numpy()[
        (slips["front"] >= KINK * run.chain.n_blocks).argmax()
    ]
    rest = last["load_before"] - passed
    return {
        "events_counted": len(find_precursors(slips)),
        **{f"events_over_{x:g}N": int((drop >= x).sum()) for x in smallest_drops},
        "mu_sapp": mu_sapp(last["largest_load"], run.chain.normal_load),
        "growth": (1.0 - KINK) / KINK * passed / rest if rest > 0.0 else np.nan,
    }


def medians_table(runs: pd.DataFrame) -> pd.DataFrame:
    """Medians over the runs of a point with their 95 % intervals (name_low, name_high):
    a row for each point.

    runs is the number of runs, no_slip that of runs without a global slip;
    critical_length is l_c/L by the theory, 0 for the paper's chain.
    """
    rows = []
    for point, of_point in runs.groupby(POINT, sort=False):
        row = dict(zip(POINT, point, strict=True))
        row |= {"runs": len(of_point), "no_slip": int(of_point["mu_sapp"].isna().sum())}
        for name in runs.columns.drop([*POINT, "draw"]):
            low, high = median_interval(of_point[name].dropna())
            row |= {
                name: of_point[name].median(),
                f"{name}_low": low,
                f"{name}_high": high,
            }
        rows.append(row)
    return pd.DataFrame(rows)


def differences_table(runs: pd.DataFrame) -> pd.DataFrame:
    """Whether mu_sapp is the same for two loadings: a row for each pair of theta.

    difference is that of the medians (theta_b less theta_a), low and high its 95 %
    interval, and verdict what `compared` says of this interval and `SAME`.
    """
    rows = []
    keys = [key for key in POINT if key != "theta"]
    for point, of_point in runs.dropna(subset="mu_sapp").groupby(keys, sort=False):
        samples = dict(iter(of_point.groupby("theta")["mu_sapp"]))
        for a, b in combinations(samples, 2):
            low, high = median_difference(samples[b], samples[a])
            row = dict(zip(keys, point, strict=True)) | {"theta_a": a, "theta_b": b}
            row |= {
                "difference": samples[b].median() - samples[a].median(),
                "low": low,
                "high": high,
            }
            rows.append(row | {"verdict": compared(low, high, SAME)})
    return pd.DataFrame(rows)
