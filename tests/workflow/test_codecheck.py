"""What an independent check and a journal are told is true of this repository."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pandas as pd
import yaml

ROOT = Path(__file__).parents[2]


def read(name: str) -> dict:
    return yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))


def test_every_file_of_the_manifest_is_made_by_the_workflow_and_kept(untouched):
    made = set().union(*(outputs for _, _, outputs in untouched[1].plan))
    files = [entry["file"] for entry in read("codecheck.yml")["manifest"]]
    assert len(files) > 10
    assert set(files) <= made
    assert all((ROOT / "tests/golden" / Path(file).name).is_file() for file in files)
    assert all(entry["comment"] for entry in read("codecheck.yml")["manifest"])


def test_a_file_that_differs_is_named(tmp_path, capsys, monkeypatch):
    (tmp_path / "results").mkdir()
    (tmp_path / "codecheck.yml").write_text("manifest: [{file: results/a.csv}, {file: results/b.csv}]")
    (tmp_path / "tests/golden").mkdir(parents=True)
    for name, value in (("a", 1.0), ("b", 2.0)):
        pd.DataFrame({"x": [value]}).to_csv(tmp_path / f"results/{name}.csv", index=False)
        pd.DataFrame({"x": [1.0]}).to_csv(tmp_path / f"tests/golden/{name}.csv", index=False)
    script = [sys.executable, ROOT / "workflow/scripts/codecheck.py"]
    done = subprocess.run(script, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1
    assert "results/a.csv: as kept" in done.stdout
    assert "results/b.csv: DataFrame.iloc" in done.stdout
    assert "1 of 2 files as kept" in done.stdout


def test_the_article_has_the_title_and_the_authors_of_the_metadata():
    metadata, citation = read("metadata.yaml"), read("CITATION.cff")
    source = " ".join((ROOT / "paper/paper.typ").read_text(encoding="utf-8").replace("\\", "").split())
    assert metadata["title"] in source
    assert [author["name"] for author in metadata["authors"]] == [
        author["name"] for author in citation["authors"]
    ]
    assert Path(ROOT / metadata["bibliography"]).is_file()
