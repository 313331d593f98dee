"""Provenance records what computed the results, with and without git."""

import json
import os
import platform
import subprocess
from importlib.metadata import version

import pytest
from places import ROOT

from maegawa2010.support.provenance import provenance
from precursors.support.checkout import git_state

# From FIPS 180-4.
SHA256_OF_ABC = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"


def test_provenance_lists_software_and_checksums(tmp_path, monkeypatch):
    for name in (
        "tables/a.csv",
        "figures/a.svg",
        "logs/a.log",
        "README.md",
        "tables/.partial.a.csv",
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("abc")
    monkeypatch.setenv("PATH", "")  # without git
    config = {"duration": 10.0}
    record = provenance(config, ROOT, tmp_path)
    assert record["software"]["python"].endswith(platform.python_version())
    assert record["software"]["git"] is None
    assert record["packages"]["numba"] == version("numba")
    assert record["machine"]["processor"]
    assert platform.node() not in record["machine"].values()
    assert record["config"] == config
    assert json.loads(json.dumps(record)) == record
    needed = {
        "Snakefile",
        "config.yaml",
        "requirements.lock",
        "paper/paper.typ",
        "src/precursors/cli/options.py",
    }
    assert needed <= set(record["inputs"])
    assert not [
        name
        for name in record["inputs"]
        if "__pycache__" in name or name.startswith("results/")
    ]
    assert record["outputs"] == dict.fromkeys(
        ["tables/a.csv", "figures/a.svg"], SHA256_OF_ABC
    )


def test_commit_and_software_hash_identifiers_match_git(tmp_path, monkeypatch):
    def git(*command):
        identity = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
        command = ["git", "-C", tmp_path, *identity, *command]
        return subprocess.run(command, capture_output=True, text=True).stdout

    assert git_state(tmp_path) is None
    git("init")
    (tmp_path / "Snakefile").write_text("")
    git("commit", "--allow-empty", "-m", "Without the sources")
    assert git_state(tmp_path) is None
    git("add", "Snakefile")
    git("commit", "-m", "Begin")
    state = git_state(tmp_path)
    assert state["swh_revision"] == f"swh:1:rev:{git('rev-parse', 'HEAD').strip()}"
    assert state["swh_directory"] == f"swh:1:dir:{git('write-tree').strip()}"
    assert state["changed"] is False
    (tmp_path / "Snakefile").write_text("rule all:\n")
    assert git_state(tmp_path)["changed"] is True
    assert git_state(tmp_path, ignored="Snakefile")["changed"] is False
    for name in ("GIT_CONFIG_GLOBAL", "GIT_CONFIG_SYSTEM"):
        monkeypatch.setenv(name, os.devnull)
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    with pytest.warns(UserWarning, match="the commit is unknown: git says .*dubious"):
        assert git_state(tmp_path) is None
