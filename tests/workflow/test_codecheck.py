"""What an independent check compares is made and kept."""

from pathlib import Path

import yaml
from places import GOLDEN, ROOT


def test_every_file_that_an_independent_check_compares_is_made_by_the_workflow_and_kept(
    untouched,
):
    text = (ROOT / "codecheck.yml").read_text(encoding="utf-8")
    manifest = yaml.safe_load(text)["manifest"]
    files = {entry["file"] for entry in manifest if entry["comment"]}
    assert len(files) == len(manifest) > 10
    assert files <= untouched[1].made
    kept = {path.name for path in GOLDEN.iterdir()}
    assert {Path(file).name for file in files} <= kept
