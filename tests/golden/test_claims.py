"""The check of the claims names a result that was falsified."""

import json
import os
import re
import shutil

import check_claims
import pytest
from places import RESULTS, made

from maegawa2010.paper.inputs import CLAIM_TABLES
from maegawa2010.support.provenance import checksums

TABLES = RESULTS / "tables"


def test_the_check_prints_every_claim_and_the_totals_and_fails_if_a_verdict_is_another(
    tmp_path, capsys
):
    check_claims.main(TABLES)
    told = capsys.readouterr().out
    claims = made("claims").to_dict("records")
    for claim, block in zip(claims, told.split("\n    [")[1:], strict=True):
        assert block.startswith(f"{claim['claim']}]  {claim['section']}\n")
        words = " ".join(block.split())
        assert f"{claim['verdict_text'].upper()}: found {claim['ours']}" in words
        if claim["noise_share"] > 0:
            assert f"Agree: {100 * claim['noise_share']:.0f} % of the runs" in words
    totals = [re.findall(r"\d+", line) for line in told.splitlines()[-3:]]
    assert sum(int(total) for total, *_ in totals) == len(claims)
    for total, *verdicts in totals:
        assert sum(map(int, verdicts)) == int(total)
        assert "0" not in verdicts
    with pytest.raises(SystemExit, match=r"_slips\.csv is missing: run make all"):
        check_claims.main(tmp_path)
    for name in CLAIM_TABLES:
        shutil.copy(TABLES / f"{name}.csv", tmp_path)
    lyapunov = made("lyapunov")
    lyapunov.assign(exponent_per_s=-lyapunov["exponent_per_s"]).to_csv(
        tmp_path / "lyapunov.csv", index=False
    )
    with pytest.raises(SystemExit, match="check: chaos: is fails, expected holds"):
        check_claims.main(tmp_path)


def test_the_check_names_a_result_that_changed_on_disk_with_its_time_kept(tmp_path):
    (tmp_path / "tables").mkdir()
    table = tmp_path / "tables/a.csv"
    table.write_text("1\n")
    told = checksums([table, tmp_path / "away"], tmp_path)
    assert check_claims.changed(tmp_path, told) == []
    times = table.stat().st_atime_ns, table.stat().st_mtime_ns
    table.write_text("2\n")
    os.utime(table, ns=times)
    assert check_claims.changed(tmp_path, told) == [
        f"{table} is not as it was made: delete it, and run make all"
    ]


def test_results_of_another_slider_are_compared_with_nothing(tmp_path):
    told = json.loads((RESULTS / "provenance.json").read_text())
    told["config"]["chain"]["mu_k"] = 0.46
    (tmp_path / "provenance.json").write_text(json.dumps(told))
    with pytest.raises(SystemExit, match="is not the paper's: nothing to compare"):
        check_claims.main(tmp_path / "tables")
