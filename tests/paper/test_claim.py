"""Verdicts on claims from the run and the ensembles around it."""

from dataclasses import replace

import pandas as pd
import pytest

from maegawa2010.paper.claim import (
    EXACT,
    FAILS,
    HOLDS,
    RESULT,
    UNDECIDED,
    Finding,
    Share,
    in_ensembles,
    judged,
)
from maegawa2010.paper.claims import (
    FINDINGS,
    count_grows_with_theta,
    differences,
    evaluate,
    friction_independent_of_loading,
    friction_independent_with_ten_blocks,
    growth_falls_with_theta,
    lengths_tend_to_increase,
    waves,
)
from maegawa2010.paper.inputs import SCENES
from maegawa2010.paper.tables import cell

NAN = float("nan")


@pytest.mark.parametrize(
    ("holds", "noise", "digits", "verdict"),
    [
        (True, 1000, 390, HOLDS),  # at least 95.4 %
        (True, 1000, 385, UNDECIDED),  # 93.8 to 97.9 %
        (True, 1000, 365, EXACT),  # at most 93.7 %
        (True, 930, 385, EXACT),  # one ensemble is enough
        (False, 1000, 400, FAILS),
        (None, 1000, 400, UNDECIDED),
    ],
)
def test_the_verdict_combines_the_run_and_both_ensembles(holds, noise, digits, verdict):
    shares = {"noise": Share(noise, 1000), "digits": Share(digits, 400)}
    assert Finding(1.0, holds, shares=shares).verdict == verdict


def test_members_are_counted_and_fail_without_a_global_slip():
    def below_half(noise: list[float], digits: list[float]) -> Finding:
        members = [
            pd.DataFrame({"scene": "s", "draw": range(len(x)), "x": x})
            for x in (noise, digits)
        ]
        tables = dict(zip(("noise_members", "digits_members"), members, strict=True))
        return in_ensembles(tables, lambda runs: runs["x"], lambda x: x < 0.5)

    finding = below_half([0.4, 0.4, 0.6], [0.4, 0.4, 0.4, NAN])
    assert finding.holds
    assert finding.shares == {"noise": Share(1, 2), "digits": Share(2, 3)}
    assert not below_half([NAN, 0.4], [NAN, 0.4]).holds


@pytest.mark.parametrize(
    ("verdicts", "verdict"),
    [
        (["same", "same", "same"], HOLDS),
        (["same", "different", "undecided"], FAILS),
        (["same", "undecided", "same"], UNDECIDED),
    ],
)
def test_mu_sapp_is_the_same_if_every_interval_says_so(verdicts, verdict):
    pairs = pd.DataFrame(
        {"quantity": "mu_sapp", "difference": 0.0, "verdict": verdicts}
    )
    tables = {"noise_differences": pairs, **members_of(mu_sapp=0.5)}
    finding = friction_independent_with_ten_blocks(tables)
    assert replace(finding, shares={}).verdict == verdict
    assert finding.note == "The values of the three runs agree: they differ by 0."
    coarse = pd.DataFrame({"n_blocks": [80], "verdict": "different", "difference": 1.0})
    by_n = pd.concat([pairs.assign(n_blocks=160), coarse])
    assert friction_independent_of_loading(
        {"resolution_differences": by_n}
    ).verdict == (verdict)


def test_three_mu_sapp_agree_to_one_unit_of_the_last_digit():
    """They differ by 0.011 in the run, and by 0.009 in the draw of each ensemble."""
    run = [0.49, 0.495, 0.501]
    draw = [0.49, 0.495, 0.499]
    members = pd.concat(
        pd.DataFrame({"scene": SCENES, "draw": i, "mu_sapp": values})
        for i, values in enumerate((run, draw))
    )
    pairs = pd.DataFrame(columns=["quantity", "difference", "verdict"])
    tables = {"noise_differences": pairs, "noise_members": members}
    tables |= {"digits_members": members}
    finding = friction_independent_with_ten_blocks(tables)
    assert finding.note.endswith("do not agree: they differ by 0.011.")
    assert [*finding.shares.values()] == [Share(1, 1)] * 2


@pytest.mark.parametrize(
    ("front", "verdict"),
    [
        ([1, 3, 2, 4, 5, 6], HOLDS),  # 0.8 and 4.2 % of all orders rise as much
        ([2, 1, 4, 3, 5, 6], UNDECIDED),  # 2.8 and 11.7 %
    ],
)
def test_lengths_increase_if_they_do_without_the_global_slip_too(front, verdict):
    assert lengths_tend_to_increase(slips_of(front=front)).verdict == verdict


@pytest.mark.parametrize(("mu_sapp", "verdict"), [(0.6951, HOLDS), (0.6949, UNDECIDED)])
def test_a_chain_without_waves_confirms_or_leaves_undecided(mu_sapp, verdict):
    assert waves(overdamped(mu_sapp)).verdict == verdict


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [(3, 3, HOLDS), (0, 3, UNDECIDED), (0, 0, FAILS)],
)
def test_the_count_grows_if_every_interval_is_above_zero(low, high, verdict):
    counts = pd.DataFrame({"scene": SCENES, "events_counted": [6, 9, 14]})
    members = counts.merge(pd.DataFrame({"draw": range(401)}), how="cross")
    pairs = [("fig10", "fig11", 1, 1), ("fig12", "fig10", low, high)]
    medians = pd.DataFrame(pairs, columns=["scene", "other", "low", "high"])
    tables = {"noise_differences": medians.assign(quantity="events_counted")}
    tables |= dict.fromkeys(("noise_members", "digits_members"), members)
    assert count_grows_with_theta(tables).verdict == verdict


