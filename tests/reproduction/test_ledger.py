"""A claim gets the verdict that its rule gives on the tables as they lie; a wrong claim gets a clear line."""

import numpy as np
import pandas as pd
import pytest
import yaml

from precursors.cli import main
from precursors.reproduction.ledger.claims import ClaimError, read_claims, scenes_needed, tables_needed
from precursors.reproduction.ledger.judge import differences, judge, to_table
from precursors.reproduction.ledger.rules import RULES, VERDICTS

SLIPS = pd.DataFrame(
    {
        "onset_s": [0.5, 1.0, 2.0, 3.0],
        "load_before_N": [40.0, 60.0, 100.0, 90.0],
        "front": [1, 3, 2, 3],
        "is_global": [False, False, True, True],
        "kept": [True, True, False, False],
    }
)
TABLES = {
    "mine_slips": SLIPS,
    "yours_slips": SLIPS.assign(load_before_N=SLIPS["load_before_N"] * 2),
    "numbers": pd.DataFrame(
        {
            "scene": ["mine", "mine", "yours"],
            "quantity": ["mu", "count", "mu"],
            "value": [0.4949, 9, np.nan],
            "word": ["a", "b", "c"],
        }
    ),
    "robustness": pd.DataFrame(
        {"scene": ["mine", "yours"], "quantity": ["mu", "mu"], "class": ["robust", "fragile"]}
    ),
}
COLUMN = {"table": "mine_slips", "column": "load_before_N"}


@pytest.fixture
def tables(tmp_path):
    for name, table in TABLES.items():
        table.to_csv(tmp_path / f"{name}.csv", index=False)
    return tmp_path


def claim(**keys):
    return {"id": "it", "where": "Sect. 5", "kind": "result", "statement": "So it is.", **keys}


def write(directory, *claims):
    path = directory / "claims.yaml"
    path.write_text(yaml.safe_dump(list(claims)), encoding="utf-8")
    return path


def judged(directory, **keys):
    [judgement] = judge(read_claims(write(directory, claim(**keys))), directory)
    return judgement


@pytest.mark.parametrize(
    ("evidence", "ours"),
    [
        ({}, "40; 60; 100; 90"),
        ({"take": "first"}, "40"),
        ({"take": "last"}, "90"),
        ({"take": "smallest"}, "40"),
        ({"take": "largest"}, "100"),
        ({"take": "mean"}, "72.5"),
        ({"take": "sum"}, "290"),
        ({"take": "count"}, "4"),
        ({"rows": "up to the global slip"}, "40; 60; 100"),
        ({"rows": "before the global slip"}, "40; 60"),
        ({"where": {"kept": False}}, "100; 90"),
        ({"where": {"kept": False}, "rows": "up to the global slip"}, "100"),
        ({"where": {"front": 3, "is_global": True}}, "90"),
        ({"over": "onset_s"}, "80; 60; 50; 30"),
        ({"minus": "front"}, "39; 57; 98; 87"),
        ({"take": "slope", "by": "onset_s", "rows": "before the global slip"}, "40"),
        ({"take": "rank correlation"}, "0.6667"),
        ({"take": "variation of steps", "column": "onset_s", "rows": "up to the global slip"}, "0.3333"),
        ({"table": "{scene}_slips", "scenes": ["mine", "yours"], "take": "first"}, "40; 80"),
        ({"table": "{scene}_slips", "scenes": ["mine", "yours"], "column": "onset_s", "take": "last"}, "3"),
        ({"table": "{scene}_slips", "scenes": ["mine", "yours"]}, "8 values from 40 to 200"),
        ({"column": "front", "minus": "front", "table": "{scene}_slips", "scenes": ["mine", "yours"]},
         "8 values of 0"),
    ],
)  # fmt: skip
def test_evidence_is_taken_from_rows_and_columns_as_it_says(tables, evidence, ours):
    assert judged(tables, rule="holds", evidence={**COLUMN, **evidence}).ours == ours


