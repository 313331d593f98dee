"""The error estimate held against the proof: what a run gets wrong, and what it says it does."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd

from precursors.accuracy.proof.agreement import Agreement, compare
from precursors.accuracy.proof.certificate import Certificate
from precursors.analysis.horizon import PredictedErrors, predicted_errors
from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import find_slips
from precursors.solver.run import Run

# Rows of a chain's error table, at most.
ROWS = 400


class Validation(NamedTuple):
    """A run of the solver in double precision beside its proof and its own estimate of its errors."""

    run: Run
    agreement: Agreement
    growth: PredictedErrors


def validate(certificate: Certificate) -> Validation:
    """Run the chain of a certificate, rounded to double precision, and compare.

    Raises
    ------
    ValueError
        If the certificate ends with a first global slip.
    """
    from precursors.solver.simulate import simulate

    if certificate.until is not None:
        raise ValueError("the certificate ends with a global slip: allowed is one of a given duration")
    start = [float(x) for x in certificate.start_positions]
    run = simulate(certificate.chain.to_chain(), float(certificate.duration), start_positions=start)
    return Validation(run, compare(run, certificate), predicted_errors(run))


def error_table(validation: Validation) -> pd.DataFrame:
    """Largest error so far, actual and predicted, at up to `ROWS` transitions; NaN where order is lost."""
    run, agreement, growth = validation
    n = len(run.transitions)
    actual, predicted = np.full((2, n), np.nan)
    actual[: agreement.n_agreeing] = np.maximum.accumulate(agreement.time_error)
    known = np.isfinite(growth.time_error)
    predicted[known] = np.maximum.accumulate(growth.time_error[known])
    rows = np.unique(np.linspace(0, n - 1, ROWS).astype(int))
    return pd.DataFrame(
        {
            "time_s": run.transitions["time"][rows],
            "actual_error_s": actual[rows],
            "predicted_error_s": predicted[rows],
        }
    )


def summary(validation: Validation, tolerance: float) -> dict[str, float]:
    """What the run gets right, in one row of solver_vs_proof.csv.

    `right_until_s` is when the first transition is in error by more than the tolerance, of another block, or
    to another mode; `largest_ratio` is that of actual to predicted error, both the largest so far.
    """
    run, agreement, growth = validation
    n = agreement.n_agreeing
    time = run.transitions["time"][:n]
    wrong = time[agreement.time_error > tolerance]
    known = np.isfinite(growth.time_error[:n])
    slips = find_slips(run)
    first = first_global(slips)
    first_end = np.nan if first is None else float(slips["end"].iloc[first])
    until = time <= first_end
    return {
        "duration_s": run.duration,
        "transitions": len(run.transitions),
        "agreeing_transitions": n,
        "first_global_slip_end_s": first_end,
        "time_error_to_first_global_slip_s": _largest(agreement.time_error[until]),
        "load_error_to_first_global_slip_N": _largest(agreement.load_error[until]),
        "time_error_while_agreeing_s": _largest(agreement.time_error),
        "load_error_while_agreeing_N": _largest(agreement.load_error),
        "right_until_s": float(min(wrong[0] if wrong.size else np.inf, agreement.lost, run.duration)),
        "horizon_s": growth.horizon(tolerance),
        "order_lost_s": agreement.lost,
        "order_known_until_s": growth.unknown.time,
        "largest_ratio": _largest(_ratio(agreement.time_error, growth.time_error[:n], known)),
    }


def _largest(values: np.ndarray) -> float:
    return float(np.max(values, initial=0.0))


def _ratio(actual: np.ndarray, predicted: np.ndarray, known: np.ndarray) -> np.ndarray:
    return np.maximum.accumulate(actual[known]) / np.maximum.accumulate(predicted[known])
