"""Compare the solver with proofs: its actual and its predicted errors."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import pandas as pd

from maegawa2010.studies.horizon.chains import certificate_row
from precursors.analysis.horizon import PredictedErrors, predicted_errors
from precursors.benchmark.compare import Comparison, Truth, compare, until_global_slip
from precursors.proof import Certificate
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# Largest number of rows for a chain in the table of errors.
ROWS = 400


class Validation(NamedTuple):
    """A run in double precision with its actual and its predicted errors."""

    run: Run
    actual: Comparison
    predicted: PredictedErrors


def proof_tables(
    certificates: Mapping[str, Certificate], tolerance: float
) -> dict[str, pd.DataFrame]:
    """Tables by file name: the proofs, the growth of the solver's errors, and its
    accuracy."""
    runs = {name: validate(certificate) for name, certificate in certificates.items()}
    errors = [error_table(run).assign(chain=name) for name, run in runs.items()]
    return {
        "certificates": pd.DataFrame(
            {"chain": name, **certificate_row(certificate)}
            for name, certificate in certificates.items()
        ),
        "horizon": pd.concat(errors)[
            ["chain", "time_s", "actual_error_s", "predicted_error_s"]
        ],
        "solver_vs_proof": pd.DataFrame(
            [{"chain": name, **summary(run, tolerance)} for name, run in runs.items()]
        ),
    }


def validate(certificate: Certificate) -> Validation:
    """Simulate the chain of a certificate, rounded to double precision, over the proved
    duration, and compare the run with the proof."""
    truth = Truth.proved(certificate)
    start = [float(x) for x in certificate.start_positions]
    run = simulate(truth.run.chain, truth.run.duration, start_positions=start)
    return Validation(run, compare(run, truth), predicted_errors(run))


def largest_errors(validation: Validation) -> pd.DataFrame:
    """Largest error so far at each transition, actual and predicted; NaN where the order
    of transitions is unknown."""
    run, compared, predictions = validation
    errors = pd.DataFrame(
        {
            "time_s": run.transitions["time"],
            "predicted_error_s": predictions.time_error,
        }
    )
    errors["actual_error_s"] = pd.Series(compared.time_errors)
    return errors.replace(np.inf, np.nan).cummax()


def error_table(validation: Validation) -> pd.DataFrame:
    """`largest_errors` at up to `ROWS` transitions."""
    errors = largest_errors(validation)
    return errors.iloc[np.unique(np.linspace(0, len(errors) - 1, ROWS).astype(int))]


def summary(validation: Validation, tolerance: float) -> dict[str, float]:
    """Accuracy of the run, a row of solver_vs_proof.csv.

    `right_until_s` is the time of the first wrong transition: its error is above the
    tolerance [s], or its block or mode is another. `horizon_s` is the prediction of this
    time. `largest_ratio` is the largest ratio of actual to predicted error, where each
    error is the largest so far.
    """
    run, compared, predictions = validation
    errors = largest_errors(validation)
    actual = errors["actual_error_s"]
    n = compared.transitions_right
    wrong = run.transitions["time"][:n][compared.time_errors > tolerance]
    to_global_slip = until_global_slip(run).transitions
    return {
        "duration_s": run.duration,
        "transitions": len(run.transitions),
        "agreeing_transitions": n,
        "time_error_to_global_slip_s": actual[: len(to_global_slip)].max(),
        "time_error_while_agreeing_s": compared.time_error,
        "right_until_s": min(*wrong[:1], compared.first_difference, run.duration),
        "horizon_s": predictions.horizon(tolerance),
        "order_lost_s": compared.first_difference,
        "largest_ratio": (actual / errors["predicted_error_s"]).max(),
    }