@pytest.mark.parametrize(
    ("keys", "verdict"),
    [
        ({"rule": "equal", "paper": 40}, "reproduced"),
        ({"rule": "equal", "paper": 41}, "not reproduced"),
        ({"rule": "equal", "paper": 41, "tolerance": 1}, "reproduced"),
        ({"rule": "equal", "paper": 50, "relative": 0.2}, "reproduced"),
        ({"rule": "equal", "paper": 51, "relative": 0.2}, "not reproduced"),
        ({"rule": "rounds to", "paper": 40.4, "digits": 0}, "reproduced"),
        ({"rule": "rounds to", "paper": 39.4, "digits": 0}, "not reproduced"),
        ({"rule": "rounds to", "paper": 40.4, "digits": 1}, "not reproduced"),
        ({"rule": "above", "limit": 39}, "reproduced"),
        ({"rule": "above", "limit": 40}, "not reproduced"),
        ({"rule": "at least", "limit": 40}, "reproduced"),
        ({"rule": "at least", "limit": 41}, "not reproduced"),
        ({"rule": "below", "limit": 41}, "reproduced"),
        ({"rule": "below", "limit": 40}, "not reproduced"),
        ({"rule": "at most", "limit": 40}, "reproduced"),
        ({"rule": "at most", "limit": 39}, "not reproduced"),
        ({"rule": "as printed", "against": {**COLUMN, "take": "first"}}, "reproduced"),
        ({"rule": "as printed", "against": {**COLUMN, "take": "last"}}, "misprint"),
    ],
)
def test_a_rule_that_compares_gives_its_verdict(tables, keys, verdict):
    assert judged(tables, evidence={**COLUMN, "take": "first"}, **keys).verdict == verdict


@pytest.mark.parametrize(
    ("keys", "column", "rows", "verdict"),
    [
        ({"rule": "increasing"}, "load_before_N", "up to the global slip", "reproduced"),
        ({"rule": "increasing"}, "load_before_N", "all", "not reproduced"),
        ({"rule": "increasing"}, "front", "all", "not reproduced"),
        ({"rule": "increasing"}, "is_global", "all", "not reproduced"),
        ({"rule": "decreasing"}, "load_before_N", "all", "not reproduced"),
        ({"rule": "same", "tolerance": 20}, "load_before_N", "before the global slip", "reproduced"),
        ({"rule": "same", "tolerance": 19}, "load_before_N", "before the global slip", "not reproduced"),
        ({"rule": "holds"}, "kept", "before the global slip", "reproduced"),
        ({"rule": "holds"}, "kept", "all", "not reproduced"),
    ],
)
def test_a_rule_about_a_series_gives_its_verdict(tables, keys, column, rows, verdict):
    evidence = {"table": "mine_slips", "column": column, "rows": rows}
    assert judged(tables, evidence=evidence, **keys).verdict == verdict


def test_every_verdict_can_be_reached_and_no_other():
    reached = {rule.otherwise for rule in RULES.values()} | {"reproduced", "reproduced but fragile"}
    assert reached == set(VERDICTS)


def test_a_claim_is_fragile_if_one_of_its_numbers_is(tables):
    keys = {"rule": "above", "limit": 0, "evidence": COLUMN}
    one, both = ({"scenes": scenes, "quantity": "mu"} for scenes in ("mine", ["mine", "yours"]))
    assert judged(tables, fragile=one, **keys).verdict == "reproduced"
    assert judged(tables, fragile=both, **keys).verdict == "reproduced but fragile"
    assert judged(tables, fragile=both, **{**keys, "limit": 99}).verdict == "not reproduced"


@pytest.mark.parametrize("where", [{"scene": "yours", "quantity": "mu"}, {"word": "c"}])
def test_what_has_no_value_is_not_reproduced(tables, where):
    evidence = {"table": "numbers", "column": "value", "where": where}
    assert judged(tables, rule="below", limit=1e9, evidence=evidence).verdict == "not reproduced"


@pytest.mark.parametrize(("take", "ours"), [("each", "none"), ("first", "nan"), ("largest", "nan")])
def test_what_has_no_row_is_not_reproduced(tables, take, ours):
    evidence = {**COLUMN, "where": {"is_global": True, "kept": True}, "take": take}
    for keys in ({"limit": 1e9}, {"against": COLUMN}):
        judgement = judged(tables, rule="below", evidence=evidence, **keys)
        assert (judgement.ours, judgement.verdict) == (ours, "not reproduced")


