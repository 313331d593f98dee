"""Small tables for every figure, with numbers that can be told apart."""

from __future__ import annotations

from importlib import import_module
from itertools import product
from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd

from precursors.figures import style
from precursors.figures.failure_gallery import PANELS
from precursors.methods import METHODS

THETAS = {"fig11": -5 / 6, "fig10": 0.0, "fig12": 5 / 6}
N_BLOCKS, LENGTH_M, NORMAL_LOAD_N = 10, 0.1, 400.0
LOADING_RATE = 80.0  # N/s
FRONTS = [1, 2, 3, 4, 5, 2, 6, 4, 3, 8, 3, 9, 8, 3, 1, 10]
LOADS_N = [28.0, 47.4, 65.0, 79.0, 92.7, 99.4, 112.9, 118.4, 129.0, 142.1, 149.7, 164.7, 165.4]
LOADS_N += [170.0, 174.9, 194.3]
N_COUNTED = 9


def slips(fronts=FRONTS, loads_N=LOADS_N, theta=0.0, drop_N=1.5, **columns) -> pd.DataFrame:
    """Slip table of a load that grows steadily and drops by the same amount in each event."""
    front, load = np.array(fronts, dtype=int), np.array(loads_N, dtype=float)
    onset = (load + drop_N * np.arange(len(load))) / LOADING_RATE
    is_global = front == N_BLOCKS
    before = np.cumsum(is_global) - is_global == 0
    table = pd.DataFrame(
        {
            "onset_s": onset,
            "end_s": onset + 1e-4,
            "load_before_N": load,
            "load_after_N": load - drop_N,
            "front": front,
            "is_global": is_global,
            "counted": (front >= np.maximum.accumulate(front)) & before if len(front) else front > 0,
        }
    )
    slider = {"theta": theta, "n_blocks": N_BLOCKS, "normal_load_N": NORMAL_LOAD_N, "length_m": LENGTH_M}
    return table.assign(**{**slider, **columns})


def trace(events: pd.DataFrame, duration=10.0) -> pd.DataFrame:
    """Corners of the load: its start, both ends of each drop, and the end of the run."""
    last_s, last_N = (events["end_s"].iloc[-1], events["load_after_N"].iloc[-1]) if len(events) else (0, 0)
    end_N = last_N + LOADING_RATE * (duration - last_s)
    times = [0.0, *events[["onset_s", "end_s"]].to_numpy().ravel(), duration]
    loads = [0.0, *events[["load_before_N", "load_after_N"]].to_numpy().ravel(), end_N]
    return pd.DataFrame({"time_s": times, "tangential_load_N": loads})


def scene(events=None, duration=10.0, title="uniform") -> dict:
    events = slips() if events is None else events
    return {"slips": events, "trace": trace(events, duration), "title": title}


def precursor_lengths() -> dict:
    tables = [
        slips([1, 3, 2, 10], [51.3, 86.7, 120.0, 193.8], -5 / 6),
        slips(),
        slips([1, 1, 2, 1, 10], [4.7, 8.0, 12.0, 30.0, 195.3], 5 / 6),
    ]
    names = [*THETAS, "another"]
    mu_sapp = pd.DataFrame({"scene": names, "mu_sapp": [0.48, 0.49, 0.50, 0.9], "is_papers": True})
    return {
        "slips": tables,
        "mu_sapp": pd.concat([mu_sapp, mu_sapp.assign(mu_sapp=0.1, is_papers=False)]),
        "scenes": list(THETAS),
    }


def work_precision(thetas=(-5 / 6, 0.0, 5 / 6), extents=("global slip", "end")) -> dict:
    # Method, seconds, error of the load and of the time, transitions and slips right of 100 and 10.
    points = [
        ("exact", 1e-3, 1e-12, 1e-15, 100, 10),
        ("rk4", 2e-3, 2.0, 1e-2, 20, 4),
        ("rk4", 2e-2, 1e-1, 1e-3, 60, 10),
        ("rk4", 2e-1, 1e-2, 1e-4, 100, 10),
        ("rk4", 2e0, 1e-3, 1e-5, 100, 10),
        ("scipy_rk45", 1e-1, 0.0, np.nan, 0, 1),
    ]
    rows = [
        {
            "theta": theta,
            "until": until,
            "method": method,
            "label": f"label of {method}",
            "color": METHODS[method].look[0],
            "marker": METHODS[method].look[1],
            "evaluations": np.nan if method == "exact" else 1e5 * seconds,
            "seconds": seconds if until == "global slip" else 5 * seconds,
            "error_load_N": load,
            "error_time_s": time,
            "transitions_right": right,
            "slips_right": n_slips,
        }
        for theta, until, (method, seconds, load, time, right, n_slips) in product(thetas, extents, points)
    ]
    true = {"transitions_found": 100, "transitions_true": 100, "slips_found": 10, "slips_true": 10}
    return {"table": pd.DataFrame(rows).assign(**true)}


