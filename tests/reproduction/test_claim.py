"""A claim gets the verdict that its rule, its kind and the spread of the results give."""

import numpy as np
import pandas as pd
import pytest

from precursors.reproduction import claim as rules
from precursors.reproduction.claim import KINDS, VERDICTS, claim, shown
from precursors.reproduction.claims import CLAIMS, differences, evaluate
from precursors.reproduction.claims_discussion import growth
from precursors.reproduction.tables import Tables, one

NAN = float("nan")


@pytest.mark.parametrize(
    ("finding", "holds"),
    [
        (rules.equal([6, 6.0], paper=6), True),
        (rules.equal([6, 7], paper=6), False),
        (rules.equal([6, 9], to=[6, 9]), True),
        (rules.equal([], paper=6), False),
        (rules.equal(NAN, paper=6), False),
        (rules.equal(0.4845, paper=0.49, within=0.01), True),
        (rules.equal(0.4789, paper=0.49, within=0.01), False),
        (rules.equal(101, to=100, relative=0.01), True),
        (rules.equal(101.1, to=100, relative=0.01), False),
        (rules.rounds_to(0.485, paper=0.49, digits=2), True),
        (rules.rounds_to(0.4849, paper=0.49, digits=2), False),
        (rules.rounds_to(0.495, paper=0.49, digits=2), False),
        (rules.above([2, 3], 1), True),
        (rules.above([2, 1], 1), False),
        (rules.above([2, 3], [1, 3]), False),
        (rules.at_least([1, 2], 1), True),
        (rules.below([1, 2], 2), False),
        (rules.at_most([1, 2], 2), True),
        (rules.at_most([1, NAN], 2), False),
        (rules.increasing([1, 2, 3]), True),
        (rules.increasing([1, 2, 2]), False),
        (rules.increasing([1]), False),
        (rules.decreasing([3, 2, 1]), True),
        (rules.decreasing([3, NAN, 1]), False),
        (rules.same([0.484, 0.488], within=0.01), True),
        (rules.same([0.484, 0.498], within=0.01), False),
        (rules.instead_of(280, 280), True),
        (rules.instead_of(1127, 280), False),
        (rules.instead_of(NAN, 400), False),
        (rules.instead_of([], 10), True),
        (rules.not_computed(paper=200), None),
    ],
)
def test_a_rule_holds_or_not(finding, holds):
    assert finding.holds is holds


def test_the_length_grows_at_two_rates_before_and_after_seven_tenths():
    """From 0.2 to 0.6 in 20 N, and from there to the first event of the whole length in 5 N."""
    loads, fronts = [0.0, 15.0, 20.0, 22.0, 25.0, 90.0], [2, 5, 6, 8, 10, 10]
    slips = pd.DataFrame({"counted": True, "front": fronts, "n_blocks": 10, "load_before_N": loads})
    assert growth(slips) == pytest.approx((0.02, 0.08))


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ([], ""),
        (6, "6"),
        ([6, 6, 6], "6"),
        ([0.48445, 0.5], "0.4844; 0.5"),
        ([0] * 300, "300 values of 0"),
        (np.arange(10), "10 values from 0 to 9"),
        (NAN, "none"),
    ],
)
def test_values_are_shown_with_four_digits(values, text):
    assert shown(values) == text


def tables(fragile: str = "robust") -> Tables:
    found = Tables("nowhere")
    row = {"scene": ["s"], "quantity": ["q"], "question": ["as in the run"], "class": [fragile]}
    found["digits"] = pd.DataFrame(row)
    return found


@pytest.mark.parametrize(
    ("kind", "holds", "verdict"),
    [
        ("result", True, "reproduced"),
        ("result", False, "not reproduced"),
        ("follows from the equations", True, "follows from the equations"),
        ("follows from the equations", False, "not reproduced"),
        ("misprint", False, "misprint"),
        ("open point", False, "changes a number"),
        ("open point", True, "changes no number"),
        ("experiment", None, "not computed here"),
    ],
)
def test_the_verdict_depends_on_the_kind(kind, holds, verdict):
    made = claim("Sect. 1", kind=kind)(lambda t: rules.Finding(np.array([1.0]), holds, "", np.array([])))
    assert made.verdict(made.find(tables()), tables()) == verdict


def test_a_claim_on_a_fragile_number_is_fragile_where_it_is_reproduced():
    made = claim("Sect. 1", fragile=[("s", "q")])(lambda t: rules.equal(1, to=1))
    assert made.verdict(rules.equal(1, to=1), tables("robust")) == "reproduced"
    assert made.verdict(rules.equal(1, to=1), tables("fragile")) == "reproduced but fragile"
    assert made.verdict(rules.equal(1, to=2), tables("fragile")) == "not reproduced"


def test_every_claim_says_what_it_states_and_where_and_has_a_name_of_its_own():
    assert len({claim.id for claim in CLAIMS}) == len(CLAIMS)
    assert all(claim.where and claim.statement and claim.kind in KINDS for claim in CLAIMS)
    assert {kind.holds for kind in KINDS.values()} | {kind.fails for kind in KINDS.values()} < set(VERDICTS)


def test_a_missing_table_column_or_row_is_one_clear_line(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"measures\.csv is missing: the workflow writes it"):
        evaluate(Tables(tmp_path))
    (tmp_path / "measures.csv").write_text("scene,n_blocks\nfig10,10\n")
    with pytest.raises(ValueError, match=r"^claim parameters: the tables do not have its numbers"):
        evaluate(Tables(tmp_path))
    with pytest.raises(IndexError, match="0 rows have scene = fig11: needed is one"):
        one(Tables(tmp_path)["measures"], "n_blocks", scene="fig11")


def test_differences_are_claims_that_are_new_gone_or_of_another_verdict():
    def table(**verdicts):
        return pd.DataFrame(verdicts.items(), columns=["id", "verdict"])

    found, expected = table(a="reproduced", b="reproduced", c="x"), table(a="reproduced", b="x", d="x")
    assert differences(found, expected) == [
        "c: is not among the expected claims",
        "d: is missing",
        "b: is 'reproduced', expected 'x'",
    ]
