"""Provenance says what computed the results, without git too."""

import json
import platform
import shutil
from importlib.metadata import version
from pathlib import Path

import pytest

from precursors.support import provenance as module
from precursors.support.provenance import checksums, departures, git_state, provenance

ROOT = Path(__file__).parents[2]
EMPTY = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"  # SHA-256 of nothing (FIPS 180-4)
CONFIG = {"duration": 10.0}


@pytest.fixture
def results(tmp_path):
    for name in ("tables/a.csv", "figures/a.svg", "logs/a.log", "README.md"):
        path = tmp_path / "results" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return tmp_path / "results"


def test_a_checksum_is_that_of_the_content(tmp_path):
    (tmp_path / "a").touch()
    (tmp_path / "b").write_bytes(b"abc")
    assert checksums([tmp_path / "a", tmp_path / "b"], tmp_path) == {
        "a": {"bytes": 0, "sha256": EMPTY},
        "b": {
            "bytes": 3,
            "sha256": "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
        },
    }


def test_everything_that_computed_is_named_with_its_version(results):
    found = provenance(CONFIG, ROOT, results)
    assert found["software"]["python"].endswith(platform.python_version())
    assert found["software"]["numba"] == version("numba")
    assert found["software"]["llvm"].split(".")[0].isdigit()
    assert found["packages"]["numpy"] == version("numpy")
    assert found["machine"]["processor"]
    assert platform.node() not in found["machine"].values()
    assert found["config"] == CONFIG
    assert json.loads(json.dumps(found)) == found


def test_every_source_is_an_input_and_every_result_an_output(results):
    found = provenance(CONFIG, ROOT, results)
    needed = {
        "Snakefile",
        "config.yaml",
        "requirements.lock",
        "paper/main.typ",
        "src/precursors/solver/kernel/events.py",
    }
    assert needed <= set(found["inputs"])
    assert not [name for name in found["inputs"] if "__pycache__" in name or name.startswith("results/")]
    assert set(found["outputs"]) == {"tables/a.csv", "figures/a.svg"}


def test_a_package_of_another_version_than_the_lock_files_is_named(tmp_path):
    lock = tmp_path / "requirements.lock"
    lock.write_text("numpy==1.2.3 \\\n    --hash=sha256:0\nScikit_Sundae==2.0 ; python_version < '4'\n")
    assert departures(lock, {"numpy": "1.2.4", "scikit-sundae": "2.0"}) == {"numpy": "1.2.4, not 1.2.3"}
    assert departures(tmp_path / "none", {"numpy": "1"}) == {}


def test_the_commit_is_known_where_git_is(tmp_path, monkeypatch):
    if shutil.which("git") is None:
        pytest.skip("no git here")
    assert git_state(tmp_path) is None
    answers = {"rev-parse": "c0ffee", "ls-files": "Snakefile", "status": ""}
    monkeypatch.setattr(module, "_output", lambda *command: answers[command[3]])
    assert git_state(tmp_path) == {"commit": "c0ffee", "changed": False}
    answers["status"] = " M run.py"
    assert git_state(tmp_path) == {"commit": "c0ffee", "changed": True}


def test_provenance_is_written_without_git(results, monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert provenance(CONFIG, ROOT, results)["software"]["git"] is None
