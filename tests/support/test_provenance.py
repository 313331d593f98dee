"""Provenance says what computed the results, with and without git."""

import json
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path

import pytest

from precursors.support.provenance import checksums, git_state, provenance

ROOT = Path(__file__).parents[2]
CONFIG = {"duration": 10.0}
SHA256_OF_ABC = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"  # FIPS 180-4


@pytest.fixture
def results(tmp_path):
    for name in ("tables/a.csv", "figures/a.svg", "logs/a.log", "README.md", "tables/.partial.a.csv"):
        path = tmp_path / "results" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return tmp_path / "results"


def test_a_checksum_is_that_of_the_content(tmp_path):
    (tmp_path / "b").write_bytes(b"abc")
    assert checksums([tmp_path / "b"], tmp_path) == {"b": {"bytes": 3, "sha256": SHA256_OF_ABC}}


def test_everything_that_computed_is_named_with_its_version(results):
    found = provenance(CONFIG, ROOT, results)
    assert found["software"]["python"].endswith(platform.python_version())
    assert found["packages"]["numba"] == version("numba")
    assert found["machine"]["processor"]
    assert platform.node() not in found["machine"].values()
    assert found["config"] == CONFIG
    assert json.loads(json.dumps(found)) == found


def test_every_source_is_an_input_and_every_result_an_output(results):
    found = provenance(CONFIG, ROOT, results)
    needed = {"Snakefile", "config.yaml", "requirements.lock", "paper/paper.typ", "src/precursors/cli.py"}
    assert needed <= set(found["inputs"])
    assert not [name for name in found["inputs"] if "__pycache__" in name or name.startswith("results/")]
    assert set(found["outputs"]) == {"tables/a.csv", "figures/a.svg"}


def test_the_commit_and_its_software_hash_identifiers_are_those_of_git(tmp_path):
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


def test_provenance_is_written_without_git(results, monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert provenance(CONFIG, ROOT, results)["software"]["git"] is None