@pytest.mark.parametrize(("last", "holds"), [(3.1, True), (3.0, False)])
def test_growth_falls_with_theta_if_every_loading_has_less(last, holds):
    tables = {
        f"{scene}_slips": pd.DataFrame(
            {"load_before_N": [1.0, load], "front": [1, 2], "counted": True}
        )
        for scene, load in zip(SCENES, (2.0, 3.0, last), strict=True)
    }
    assert growth_falls_with_theta(tables).holds is holds


def test_a_missing_event_contradicts_and_a_missing_number_raises():
    def no_event(_):
        raise IndexError

    row = judged({"claim": "a", "kind": RESULT}, no_event, {})
    assert row["verdict"] == FAILS
    with pytest.raises(
        ValueError, match=r"^claim count-trailing: the tables do not have its numbers"
    ):
        evaluate({"noise_members": pd.DataFrame({"scene": ["fig10"], "draw": [0]})})
    with pytest.raises(IndexError, match="0 rows have x = 1, but one must"):
        cell(pd.DataFrame({"x": [2]}), "x", x=1)


def test_a_claim_without_a_function_is_one_clear_line(monkeypatch):
    monkeypatch.delitem(FINDINGS, "waves")
    with pytest.raises(ValueError, match="claim waves has no function"):
        evaluate({})


def test_differences_are_new_missing_and_changed_claims():
    def table(**verdicts):
        return pd.DataFrame(verdicts.items(), columns=["claim", "verdict"])

    evaluated = table(a=HOLDS, b=HOLDS, c=EXACT)
    expected = table(a=HOLDS, b=EXACT, d=EXACT)
    assert differences(evaluated, expected) == [
        "b: is holds, expected exact",
        "c: is exact, expected none",
        "d: is missing, expected exact",
    ]


def slips_of(**columns) -> dict[str, pd.DataFrame]:
    """The same slip table for each scene; by default the last event is global."""
    table = pd.DataFrame(columns)
    if "is_global" not in table:
        table["is_global"] = table.index == len(table) - 1
    return {
        f"{scene}_slips": table.assign(counted=True, n_blocks=10) for scene in SCENES
    }


def members_of(**columns) -> dict[str, pd.DataFrame]:
    """The run and one draw of each ensemble, the same in each scene."""
    runs = pd.DataFrame(
        [
            {"scene": scene, "draw": draw, **columns}
            for scene in SCENES
            for draw in (0, 1)
        ]
    )
    return dict.fromkeys(("noise_members", "digits_members"), runs)


def times(spread: float, *is_global: bool) -> dict[str, pd.DataFrame]:
    """Events whose intervals have this standard deviation over their mean."""
    onset = [0.0, 1.0 - spread, 2.0, 9.0][: len(is_global)]
    return slips_of(onset_s=onset, is_global=is_global)


def grown(*speedup: float) -> dict[str, pd.DataFrame]:
    """The run and one draw of each ensemble with these values of `speedup`."""
    runs = pd.DataFrame({"scene": SCENES, "speedup": speedup}).merge(
        pd.DataFrame({"draw": (0, 1)}), how="cross"
    )
    return dict.fromkeys(("noise_members", "digits_members"), runs)


def lyapunov(exponent: float) -> dict[str, pd.DataFrame]:
    columns = {
        "scene": SCENES,
        "exponent_per_s": [9.0, exponent, 9.0],
        "uncertainty_per_s": 1.0,
    }
    return {"lyapunov": pd.DataFrame(columns)}


def overdamped(mu_sapp: float) -> dict[str, pd.DataFrame]:
    columns = {
        "scene": SCENES,
        "value": [0.7, mu_sapp, 0.7],
        "model": "overdamped",
        "question": "mu_sapp",
    }
    return {"model_comparison": pd.DataFrame(columns)}


@pytest.mark.parametrize(
    ("name", "meets", "misses"),
    [
        (
            "count-leading",
            members_of(events_counted=14),
            members_of(events_counted=13),
        ),
        ("friction-uniform", members_of(mu_sapp=0.4801), members_of(mu_sapp=0.4799)),
        ("friction-uniform", members_of(mu_sapp=0.4999), members_of(mu_sapp=0.5001)),
        ("chaos", lyapunov(1.001), lyapunov(1.0)),
        ("stick-slip-is-not-periodic", times(0.051, 1, 1, 1), times(0.049, 1, 1, 1)),
        (
            "length-is-linear-in-time",
            slips_of(onset_s=[0, 1, 2, 3], front=[1.0, 1.74, 1.0, 9.0]),
            slips_of(onset_s=[0, 1, 2, 3], front=[1.0, 1.76, 1.0, 9.0]),
        ),
        (
            "friction-underestimated",
            members_of(mu_sapp=0.6949),
            members_of(mu_sapp=0.6951),
        ),
        (
            "short-events",
            members_of(events_to_global_slip=10, events_counted=9),
            members_of(events_to_global_slip=9, events_counted=9),
        ),
        (
            "precursors-in-later-periods",
            slips_of(is_global=[1, 0, 1, 1, 0, 1]),
            slips_of(is_global=[1, 0, 1, 1]),
        ),
        ("no-rapid-growth", grown(1.2, 1.0, 1.2), grown(1.2, 1.01, 1.2)),
        (
            "load-of-the-experiment",
            members_of(global_slip_load_N=209.9),
            members_of(global_slip_load_N=210.1),
        ),
        (
            "slip-duration-of-the-experiment",
            members_of(global_slip_s=1.0, global_slip_end_s=1.00151),
            members_of(global_slip_s=1.0, global_slip_end_s=1.00149),
        ),
    ],
)
def test_a_claim_holds_up_to_its_limit_and_not_beyond(name, meets, misses):
    assert FINDINGS[name](meets).holds
    assert not FINDINGS[name](misses).holds
