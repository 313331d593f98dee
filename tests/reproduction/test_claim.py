"""A claim gets the verdict that the run and the ensembles around it give."""

import pandas as pd
import pytest

from precursors.reproduction.claim import (
    CHOSE,
    DOES_NOT_HOLD,
    EXACT,
    HOLDS,
    KINDS,
    RESULT,
    UNDECIDED,
    Claim,
    Finding,
    Share,
    in_draws,
    shown,
)
from precursors.reproduction.claims import (
    CLAIMS,
    count_grows_with_theta,
    differences,
    evaluate,
    friction_independent_of_loading,
    growth,
)
from precursors.reproduction.open_points import open_points_table
from precursors.reproduction.tables import Tables, one

NAN = float("nan")


@pytest.mark.parametrize(
    ("holds", "noise", "digits", "verdict"),
    [
        (True, 1000, 400, HOLDS),
        (True, 1000, 390, HOLDS),  # at least 95.4 %
        (True, 1000, 385, UNDECIDED),  # 93.8 to 97.9 %
        (True, 1000, 375, UNDECIDED),  # 91.1 to 95.9 %
        (True, 1000, 365, EXACT),  # at most 93.7 %
        (True, 930, 400, EXACT),
        (True, 0, 365, EXACT),
        (True, 930, 385, EXACT),  # one ensemble is enough
        (False, 1000, 400, DOES_NOT_HOLD),
        (None, 1000, 400, UNDECIDED),
    ],
)
def test_the_run_decides_whether_a_claim_holds_and_the_ensembles_for_which_inputs(
    holds, noise, digits, verdict
):
    shares = (("noise", Share(noise, 1000)), ("digits", Share(digits, 400)))
    assert Finding(1.0, holds, shares=shares).verdict == verdict
    assert Finding(1.0, holds).verdict == {True: HOLDS, False: DOES_NOT_HOLD, None: UNDECIDED}[holds]


def ensemble(*values: float) -> pd.DataFrame:
    """Members of one scene; the first value is the run's."""
    return pd.DataFrame({"scene": "s", "draw": range(len(values)), "mu_sapp": values})


def found(noise: pd.DataFrame, digits: pd.DataFrame) -> Finding:
    tables = Tables("nowhere")
    tables.update(noise_members=noise, digits_members=digits)
    return in_draws(tables, lambda runs: runs["mu_sapp"], lambda friction: friction < 0.5)


def test_draws_are_counted_without_the_run_and_without_a_global_slip_a_claim_does_not_hold():
    finding = found(ensemble(0.4, 0.4, 0.6), ensemble(0.4, 0.4, 0.4, NAN))
    assert finding.holds
    assert finding.shares == (("noise", Share(1, 2)), ("digits", Share(2, 3)))
    assert not found(ensemble(NAN, 0.4), ensemble(NAN, 0.4)).holds


@pytest.mark.parametrize(
    ("verdicts", "verdict"),
    [
        (["same", "same", "same"], HOLDS),
        (["same", "different", "undecided"], DOES_NOT_HOLD),
        (["same", "undecided", "same"], UNDECIDED),
        ([], DOES_NOT_HOLD),
    ],
)
def test_mu_sapp_is_the_same_if_the_interval_of_every_difference_says_so(verdicts, verdict):
    differences = pd.DataFrame({"quantity": "mu_sapp", "difference": 0.0, "verdict": verdicts})
    assert (
        friction_independent_of_loading(Tables("nowhere") | {"noise_differences": differences}).verdict
        == verdict
    )


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [(3, 3, HOLDS), (0, 3, UNDECIDED), (0, 0, DOES_NOT_HOLD), (-2, -1, DOES_NOT_HOLD)],
)
def test_count_grows_with_theta_if_the_interval_of_every_difference_is_above_zero(low, high, verdict):
    counts = {"fig11": 6, "fig10": 9, "fig12": 14}
    members = pd.DataFrame(
        [
            {"draw": draw, "scene": scene, "events_counted": count}
            for draw in range(401)
            for scene, count in counts.items()
        ]
    )
    pairs = [("fig10", "fig11", 1, 1), ("fig12", "fig10", low, high)]
    medians = pd.DataFrame(pairs, columns=["scene", "other", "low", "high"])
    tables = {"noise_differences": medians.assign(quantity="events_counted")}
    assert (
        count_grows_with_theta(tables | dict.fromkeys(("noise_members", "digits_members"), members)).verdict
        == verdict
    )


def test_the_length_grows_at_two_rates_before_and_after_seven_tenths():
    """From 0.2 to 0.6 in 20 N, and from there to the first event of the whole length in 5 N."""
    loads, fronts = [0.0, 15.0, 20.0, 22.0, 25.0, 90.0], [2, 5, 6, 8, 10, 10]
    slips = pd.DataFrame({"counted": True, "front": fronts, "n_blocks": 10, "load_before_N": loads})
    assert growth(slips) == pytest.approx((0.02, 0.08))


@pytest.mark.parametrize(
    ("values", "text"),
    [([], ""), (6, "6"), ([6, 6, 6], "6"), ([0.48445, 0.5], "0.4844; 0.5"), (NAN, "nan")],
)
def test_values_are_shown_with_four_digits(values, text):
    assert shown(values) == text


def test_every_claim_says_what_it_states_and_where_and_has_a_name_of_its_own():
    assert len({claim.name for claim in CLAIMS}) == len(CLAIMS) == 25
    assert sum(claim.kind == CHOSE for claim in CLAIMS) == 6
    assert all(claim.section and claim.statement and claim.rule and claim.kind in KINDS for claim in CLAIMS)


def test_a_run_without_the_event_of_a_claim_contradicts_it():
    def no_event(tables):
        raise IndexError

    assert (
        Claim("a", "Sect. 1", RESULT, "", "", "1", no_event).row(Tables("nowhere"))["verdict"]
        == DOES_NOT_HOLD
    )


def test_a_missing_table_column_or_row_is_one_clear_line(tmp_path):
    for table in (evaluate, open_points_table):
        with pytest.raises(FileNotFoundError, match=r"\.csv is missing: the workflow writes it"):
            table(Tables(tmp_path))
    (tmp_path / "noise_members.csv").write_text("scene,draw\nfig10,0\n")
    with pytest.raises(ValueError, match=r"^claim count-trailing: the tables do not have its numbers"):
        evaluate(Tables(tmp_path))
    with pytest.raises(IndexError, match="0 rows have scene = fig11: needed is one"):
        one(Tables(tmp_path)["noise_members"], "draw", scene="fig11")


def test_differences_are_claims_that_are_new_gone_or_of_another_verdict():
    def table(**verdicts):
        return pd.DataFrame(verdicts.items(), columns=["claim", "verdict"])

    found, expected = table(a=HOLDS, b=HOLDS, c=EXACT), table(a=HOLDS, b=EXACT, d=EXACT)
    assert differences(found, expected) == [
        "c: is not among the expected claims",
        "d: is missing",
        "b: is 'holds', expected 'holds for exactly these inputs'",
    ]
