"""The check of the claims reports changed verdicts and changed files."""

import json
import os
import re
import shutil

import check_claims
import pytest
from places import RESULTS, made

from maegawa2010.paper.inputs import CLAIM_TABLES


def test_the_check_prints_all_claims_and_fails_on_a_new_verdict(tmp_path, capsys):
    check_claims.main(RESULTS)
    text = capsys.readouterr().out
    claims = made("claims").to_dict("records")
    for claim, block in zip(claims, text.split("\n    [")[1:], strict=True):
        assert block.startswith(f"{claim['claim']}]  {claim['section']}\n")
        words = " ".join(block.split())
        assert f"{claim['verdict_text'].upper()}: found {claim['ours']}" in words
        if claim["noise_share"] > 0:
            assert f"Agree: {100 * claim['noise_share']:.0f} % of the runs" in words
    *_, one, two, three, _, checked = text.splitlines()
    totals = [re.findall(r"\d+", line) for line in (one, two, three)]
    assert re.fullmatch(r"\d+ numbers of 8 committed tables .* all agree", checked)
    assert sum(int(total) for total, *_ in totals) == len(claims)
    for total, *verdicts in totals:
        assert sum(map(int, verdicts)) == int(total)
        assert "0" not in verdicts
    with pytest.raises(SystemExit, match=r"_slips\.csv is missing: run make all"):
        check_claims.main(tmp_path)
    (tmp_path / "tables").mkdir()
    for name in CLAIM_TABLES:
        shutil.copy(RESULTS / f"tables/{name}.csv", tmp_path / "tables")
    lyapunov = made("lyapunov")
    lyapunov.assign(exponent_per_s=-lyapunov["exponent_per_s"]).to_csv(
        tmp_path / "tables/lyapunov.csv", index=False
    )
    with pytest.raises(SystemExit, match="check: chaos: is fails, expected holds"):
        check_claims.main(tmp_path)


@pytest.fixture
def copy(tmp_path):
    """A copy of the tables and of a figure, with their provenance."""
    shutil.copytree(RESULTS / "tables", tmp_path / "tables")
    (tmp_path / "figures").mkdir()
    shutil.copy2(RESULTS / "figures/fig10.svg", tmp_path / "figures")
    shutil.copy2(RESULTS / "provenance.json", tmp_path)
    return tmp_path


def test_the_check_names_a_changed_table_even_if_its_time_is_old(copy):
    check_claims.main(copy)
    table = copy / "tables/measures.csv"
    times = table.stat().st_atime_ns, table.stat().st_mtime_ns
    for has_old_time in (True, False):
        with table.open("a") as file:
            file.write("edited\n")
        if has_old_time:
            os.utime(table, ns=times)
        with pytest.raises(SystemExit) as error:
            check_claims.main(copy)
        line = (
            f"check: {table} has changed since it was made: delete it and run make all"
        )
        assert str(error.value) == line


def test_a_newer_figure_is_reported_and_an_older_one_fails(copy, capsys):
    figure = copy / "figures/fig10.svg"
    figure.write_text("<svg/>")
    check_claims.main(copy)
    *_, last = capsys.readouterr().out.splitlines()
    assert last == "figures/fig10.svg is newer than provenance.json: run make all"
    (copy / "provenance.json").touch()
    with pytest.raises(
        SystemExit, match=r"fig10\.svg has changed since it was made: delete"
    ):
        check_claims.main(copy)


def test_results_of_another_slider_are_not_compared(tmp_path):
    made = json.loads((RESULTS / "provenance.json").read_text())
    made["config"]["chain"]["mu_k"] = 0.46
    (tmp_path / "provenance.json").write_text(json.dumps(made))
    with pytest.raises(SystemExit, match="is not the paper's: nothing to compare"):
        check_claims.main(tmp_path)
