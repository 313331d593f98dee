"""Provenance comes after all other results and has their checksums."""

import hashlib
import json


def test_all_ends_with_the_provenance_of_all_results(finished):
    outcome = finished.run("-n", "-F", "all")
    (job,) = [
        part for part in outcome.text.split("\nrule ") if "\n    output: results/provenance.json" in part
    ]
    needed = job.split("\n    input: ")[1].split("\n")[0].split(", ")
    figures = sorted((finished.path / "results/figures").glob("*.svg"))
    assert len(figures) > 20
    assert {f"results/figures/{figure.name}" for figure in figures} <= set(needed)


def test_the_provenance_has_checksums_of_what_lies_there_and_follows_an_edit(finished):
    outcome = finished.run("-c1", "--force", "results/provenance.json")
    assert outcome.code == 0, outcome.text
    provenance = json.loads((finished.path / "results/provenance.json").read_text(encoding="utf-8"))
    assert {"figures/fig13.svg", "runs/fig10.h5", "tables/fig10_slips.csv"} <= set(provenance["outputs"])
    for name in ("figures/fig13.svg", "runs/fig10.h5"):
        digest = hashlib.sha256((finished.path / "results" / name).read_bytes()).hexdigest()
        assert provenance["outputs"][name]["sha256"] == digest
    assert {"Snakefile", "workflow/rules/provenance.smk", "src/precursors/solver/kernel/events.py"} <= set(
        provenance["inputs"]
    )
    assert provenance["config"]["chain"]["n_blocks"] == 10

    finished.append("src/precursors/figures/precursor_lengths.py", "\nCOLOR = 'red'\n")
    assert "rule write_provenance:" in finished.run("-n", "all").text
