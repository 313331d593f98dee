"""The report shows every figure, with a caption of its own, and the main tables of the
workflow."""

import json
import re
from collections import Counter

from conftest import ROOT


def results_in(report):
    """What the report holds, by path."""
    text = report.read_text(encoding="utf-8")
    (found,) = re.findall(r"^    var results = (\{.*\});$", text, flags=re.MULTILINE)
    return json.loads(found)


def test_every_figure_has_a_caption_and_a_label_of_its_own_and_the_main_tables_are_there(
    finished,
):
    style = "workflow/report/report.css"
    assert f"--report-stylesheet {style}" in (ROOT / "Makefile").read_text(
        encoding="utf-8"
    )
    outcome = finished.run(
        "--report", "report.html", "--report-stylesheet", style, "--", "all"
    )
    assert outcome.code == 0, outcome.text
    results = results_in(finished.path / "report.html")
    assert {"results/tables/reproduction.csv", "results/tables/fig10_slips.csv"} <= set(
        results
    )
    results = {
        path: result for path, result in results.items() if path.endswith(".svg")
    }
    figures = {
        str(file.relative_to(finished.path))
        for file in finished.path.glob("results/figures/*.svg")
    }
    assert len(figures) > 10
    assert set(results) == figures
    for path, result in results.items():
        words = re.sub("<[^>]+>", " ", result["caption"]).split()
        assert len(words) >= 10, path
        assert "{{" not in result["caption"], path
        # A second label with two values would be taken for a switch, and Snakemake's
        # page would stay white.
        assert len(result["labels"]) == 1, path
    labels = Counter(tuple(result["labels"].items()) for result in results.values())
    assert max(labels.values()) == 1
