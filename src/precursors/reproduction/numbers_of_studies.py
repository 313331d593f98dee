"""Numbers in the text of the paper on methods, proof, model hierarchy and ensembles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from precursors.reproduction.subject import scenes_are_proved
from precursors.reproduction.tables import LEADING, SCENES, Tables, one, rows

# Name -> value, or value and unit.
Numbers = dict[str, Any]
# The chains of the proof that are the paper's scenes, in the order of SCENES.
CHAINS = ("trailing", "uniform", "leading")
# results/tables/{name}.csv
TABLES = (
    "certificates",
    "solver_vs_proof",
    "work_precision",
    "step_sweep",
    "thresholds",
    "model_comparison",
)


def yes_or_no(answer: bool) -> str:
    """Say whether something is so, for a condition of the text."""
    return "yes" if answer else "no"


def speed(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """Speed against accuracy; heyoka's numbers only where it is installed."""
    sweep = t["step_sweep"]
    found: Numbers = {"finest-step": (sweep["step_s"].min(), "s")}
    names = {
        "exact": "exact",
        "heyoka": "heyoka",
        "dop853": "scipy_dop853",
        "compiled": "dop853",
        "rk4": "rk4_skip",
    }
    for chain in CHAINS:
        own = rows(t["work_precision"], scene=chain, until="global slip")
        found[f"theta-{chain}"] = own["theta"].iloc[0]
        found[f"slip-transitions-{chain}"] = own["transitions_true"].iloc[0]
        for name, method in names.items():
            for tightest in rows(own, method=method).tail(1).to_dict("records"):
                found[f"{name}-seconds-{chain}"] = (tightest["seconds"], "s")
                found[f"{name}-evaluations-{chain}"] = tightest["evaluations"]
                found[f"{name}-time-error-{chain}"] = (tightest["error_time_s"], "s")
    charted = rows(t["work_precision"], scene="uniform", until="global slip", method="rk4_skip")
    found["rk4-step"] = (charted["value"].min(), "s")
    steps = rows(sweep, scene=LEADING, method="rk4_skip")
    others = rows(sweep[sweep["scene"] != LEADING], method="rk4_skip")
    counts = rows(sweep, method="exact").set_index("scene")["events_counted"]
    last = others.sort_values("step_s").groupby("scene").first()
    found["sweep-finest-right"] = yes_or_no(
        bool((last["transitions_right"] == last["transitions_true"]).all())
    )
    right_count = others["events_counted"] == others["scene"].map(counts)
    wrong_early = 2 * others["transitions_right"] < others["transitions_true"]
    found["sweep-lucky-counts"] = (right_count & wrong_early).sum()
    found["sweep-true"] = one(sweep, "transitions_true", scene=LEADING, method="exact")
    found["sweep-most-right"] = steps["transitions_right"].max()
    for name, column in (("mu", "mu_sapp"), ("events", "events_counted")):
        found |= {f"sweep-least-{name}": steps[column].min(), f"sweep-most-{name}": steps[column].max()}
    return found