def step_sweep() -> dict:
    points = [
        ("exact", np.nan, 5, 10),
        ("rk4_skip", 1e-5, 7, 3),
        ("rk4_skip", 1e-7, 5, 10),
        ("rk4_skip", 1e-6, 6, 4),
        ("rk4", 1e-5, 8, 2),
    ]
    rows = [(name, theta, *point) for (name, theta), point in product(THETAS.items(), points)]
    columns = ["scene", "theta", "method", "step_s", "events_counted", "transitions_right"]
    table = pd.DataFrame(rows, columns=columns)
    return {"table": table.assign(mu_sapp=0.1 * table["events_counted"], transitions_true=10)}


def failure_gallery() -> dict:
    """The same curves in all panels; thresholds from 1.25, predicted ones from 3.75, for 10 blocks."""
    limits = [(*limit, panel.scale[0]) for panel in PANELS.values() for limit in panel.limits]
    thresholds = pd.DataFrame(limits, columns=["fails", "method", "scale"]).assign(n_blocks=10)
    place = np.arange(len(thresholds))
    thresholds["measured"] = (place + 1.25) / thresholds["scale"]
    thresholds["predicted"] = (place + 3.75) / thresholds.pop("scale")
    curves = []
    for panel in PANELS.values():
        x, y = np.array([0.1, 0.2, 0.4]) / np.reshape(panel.scale, (2, 1))
        lines = [pd.DataFrame({"curve": name, "x": x, "y": n * y}) for n, name in ((1, "exact"), (2, "bad"))]
        curves.append(pd.concat(lines))
    return {
        "thresholds": pd.concat([thresholds, thresholds.assign(n_blocks=2, measured=0.0)]),
        "curves": curves,
    }


def horizon() -> dict:
    chains = {"trailing": {"theta": "-5/6"}, "fast": {"theta": "5/6", "drive_velocity": 0.01}}
    errors = {"time_s": [0.05, 0.1, 0.15], "predicted_error_s": [1e-16, 1e-12, np.nan]}
    errors |= {"actual_error_s": [1e-17, 1e-13, 1e-10]}
    lost = {"duration_s": 0.2, "order_lost_s": 0.16, "horizon_s": 0.12, "right_until_s": 0.14}
    kept = {"duration_s": 0.2, "order_lost_s": np.inf, "horizon_s": 0.2, "right_until_s": 0.2}
    return {
        "errors": pd.concat([pd.DataFrame(errors).assign(chain=name) for name in chains]),
        "overview": pd.DataFrame([{"chain": "fast", **lost}, {"chain": "trailing", **kept}]),
        "exponents": pd.DataFrame(
            {"theta": [-5 / 6, 0.0], "exponent_per_s": [1.5, 1.7], "uncertainty_per_s": 0.3}
        ),
        "chains": chains,
        "tolerance": 1e-9,
    }


def noise() -> dict:
    counts = [14, 14, 15, 15, 15]
    runs = pd.DataFrame({"scene": "s", "theta": 0.5, "draw": range(5), "events_counted": counts})
    runs = runs.assign(mu_sapp=[0.5, 0.48, 0.5, 0.52, np.nan])
    return {"noise": runs, "digits": runs.assign(theta=-0.5, events_counted=9)}


def theta_window() -> dict:
    theta = [0.5, *(0.4 + 0.05 * k for k in range(5))]
    members = pd.DataFrame({"scene": "s", "theta": theta, "point": range(6), "mu_sapp": 0.5})
    return {"members": members.assign(events_counted=4)}


def resolution() -> dict:
    quantities = {"events_to_global_slip": 300.0, "events_counted": 100.0, "mu_sapp": 0.5, "time_s": 2.7}
    quantities |= {"front_speed_m_per_s": 1000.0}
    rows = [
        {"scene": "s", "theta": 0.0, "n_blocks": n, "quantity": quantity, "q50": value}
        for (quantity, value), n in product(quantities.items(), (2, 20, 200))
    ]
    table = pd.DataFrame(rows)
    table = table.assign(q05=0.8 * table["q50"], q95=1.1 * table["q50"], without_noise=table["q50"])
    limits = {"scene": ["s"], "quantity": ["mu_sapp"], "a": [0.45], "a_low": 0.42, "a_high": 0.46}
    limits |= {"wave_speed_m_per_s": 1440.0}
    foreseen = pd.DataFrame(
        {"scene": "s", "n_blocks": [2, 20], "horizon_s": 2.5, "predictable": [True, False]}
    )
    return {"table": table, "limits": pd.DataFrame(limits), "predictability": foreseen, "papers_n": 12}


def event_law() -> dict:
    varied = ["N and theta", "N and theta", "friction", "drive", "loading"]
    table = pd.DataFrame({"varied": varied, "theta": 0.0, "n_blocks": [5, 10, 10, 10, 10]})
    law = {"law": 20.0, "events": 16.0, "ratio": 0.8, "ratio_low": 0.6, "ratio_high": 0.9, "rise": 1.25}
    return {"table": table.assign(**law)}


