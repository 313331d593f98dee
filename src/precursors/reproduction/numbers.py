"""The numbers in the text of the paper, by name, from the tables and the configuration.

A number is a value, or a value with its unit. A missing row of a table is an error of one line.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from precursors.reproduction import eq15, numbers_of_studies
from precursors.reproduction.claim import FOLLOWS, FRAGILE, NOT_REPRODUCED, REPRODUCED
from precursors.reproduction.claims import TABLES as TABLES_OF_CLAIMS
from precursors.reproduction.claims_results import leading_reading
from precursors.reproduction.numbers_of_studies import CHAINS, Numbers
from precursors.reproduction.subject import changes
from precursors.reproduction.tables import (
    SCENES,
    TRAILING,
    Tables,
    before_global,
    one,
    rows,
    up_to_global,
)

# results/tables/{name}.csv, of which the text has numbers.
TABLES = (
    *TABLES_OF_CLAIMS,
    "claims",
    *numbers_of_studies.TABLES,
)
# Keys of the configuration that the text has numbers of.
KEYS = ("chain", "load_cells", "scenes", "duration", "reproduction", "accuracy", "ensembles")


def numbers(t: Tables, config: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Every number of the text: name -> value and unit.

    Raises
    ------
    ValueError
        In one line: which part of the text needs a number that the tables or the configuration do not have.
    """
    found: Numbers = {}
    for part in PARTS:
        try:
            found |= part(t, config)
        except (KeyError, IndexError, TypeError, ValueError) as error:
            raise ValueError(f"the paper's numbers of {part.__name__}: {error} is missing") from error
    return {name: _plain(name, value) for name, value in found.items()}


