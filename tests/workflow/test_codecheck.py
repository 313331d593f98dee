"""What an independent check and a journal are told is true of this repository."""

from __future__ import annotations

from pathlib import Path

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


def test_the_article_has_the_title_and_the_authors_of_the_metadata():
    metadata, citation = read("metadata.yaml"), read("CITATION.cff")
    source = " ".join((ROOT / "paper/paper.typ").read_text(encoding="utf-8").replace("\\", "").split())
    assert metadata["title"] in source
    assert [author["name"] for author in metadata["authors"]] == [
        author["name"] for author in citation["authors"]
    ]
    assert Path(ROOT / metadata["bibliography"]).is_file()