def test_a_claim_is_not_testable_only_as_long_as_no_table_speaks_of_it(tables):
    keys = {"rule": "no result", "words": ["intensity"]}
    judgement = judged(tables, **keys)
    assert (judgement.verdict, judgement.ours) == ("not testable by the model", "not in the model")
    (tables / "camera.csv").write_text("time_s,total_intensity\n", encoding="utf-8")
    with pytest.raises(ClaimError, match=r"claim it: there is a result now \(camera.csv: total_intensity\)"):
        judged(tables, **keys)
    (tables / "camera.csv").write_text("quantity\nIntensity of light\n", encoding="utf-8")
    with pytest.raises(ClaimError, match=r"camera.csv: Intensity of light"):
        judged(tables, **keys)


GOOD = {"rule": "above", "limit": 0, "evidence": COLUMN}


@pytest.mark.parametrize(
    ("keys", "complaint"),
    [
        ({"rule": "__import__('os')"}, "rule = .* allowed are equal, "),
        ({"rule": ["equal"]}, "rule = .* allowed is a text"),
        ({"kind": "opinion"}, "kind = 'opinion': allowed are input, result, reading, experiment"),
        ({"verdict": "reproduced"}, "'verdict' is an unknown key: allowed are id, "),
        ({"limit": "0"}, "limit = '0': allowed is a number"),
        ({"limit": True}, "limit = True: allowed is a number"),
        ({"tolerance": -1}, "tolerance = -1: allowed is a number, not negative"),
        ({"digits": 2}, "digits: needed with rule: rounds to"),
        ({"rule": "rounds to", "digits": 1.5}, "digits: needed with rule: rounds to as a whole number"),
        ({"varies": 1}, "varies = 1: allowed are true and false"),
        ({"words": ["light"]}, "needs evidence, and allows no words"),
        ({"rule": "no result", "words": ["light"]}, "allows no evidence"),
        ({"evidence": []}, "needs evidence"),
        ({"evidence": "front"}, "evidence = 'front': allowed are tables"),
        ({"evidence": {"table": "mine_slips"}}, "column is missing"),
        ({"evidence": {**COLUMN, "take": "eval"}}, "evidence.take = 'eval': allowed are each, "),
        ({"evidence": {**COLUMN, "rows": "some"}}, "evidence.rows = 'some': allowed are all, "),
        ({"evidence": {**COLUMN, "take": "slope"}}, "evidence.by: needed with take: slope"),
        ({"evidence": {**COLUMN, "column": 1}}, "evidence.column = 1: allowed is a name"),
        ({"evidence": {**COLUMN, "where": "front"}}, "evidence.where = 'front': allowed are columns"),
        ({"rule": "equal", "limit": None}, "limit = None: allowed is a number"),
        ({"fragile": {"scenes": "mine"}}, "quantity is missing"),
        ({"evidence": {**COLUMN, "table": "theirs"}}, "theirs.csv is missing"),
        ({"evidence": {**COLUMN, "column": "lode"}}, "mine_slips.csv has no column 'lode': it has onset_s, "),
        ({"evidence": {"table": "numbers", "column": "word"}}, "numbers.csv, column word: 'a' is no number"),
        ({"evidence": {**COLUMN, "table": "numbers", "column": "value", "rows": "up to the global slip"}},
         "numbers.csv has no column 'is_global'"),
        ({"paper": [1, 2], "limit": None, "rule": "equal"}, "limit"),
        ({"fragile": {"scenes": "theirs", "quantity": "mu"}}, "robustness.csv has no row for mu of theirs"),
        ({"against": {**COLUMN, "rows": "before the global slip"}}, "4 values are compared with 2"),
    ],
)  # fmt: skip
def test_a_wrong_claim_gets_one_line_that_names_it(tables, keys, complaint):
    with pytest.raises(ClaimError, match=complaint) as error:
        judged(tables, **{**GOOD, **keys})
    assert "claim it: " in str(error.value)
    assert "\n" not in str(error.value)