def model(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """Parameters and scenes."""
    chain, measured = config["chain"], rows(t["measures"], scene="fig10").iloc[0]
    found: Numbers = {
        "n-blocks": chain["n_blocks"],
        "mu-s": chain["mu_s"],
        "mu-k": chain["mu_k"],
        "normal-load": (chain["normal_load"], "N"),
        "drive-stiffness": (chain["drive_stiffness"], "N/m"),
        "drive-velocity": (chain["drive_velocity"], "m/s"),
        "slider-mass": (chain["slider_mass"], "kg"),
        "youngs-modulus": (chain["youngs_modulus"], "Pa"),
        "cross-section": (chain["cross_section"], "m^2"),
        "length": (chain["length"], "m"),
        "cell-spacing": (config["load_cells"]["spacing"], "m"),
        "duration": (config["duration"], "s"),
        "block-mass": (measured["block_mass_kg"], "kg"),
        "block-stiffness": (measured["stiffness_N_per_m"], "N/m"),
        "loading-rate": (measured["drive_stiffness_N_per_m"] * measured["drive_velocity_m_per_s"], "N/s"),
        "changed": ", ".join(changes(config)),
        "literal-load": (rows(t["failures"], failure_mode="literal_friction")["measured"].iloc[-1], "N"),
        "literal-step": rows(t["failures"], failure_mode="literal_friction")["setting"].iloc[-1],
    }
    for scene in SCENES:
        found[f"theta-{scene}"] = t[f"{scene}_slips"]["theta"].iloc[0]
        found[f"cell-a-{scene}"] = (config["scenes"][scene]["load_cell_a"], "N")
        found[f"cell-b-{scene}"] = (config["scenes"][scene]["load_cell_b"], "N")
        found[f"backward-{scene}"] = one(t["measures"], "backward_releases", scene=scene)
        found[f"transitions-{scene}"] = one(t["measures"], "transitions", scene=scene)
    return found


def printed(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """What the paper prints, as the claims have it."""

    def of(claim: str, number: int = 0) -> float:
        return float(one(t["claims"], "paper", id=claim).split("; ")[number])

    found: Numbers = {
        "printed-theta": of("theta-of-the-load-cells", 2),
        "printed-mu": of("friction-rounded"),
        "experiment-mu": of("friction-of-the-experiment"),
        "experiment-load": (of("load-of-the-experiment"), "N"),
        "experiment-duration": (of("slip-duration-of-the-experiment"), "s"),
        "experiment-ageing": (of("ageing"), "s"),
    }
    for i, (scene, load) in enumerate(zip(SCENES, CHAINS, strict=True)):
        found[f"printed-events-{scene}"] = of(f"count-{load}")
        found[f"experiment-events-{load}"] = of("counts-of-the-experiment", i)
    return found


def results(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """The paper's Figs. 10 to 13, and its Eq. 15."""
    fast = rows(t["eq15"], check=eq15.FAST)[["found", "expected"]].astype(float)
    found: Numbers = {
        "events-at-printed-theta": leading_reading(t, "events_counted", degree="0.833"),
        "mu-at-printed-theta": leading_reading(t, "mu_sapp", degree="0.833"),
        "shortest-slip": (min(shortest_slip(t[f"{scene}_slips"]) for scene in SCENES), "s"),
        "eq15-checks": len(t["eq15"]),
        "eq15-holding": t["eq15"]["holds"].sum(),
        "eq15-below": rows(t["eq15"], check=eq15.BELOW)["found"].astype(float).min(),
        "load-of-printed-eq12": (one(t["claims"], "paper", id="eq12-last-line").split("; ")[1], "N"),
        "load-of-eq12": (one(t["claims"], "ours", id="eq12-last-line"), "N"),
    }
    if fast["found"].notna().all():
        least, most = fast["found"].agg(["min", "max"])
        found |= {"eq15-speed-least": (least, "m/s"), "eq15-speed-most": (most, "m/s")}
        found["eq15-speed-rigid"] = (fast["expected"].iloc[0], "m/s")
    for scene in SCENES:
        slips, ours = t[f"{scene}_slips"], rows(t["mu_sapp"], scene=scene, is_papers=True).iloc[0]
        partial, last = before_global(t, scene), up_to_global(t, scene).iloc[-1]
        found |= {
            f"events-{scene}": slips["counted"].sum(),
            f"all-events-{scene}": len(partial) + 1,
            f"short-events-{scene}": len(rows(partial, counted=False)),
            f"not-at-once-{scene}": (partial["n_slid"] > partial["n_simultaneous"]).sum(),
            f"slips-{scene}": len(slips),
            f"mu-{scene}": ours["mu_sapp"],
            f"load-{scene}": (ours["load_N"], "N"),
            f"time-{scene}": (ours["time_s"], "s"),
            f"first-load-{scene}": (slips["load_before_N"].iloc[0], "N"),
            f"first-time-{scene}": (slips["onset_s"].iloc[0], "s"),
            f"slip-duration-{scene}": (last["end_s"] - last["onset_s"], "s"),
            f"largest-load-{scene}": (t[f"{scene}_trace"]["tangential_load_N"].max(), "N"),
            f"strain-{scene}": one(t["measures"], "residual_strain", scene=scene),
        }
    return found


def shortest_slip(slips: pd.DataFrame) -> float:
    """Duration of the shortest slip of a scene [s]."""
    return float((slips["end_s"] - slips["onset_s"]).min())


def readings(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """What other readings of the paper give."""
    uniform = rows(t["definitions"], theta=0.0)
    other = rows(
        t["mu_sapp"],
        scene=TRAILING,
        definition="largest F_X up to the first event in which every block slides at some time",
    ).iloc[0]
    return {
        "readings": len(uniform),
        "best-readings": uniform["numbers_within_a_digit"].max(),
        "best-readings-printed": uniform["numbers_as_printed"].max(),
        "readings-that-do": len(rows(uniform, numbers_within_a_digit=6)),
        "switching-that-do": rows(uniform, numbers_within_a_digit=6)["switching"].nunique(),
        "other-global-events": other["events_counted"],
        "other-global-mu": other["mu_sapp"],
    }


def claims(t: Tables, config: Mapping[str, Any]) -> Numbers:
    """Verdicts, and how many results have which."""
    table = t["claims"]
    found: Numbers = {f"verdict-{row['id']}": row["verdict"] for row in table.to_dict("records")}
    results = rows(table, kind="result")["verdict"]
    return found | {
        "claims-result": len(results),
        "reproduced-result": (results == REPRODUCED).sum(),
        "fragile-result": (results == FRAGILE).sum(),
        "failed-result": (results == NOT_REPRODUCED).sum(),
        "claims-by-the-equations": len(rows(table, kind=FOLLOWS)),
    }


PARTS = (model, printed, results, readings, *numbers_of_studies.PARTS, claims)


def _plain(name: str, number: Any) -> dict[str, Any]:
    """A text, or one finite number that JSON knows, with its unit."""
    value, unit = number if isinstance(number, tuple) else (number, "1")
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            return {"value": value, "unit": unit}
    if not np.isfinite(value):
        raise ValueError(f"the paper's number {name} is {value} in the tables: needed is a number")
    whole = float(value).is_integer() and abs(value) < 1e15
    return {"value": int(value) if whole else float(value), "unit": unit}
