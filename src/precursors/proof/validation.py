"""The error estimate held against the proof: what a run gets wrong, and what it says it does."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from precursors.horizon import ErrorGrowth, error_growth
from precursors.proof.agreement import Agreement, compare
from precursors.proof.certificate import Certificate
from precursors.proof.exact_chain import ExactChain
from precursors.run import Run
from precursors.slips import find_slips

DURATION = 10.0
# Rows of a chain's error table, at most.
ROWS = 400


def exact_chain(values: Mapping[str, Any]) -> ExactChain:
    """The chain of the configuration's `horizon.chains` that has some values of its own."""
    return ExactChain.from_slider(**{name: x for name, x in values.items() if name != "duration"})


def chain_duration(values: Mapping[str, Any]) -> float:
    """How long a chain of `horizon.chains` is run [s]."""
    return float(values.get("duration", DURATION))


def certificate_path(directory: str | Path, name: str) -> list[str]:
    """The certificate of a chain in a directory, if it is there."""
    path = Path(directory) / f"{name}.json.gz"
    return [str(path)] if path.is_file() else []


class Validation(NamedTuple):
    """A run of the solver in double precision beside its proof and its own estimate of its errors."""

    run: Run
    agreement: Agreement
    growth: ErrorGrowth


def validate(certificate: Certificate) -> Validation:
    """Run the chain of a certificate, rounded to double precision, and compare.

    Raises
    ------
    ValueError
        If the certificate ends with a first global slip.
    """
    from precursors.exact import simulate

    if certificate.until is not None:
        raise ValueError("the certificate ends with a global slip: allowed is one of a given duration")
    start = [float(x) for x in certificate.start_positions]
    run = simulate(certificate.chain.to_chain(), float(certificate.duration), start_positions=start)
    return Validation(run, compare(run, certificate), error_growth(run))


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
    is_global = slips["is_global"].to_numpy()
    first_end = float(slips["end"].to_numpy()[is_global][0]) if is_global.any() else np.nan
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
        "order_doubtful_s": growth.lost.time,
        "largest_ratio": _largest(_ratio(agreement.time_error, growth.time_error[:n], known)),
    }


def certificate_row(certificate: Certificate) -> dict[str, float]:
    """What is proved, in one row of certificates.csv."""
    widest_time, widest_load = certificate.widest
    return {
        "proved_until_s": float(certificate.proved_until),
        "transitions": len(certificate.transitions),
        "largest_time_width_s": float(2 * widest_time),
        "largest_load_width_N": float(2 * widest_load),
        "bits": certificate.bits,
        "restarts": certificate.restarts,
    }


def is_about(certificate: Certificate, chain: ExactChain, duration: float) -> bool:
    """Whether a certificate is about all of the run of a chain from rest, for `duration` [s]."""
    return (
        certificate.chain == chain
        and certificate.duration == Fraction(repr(duration))
        and certificate.until is None
        and not any(certificate.start_positions)
    )


def _largest(values: np.ndarray) -> float:
    return float(np.max(values, initial=0.0))


def _ratio(actual: np.ndarray, predicted: np.ndarray, known: np.ndarray) -> np.ndarray:
    return np.maximum.accumulate(actual[known]) / np.maximum.accumulate(predicted[known])
