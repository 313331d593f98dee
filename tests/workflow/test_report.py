"""The report has every figure with a caption, and the main tables of the workflow."""

import json
import re


def results_in(report):
    """The results in the report, by path."""
    text = report.read_text(encoding="utf-8")
    (results,) = re.findall(r"^    var results = (\{.*\});$", text, flags=re.MULTILINE)
    return json.loads(results)


def test_the_report_has_all_figures_with_captions_and_the_tables(
    finished,
):
    style = "workflow/report/report.css"
    outcome = finished.run(
        "--report", "report.html", "--report-stylesheet", style, "--", "all"
    )
    assert outcome.code == 0, outcome.text
    results = results_in(finished.path / "report.html")
    assert {"results/tables/reproduction.csv", "results/tables/fig10_slips.csv"} <= set(
        results
    )
    figures = {
        str(file.relative_to(finished.path))
        for file in finished.path.glob("results/figures/*.svg")
    }
    assert len(figures) > 10
    for path in figures:
        result = results[path]
        words = re.sub("<[^>]+>", " ", result["caption"]).split()
        assert len(words) >= 10, path
        assert "{{" not in result["caption"], path
        # Snakemake makes a switch of a second label with two values, and its page then
        # stays empty.
        assert len(result["labels"]) == 1, path
    labels = {tuple(results[path]["labels"].items()) for path in figures}
    assert len(labels) == len(figures)
