"""Copies of the workflow: shared by tests, or one for each test."""

import shutil
from pathlib import Path

import pytest
from workflow_copy import Outcome, Workspace, copy_workflow

# A scene in addition to the paper's.
MORE_SCENE = """\
  steep:
    title: nearly all of the load at the leading edge
    theta: "9/10"
    duration: 0.5
"""


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    """A copy of the workflow without results."""
    return copy_workflow(tmp_path / "copy")


@pytest.fixture(scope="session")
def _finished(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    workspace = copy_workflow(tmp_path_factory.mktemp("finished") / "copy")
    workspace.add_scenes(MORE_SCENE)
    workspace.edit("workflow/settings.yaml", "chunks: 1", "chunks: 2")
    outcome = workspace.pretend("all")
    assert outcome.code == 0, outcome.text
    return workspace


@pytest.fixture(scope="session")
def untouched(tmp_path_factory: pytest.TempPathFactory) -> tuple[Workspace, Outcome]:
    """A copy of the workflow without results, and the output of `snakemake -n all`;
    shared by tests."""
    workspace = copy_workflow(tmp_path_factory.mktemp("untouched") / "copy")
    return workspace, workspace.run("-n", "all")


@pytest.fixture
def finished(_finished: Workspace, tmp_path: Path) -> Workspace:
    """A copy of the workflow with MORE_SCENE and placeholders for all results, so that
    nothing is left to do."""
    shutil.copytree(_finished.path, tmp_path / "copy")
    return Workspace(tmp_path / "copy")
