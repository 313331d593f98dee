"""The reference problems: page, lists and table of results say the same as the
proofs."""

import csv
import hashlib
import io
import json
import subprocess
import sys
import zipfile
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from golden.benchmark_page import PAGE, PROBLEMS, results_table
from places import ROOT, made
from workflow_copy import copy_workflow

from precursors import find_slips
from precursors.benchmark.score import problems, score, solution
from precursors.proof import Certificate, ExactChain

TEXT = PAGE.read_text(encoding="utf-8")
SCRIPTS = sorted((ROOT / "benchmarks/solvers").glob("[!c]*.py"))
# The scripts solve `slippery` up to here [s]: within its first global slip, where blocks
# slide backward, and where a stop between mu_k w and mu_s w tells the switching rule.
SHORT = "768/10000"


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    """The archive that the rule writes, by name of the file."""
    workspace = copy_workflow(tmp_path_factory.mktemp("benchmark") / "copy")
    outcome = workspace.run("-c1", "results/benchmark.zip")
    assert outcome.code == 0, outcome.text
    path = workspace.path / "results/benchmark.zip"
    with zipfile.ZipFile(path) as file:
        found = {name: file.read(name) for name in file.namelist()}
    for name, content in found.items():
        assert (workspace.path / "results" / name).read_bytes() == content
    return {name.removeprefix("benchmark/"): text for name, text in found.items()}


@pytest.mark.parametrize("problem", PROBLEMS)
def test_a_problem_and_its_list_are_those_of_the_certificate_digit_for_digit(
    archive, problem
):
    proved = Certificate.load(problems()[problem])
    given = json.loads(archive[f"{problem}/problem.json"])
    assert given.pop("problem") == problem
    assert Fraction(given.pop("duration")) == proved.duration
    assert ExactChain(**given, length=proved.chain.length) == proved.chain
    rows = csv.DictReader(io.StringIO(archive[f"{problem}/transitions.csv"].decode()))
    for row, true in zip(rows, proved.transitions, strict=True):
        assert Fraction(row["time_s"]) == true.time.midpoint
        assert Fraction(row["time_radius_s"]) == true.time.radius
        assert (int(row["block"]), int(row["mode"])) == (true.block, true.mode)
        load = true.tangential_load
        assert Fraction(row["tangential_load_N"]) == load.midpoint
        assert Fraction(row["tangential_load_radius_N"]) == load.radius


def test_the_data_package_has_every_file_with_its_checksum_and_columns(archive):
    package = json.loads(archive["datapackage.json"])
    found = {resource["path"]: resource for resource in package["resources"]}
    texts = {"datapackage.json", "README.md", "LICENSE-text"}
    assert found.keys() == archive.keys() - texts
    for path, resource in found.items():
        digest = hashlib.sha256(archive[path]).hexdigest()
        assert resource["hash"] == f"sha256:{digest}"
        if path.endswith(".csv"):
            header = archive[path].decode().splitlines()[0].split(",")
            fields = resource["schema"]["fields"]
            assert [field["name"] for field in fields] == header


def test_the_page_states_the_problems_that_are_proved():
    table = TEXT[TEXT.index("| problem | N |") :].split("\n\n")[0].splitlines()[2:]
    assert [cells(line)[0] for line in table] == list(PROBLEMS)
    assert set(PROBLEMS) == set(problems())
    for name, n, theta, mu_k, drive, speed, duration, *told in map(cells, table):
        proved = Certificate.load(problems()[name])
        chain = ExactChain.from_slider(
            int(n),
            theta=theta,
            mu_k=mu_k,
            drive_stiffness=drive,
            drive_velocity=speed,
        )
        assert chain == proved.chain
        assert Fraction(duration) == proved.duration
        times = [t.time.midpoint for t in proved.transitions]
        closest = min(b - a for a, b in pairwise(times))
        shown = [
            len(times),
            len(find_slips(solution(name).run)),
            f"{float(f'{float(closest) * 1e9:.2g}'):g}",
        ]
        assert told == list(map(str, shown))


def test_the_page_shows_the_scores_of_all_results():
    scores = made("benchmark")
    assert results_table(scores) in TEXT
    files = {path.stem for path in (ROOT / "benchmarks/results").iterdir()}
    assert files == set(scores["solver"] + "-" + scores["problem"])


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_solver_of_others_solves_the_beginning_without_this_library(
    archive, tmp_path, script
):
    for name, package in (("heyoka", "heyoka"), ("sundials", "sksundae")):
        if script.stem.startswith(name):
            pytest.importorskip(package)
    problem = json.loads(archive["slippery/problem.json"]) | {"duration": SHORT}
    (tmp_path / "problem.json").write_text(json.dumps(problem), encoding="utf-8")
    program = (
        "import runpy, sys; sys.modules['precursors'] = None; sys.argv = sys.argv[1:]; "
        "sys.path.insert(0, sys.argv[0].rpartition('/')[0]); "
        "runpy.run_path(sys.argv[0], run_name='__main__')"
    )
    command = [sys.executable, "-c", program, script, "problem.json", "mine.csv"]
    subprocess.run(command, cwd=tmp_path, check=True)
    found = score(tmp_path / "mine.csv", "slippery")
    times = solution("slippery").run.transitions["time"]
    assert found["transitions_right"] == np.sum(times < float(Fraction(SHORT)))
    assert found["transitions_right"] > 50
    assert found["first_wrong"] == "none"
    assert found["time_error_s"] < 1e-12
