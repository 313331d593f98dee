"""The report shows every figure, with a caption of its own, and the main tables of the workflow."""

import json
import re
import shutil
from collections import Counter

import pytest
from conftest import ROOT, Workspace


def results_in(report):
    """What the report holds, by path."""
    text = report.read_text(encoding="utf-8")
    (found,) = re.findall(r"^    var results = (\{.*\});$", text, flags=re.MULTILINE)
    return json.loads(found)


def write_report(workspace, *targets):
    style = "workflow/report/report.css"
    assert f"--report-stylesheet {style}" in (ROOT / "Makefile").read_text(encoding="utf-8")
    outcome = workspace.run("--report", "report.html", "--report-stylesheet", style, "--", *targets)
    assert outcome.code == 0, outcome.text
    return workspace.path / "report.html"


@pytest.fixture(scope="module")
def whole(_finished, tmp_path_factory):
    """A copy of the workflow with stand-ins for all results, and the report on them."""
    workspace = Workspace(tmp_path_factory.mktemp("whole") / "copy")
    shutil.copytree(_finished.path, workspace.path)
    return workspace.path, write_report(workspace, "all")


def test_every_figure_and_the_main_tables_of_the_workflow_are_in_the_report(whole):
    path, report = whole
    results = set(results_in(report))
    figures = {file.relative_to(path).as_posix() for file in path.glob("results/figures/*.svg")}
    assert len(figures) > 10
    assert {result for result in results if result.endswith(".svg")} == figures
    assert {"results/tables/mu_sapp.csv", "results/tables/fig10_slips.csv"} <= results - figures


def test_every_figure_of_the_report_has_a_caption_and_a_label_of_its_own(whole):
    _, report = whole
    results = {path: result for path, result in results_in(report).items() if path.endswith(".svg")}
    for path, result in results.items():
        words = re.sub("<[^>]+>", " ", result["caption"]).split()
        assert len(words) >= 10, path
        assert "{{" not in result["caption"], path
        # A second label with two values would be taken for a switch, and Snakemake's page would stay white.
        assert len(result["labels"]) == 1, path
    labels = Counter(tuple(result["labels"].items()) for result in results.values())
    assert max(labels.values()) == 1
