"""Puts the commit of the sources into the wheel, for `precursors --version`."""

import json
from pathlib import Path
from runpy import run_path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CommitHook(BuildHookInterface[Any]):
    """Writes `commit.json`: at the root of a source archive, and into the metadata of a
    wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write it where git knows the commit, or the archive has the file."""
        checkout = run_path(f"{self.root}/src/precursors/support/checkout.py")
        file = Path(self.root, checkout["COMMIT_FILE"])
        if state := checkout["git_state"](Path(self.root)):
            self.place = TemporaryDirectory()  # until the build ends
            file = Path(self.place.name, file.name)
            file.write_text(json.dumps(state), encoding="utf-8")
        if version != "editable" and file.exists():
            kind = "extra_metadata" if self.target_name == "wheel" else "force_include"
            build_data[kind][str(file)] = file.name