def friction_map() -> dict:
    rows = [
        {"theta": theta, "friction_ratio": ratio, "mu_sapp": 0.1 * ratio + theta}
        for theta in (-0.5, 0.5)
        for ratio in (1.0, 2.0, 3.0)
    ]
    table = pd.DataFrame(rows).assign(events_counted=3, n_global=1, n_all_events=4, reached=True)
    table.loc[0, "reached"] = False
    return {"table": table, "scenes": [(0.25, 2.0)]}


def larger() -> dict:
    lengths = {"relaxation_time": [0.0, 0.0, 1e-6], "n_blocks": [100, 200, 200], "theory": [0.3, 0.3, 0.5]}
    columns = [
        "study",
        "weakening_velocity",
        "critical_length",
        "theta",
        "n_blocks",
        "events_counted",
        "mu_sapp",
    ]
    rows = [
        ("resolution", 0.0, 0.0, 0.0, 10, 9.0, 0.48),
        ("resolution", 0.0, 0.0, 0.0, 100, 40.0, 0.46),
        ("resolution", 0.05, 0.25, 0.0, 10, 8.0, 0.52),
        ("resolution", 0.05, 0.25, 0.0, 100, 10.0, 0.5),
        ("resolution", 0.05, 0.25, 0.5, 10, 30.0, 0.9),
        ("loading", 0.05, 0.25, 0.0, 10, 30.0, 0.9),
    ]
    table = pd.DataFrame(rows, columns=columns).assign(relaxation_time=0.0)
    for name in ("events_counted", "mu_sapp"):
        table = table.assign(**{f"{name}_low": 0.9 * table[name], f"{name}_high": 1.2 * table[name]})
    return {"nucleation": pd.DataFrame(lengths).assign(measured=[0.2, 0.28, 0.55]), "table": table}


def model_comparison() -> dict:
    rows = [
        ("a", "mu_sapp", "paper's chain", 0.49, 0.0, True, True, 3e-3),
        ("a", "mu_sapp", "front law", 0.45, 0.08, False, False, 1e-7),
        ("b", "mu_sapp", "paper's chain", 0.48, 0.0, True, True, 1e-3),
        ("b", "mu_sapp", "front law", 0.45, 0.07, False, False, 2e-6),
        ("a", "slip_duration", "paper's chain", 5e-4, 0.0, True, True, 2e-3),
    ]
    columns = ["scene", "question", "label", "value", "error", "is_answer", "is_smallest", "cost_s"]
    return {"table": pd.DataFrame(rows, columns=columns).assign(error_unit="1", tolerance=0.05)}


def definitions() -> dict:
    readings = [
        ("nothing", ""),
        ("global slip", "in which F_X drops by more than 3 N"),
        ("size of theta", "0.9"),
    ]
    rows = [
        {"changed": changed, "global_slip": value, "degree": value, "theta": theta}
        | {"events_counted": 7 + (value == "0.9"), "mu_sapp": 0.5 if theta else np.nan}
        for changed, value in readings
        for theta in (-0.9, 0.0, 0.9)
    ]
    table = pd.DataFrame(rows)
    return {
        "table": table.assign(
            events_counted_is_papers=table["events_counted"] == 7,
            mu_sapp_is_papers_within_a_digit=table["theta"] > 0.8,
            numbers_within_a_digit=np.where(table["events_counted"] == 7, 4, 1),
        )
    }


# Figures by name: module and tables.
PUBLISHED = Path(__file__).parents[2] / "paper/tables"
SPEED = {"table": "work_precision_full.csv", "sessions": "beside_heyoka.csv"}
EXAMPLES = {
    "fig09": ("chain_schematic", dict),
    "scene": ("scene", scene),
    "fig13": ("precursor_lengths", precursor_lengths),
    "definitions": ("definitions", definitions),
    "work_precision": ("work_precision", work_precision),
    "speed": ("speed", lambda: {name: pd.read_csv(PUBLISHED / file) for name, file in SPEED.items()}),
    "step_sweep": ("step_sweep", step_sweep),
    "failure_gallery": ("failure_gallery", failure_gallery),
    "horizon": ("horizon", horizon),
    "noise": ("noise", noise),
    "theta_window": ("theta_window", theta_window),
    "resolution": ("resolution", resolution),
    "event_law": ("event_law", event_law),
    "friction_map": ("friction_map", friction_map),
    "model_comparison": ("model_comparison", model_comparison),
    "larger": ("larger", larger),
}


def draw(name, **changes):
    """Draw the example of a figure, with other tables or options where they are given."""
    module, tables = EXAMPLES[name]
    return import_module(f"precursors.figures.{module}").draw(**{**tables(), **changes})


def save_small(figure, path: Path) -> None:
    """Write a figure with so few pixels that another word, colour or point is a large part of them."""
    with mock.patch.object(style, "PNG_DPI", 60):
        style.save(figure, path)
