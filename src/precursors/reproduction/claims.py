"""All claims, and the table of their verdicts."""

from __future__ import annotations

import pandas as pd

from precursors.reproduction import claims_discussion, claims_results
from precursors.reproduction.claim import NO_EVENT, Claim, shown
from precursors.reproduction.tables import SCENES, Tables

CLAIMS = [
    value
    for module in (claims_results, claims_discussion)
    for value in vars(module).values()
    if isinstance(value, Claim)
]
# The tables that the claims are compared with: results/tables/{name}.csv.
TABLES = (
    *(f"{scene}_slips" for scene in SCENES),
    *(f"{scene}_trace" for scene in SCENES),
    "measures",
    "mu_sapp",
    "lyapunov",
    "definitions",
    "eq15",
    "failures",
    "digits",
    "noise",
    "noise_differences",
    "model_comparison",
    "map_theta_friction_ratio",
)
COLUMNS = ["id", "where", "kind", "statement", "unit", "paper", "ours", "rule", "verdict"]


def evaluate(tables: Tables) -> pd.DataFrame:
    """Compare every claim with the tables: one row a claim, all text, numbers with four digits.

    A claim on an event that a run does not have, such as a global slip, is not reproduced.

    Raises
    ------
    ValueError
        In one line: a claim whose column is not in the tables.
    """
    return pd.DataFrame([_row(claim, tables) for claim in CLAIMS], columns=COLUMNS)


def differences(found: pd.DataFrame, expected: pd.DataFrame) -> list[str]:
    """Say in a line each which claims are new, missing, or of another verdict than expected."""
    new, old = (table.set_index("id")["verdict"] for table in (found, expected))
    both = [name for name in new.index if name in old.index]
    return [
        *(f"{name}: is not among the expected claims" for name in new.index.difference(old.index)),
        *(f"{name}: is missing" for name in old.index.difference(new.index)),
        *(f"{name}: is {new[name]!r}, expected {old[name]!r}" for name in both if new[name] != old[name]),
    ]


def _row(claim: Claim, tables: Tables) -> dict[str, str]:
    try:
        finding = claim.find(tables)
    except (IndexError, ZeroDivisionError):
        finding = NO_EVENT
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"claim {claim.id}: the tables do not have its numbers: {error}") from error
    return {
        "id": claim.id,
        "where": claim.where,
        "kind": claim.kind,
        "statement": claim.statement,
        "unit": claim.unit,
        "paper": shown(finding.paper),
        "ours": shown(finding.ours),
        "rule": finding.rule,
        "verdict": claim.verdict(finding, tables),
    }