def test_a_rule_without_anything_to_compare_with_is_refused(tables):
    with pytest.raises(ClaimError, match="rule: equal needs against, limit or numbers of the paper"):
        judged(tables, rule="equal", evidence=COLUMN, paper="a lot")


@pytest.mark.parametrize("text", ["{", "claim: 1", "- 7", "[[1]]", "- {id: a, id: b}", "\0"])
def test_a_file_that_is_no_list_of_claims_is_refused_in_one_line(tmp_path, text):
    path = tmp_path / "claims.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(
        ClaimError, match=r"claims.yaml: (not valid YAML|the key 'id' stands twice|allowed is a list)"
    ) as error:
        read_claims(path)
    assert "\n" not in str(error.value)


def test_claims_are_read_the_same_without_the_compiled_loader(tmp_path, tables, monkeypatch):
    path = write(tables, claim(**GOOD))
    compiled = read_claims(path)
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    assert read_claims(path) == compiled
    for text in ("{", "\0", "- {id: a, id: b}", "[" * 20):
        (tmp_path / "odd.yaml").write_text(text, encoding="utf-8")
        with pytest.raises(ClaimError, match=r"odd.yaml: "):
            read_claims(tmp_path / "odd.yaml")


def test_an_id_stands_once(tables):
    with pytest.raises(ClaimError, match="claim it: the id stands twice"):
        read_claims(write(tables, claim(**GOOD), claim(**GOOD)))


def test_a_table_that_is_none_is_named(tables):
    (tables / "mine_slips.csv").write_bytes(b"")
    with pytest.raises(ClaimError, match=r"mine_slips\.csv is no table"):
        judged(tables, **GOOD)


def test_tables_and_scenes_that_are_needed_follow_from_the_claims(tables):
    other = claim(rule="above", against=COLUMN, evidence={"table": "numbers", "column": "value"}) | {
        "id": "other"
    }
    fragile = {"scenes": "mine", "quantity": "mu"}
    claims = read_claims(write(tables, claim(**GOOD, fragile=fragile), other))
    assert tables_needed(claims) == ["mine_slips", "numbers", "robustness"]
    assert scenes_needed(claims) == ["mine"]


def test_differences_name_the_claim_and_both_verdicts(tables):
    found = to_table([judged(tables, **GOOD)])
    assert differences(found, found) == []
    [line] = differences(found, found.assign(verdict="misprint"))
    assert line == "it: verdict is 'reproduced', expected 'misprint'"
    assert differences(found, found.assign(ours="41")) == ["it: ours is '40; 60; 100; 90', expected '41'"]
    other_processor = found.assign(ours="41", varies="True")
    assert differences(other_processor, found) == []
    assert len(differences(other_processor, found, same_processor=True)) == 1
    assert len(differences(found.assign(verdict="misprint", varies="True"), found)) == 1
    assert differences(found.assign(id="new"), found) == [
        "new: not among the expected claims",
        "it: is missing",
    ]


def test_the_ledger_is_printed_and_compared_with_two_files(tables, capsys):
    path = write(tables, claim(**GOOD, unit="N", paper="some load"))
    to_table(judge(read_claims(path), tables)).to_csv(tables / "claims.csv", index=False)
    golden = tables / "golden"
    golden.write_bytes((tables / "claims.csv").read_bytes())
    check = ["check", "--full", "--claims", str(path), "--tables", str(tables), "--expected", str(golden)]
    assert main(check) == 0
    printed = capsys.readouterr().out
    assert "1  REPRODUCED  [it]  Sect. 5\n    So it is.\n" in printed
    assert "paper: some load   ours: 40; 60; 100; 90 N   (above 0)" in printed
    assert "1 claims: 1 reproduced\n" in printed
    assert "1 of kind result (what the model or the theory gives): 1 reproduced\n" in printed
    assert "0 of kind input (that the chain computed here is the one described): none\n" in printed

    SLIPS.assign(load_before_N=-1.0).to_csv(tables / "mine_slips.csv", index=False)
    assert main(check) == 1
    printed, complaints = capsys.readouterr()
    assert "NOT REPRODUCED  [it]" in printed
    for file in (golden, tables / "claims.csv"):
        assert f"it: verdict is 'not reproduced', expected 'reproduced' ({file})" in complaints