def failures(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """Where methods fail."""

    def of(mode: str, quantity: str, column: str = "measured", method: str = "") -> float:
        found = rows(t["failures"], failure_mode=mode, quantity=quantity)
        return float((rows(found, method=method) if method else found)[column].iloc[-1])

    limits = t["thresholds"]
    found: Numbers = {
        "forward-right": of("forward_only", "transitions right"),
        "forward-right-theory": of("forward_only", "transitions right", "predicted"),
    }
    for name, fails, method, unit in (
        ("silent-step", "no global slip", "RK4", "s"),
        ("zone", "a narrower zone", "Karnopp's dead zone", "1"),
        ("stiff-step", "creep becomes", "RK4, friction", "s"),
        ("missed-step", "two roots", "SciPy DOP853", "s"),
        ("merged-window", "two of three", "DOP853", "s"),
    ):
        chosen = limits["fails"].str.startswith(fails) & limits["method"].str.startswith(method)
        limit = limits[chosen & (limits["n_blocks"] == 10)].iloc[0]
        found[name], found[f"{name}-theory"] = (limit["measured"], unit), (limit["predicted"], unit)
    ratios = {
        "lost": rows(limits, fails="no global slip, or numbers overflow")["ratio"],
        "interval": rows(limits, theory="shortest time between two transitions")["ratio"],
    }
    for name, ratio in ratios.items():
        found |= {f"least-ratio-{name}": ratio.min(), f"most-ratio-{name}": ratio.max()}
    return found | {
        "silent-least-mu": of("silent_instability", "least mu_sapp of these"),
        "silent-most-mu": of("silent_instability", "largest mu_sapp of these"),
        "silent-right": of("silent_instability", "most transitions right of these"),
        "damping-left": rows(t["failures"], quantity="energy left after 100 us")["measured"].min(),
        "creep-share": of("creep", "velocity in stick, of the drive's"),
        "missed-right": of("missed_roots", "transitions right"),
        "missed-true": of("missed_roots", "transitions right", "exact"),
        "merged-close": of("merged_transitions", "transitions merged"),
        "merged-right": of("merged_transitions", "transitions right"),
        "dead-zone-right": of("dead_zone_too_large", "transitions right"),
        "dead-zone-true": of("dead_zone_too_large", "transitions right", "exact"),
        "forward-theta": rows(t["failures"], failure_mode="forward_only")["setting"].iloc[-1],
        "forward-mu-leading": of("forward_only", "mu_sapp"),
        "forward-events-leading": of("forward_only", "events counted"),
    }


def proof(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """Proof, predictability time, chaos."""
    proved, compared, study = t["certificates"], t["solver_vs_proof"], config["accuracy"]
    scenes = rows(proved, chain=list(CHAINS))
    ours = rows(compared, chain=list(CHAINS))
    found: Numbers = {
        "proved-until": (one(proved, "proved_until_s", chain="uniform"), "s"),
        "proved-chains": len(proved),
        "scenes-are-proved": yes_or_no(scenes_are_proved(t, config, CHAINS)),
        "proved-in-all": proved["transitions"].sum(),
        "widest-time": (scenes["largest_time_width_s"].max(), "s"),
        "widest-load": (scenes["largest_load_width_N"].max(), "N"),
        "slip-time-error": (ours["time_error_to_first_global_slip_s"].max(), "s"),
        "run-time-error": (ours["time_error_while_agreeing_s"].max(), "s"),
        "horizon-tolerance": (study["tolerance"], "s"),
        "horizon-worst-ratio": compared["largest_ratio"].max(),
        "fast-drive-lost": (one(compared, "order_lost_s", chain="fast_drive"), "s"),
        "fast-drive-velocity": (study["proved"]["fast_drive"]["drive_velocity"], "m/s"),
        "lyapunov-duration": (study["lyapunov_duration"], "s"),
    }
    for scene, chain in zip(SCENES, CHAINS, strict=True):
        found |= {
            f"transitions-{chain}": one(proved, "transitions", chain=chain),
            f"agreeing-{chain}": one(compared, "agreeing_transitions", chain=chain),
            f"horizon-{chain}": (one(compared, "horizon_s", chain=chain), "s"),
            f"right-until-{chain}": (one(compared, "right_until_s", chain=chain), "s"),
            f"lyapunov-{scene}": (one(t["lyapunov"], "exponent_per_s", scene=scene), "1/s"),
            f"lyapunov-error-{scene}": (one(t["lyapunov"], "uncertainty_per_s", scene=scene), "1/s"),
        }
    return found


def hierarchy(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """Smaller models beside the paper's chain."""
    table = t["model_comparison"]
    counts = rows(table, question="events_counted").set_index(["model", "scene"])["value"]
    return {
        **{f"{m}-events-{scene}": counts[m, scene] for m in ("quasistatic", "chain") for scene in SCENES},
        "quasistatic-lengths-worst": rows(table, question="front_loads", model="quasistatic")["error"].max(),
        "overdamped-worst": rows(table, question="mu_sapp", model="overdamped")["error"].max(),
        "law-worst": rows(table, question="mu_sapp", model="law")["error"].max(),
        "law-lengths-worst": rows(table, question="front_loads", model="law")["error"].max(),
        "rigid-mu": rows(table, question="mu_sapp", model="rigid")["value"].mean(),
        "hierarchy-mu-tolerance": rows(table, question="mu_sapp")["tolerance"].iloc[0],
    }


PARTS = (speed, failures, proof, hierarchy)
