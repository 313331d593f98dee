"""The package: its public names, its imports and its wheel."""

import json
import re
import subprocess
import sys
import tomllib
import zipfile
from itertools import chain

import pytest
from places import ROOT

import precursors
from precursors.support.checkout import git_state

# The compiler, and packages that only simulations and tables need.
HEAVY = {"numba", "h5py", "pandas"}
# Imports of the rules of the workflow.
RULES = "from maegawa2010.paper import documents, inputs"


def loaded(program: str) -> set[str]:
    """Run a program in its own process and return the modules that it has imported."""
    command = [sys.executable, "-c", f"import sys\n{program}\nprint(*sys.modules)"]
    return set(
        subprocess.run(
            command, capture_output=True, text=True, check=True
        ).stdout.split()
    )


@pytest.mark.parametrize("name", precursors.__all__)
def test_every_public_name_is_importable(name):
    assert getattr(precursors, name).__name__ == name
    assert name in dir(precursors)
    assert not hasattr(precursors, f"{name}s")


@pytest.mark.parametrize(
    ("program", "missing"),
    [
        ("import precursors.figures.scene, maegawa2010.scenes", HEAVY - {"pandas"}),
        (
            "from precursors import Chain, simulate; simulate(Chain.from_slider(), 0.1)",
            {"h5py", "pandas", "matplotlib"},
        ),
        ("from precursors.cli import main; main(['audit', 'none.h5'])", {"numba"}),
        (RULES, HEAVY | {"matplotlib", "scipy", "sympy"}),
    ],
)
def test_modules_are_imported_only_when_needed(program, missing):
    assert not loaded(program) & missing


def test_library_works_without_its_extras():
    """Packages for the workflow, the paper, the page and the proof are missing."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    project = tomllib.loads(text)["project"]
    extras = set(map(package, chain(*project["optional-dependencies"].values())))
    assert not extras & set(map(package, project["dependencies"]))
    absent = [
        "sympy",
        "snakemake",
        "jsonschema",
        "yaml",
        "flint",
        "typst",
        "heyoka",
        "sksundae",
    ]
    loaded(
        f"sys.modules.update(dict.fromkeys({absent!r}))\n"
        "from precursors import Chain, audit, find_slips, simulate\n"
        "import precursors.cli, maegawa2010.studies.models.answers\n"
        "import maegawa2010.studies.members, maegawa2010.methods\n"
        "import precursors.figures.scene, precursors.figures.precursor_lengths\n"
        "try: precursors.certify(Chain.from_slider(), 1)\n"
        "except ModuleNotFoundError as error: assert 'pip install \"precursors[proof]\"' in str(error)\n"
        "else: raise AssertionError"
    )


def package(requirement: str) -> str:
    return re.match(r"[\w-]+", requirement)[0]


def test_wheel_has_every_file_of_the_package_and_its_commit(tmp_path):
    program = f"from hatchling.build import build_wheel; print(build_wheel({str(tmp_path)!r}))"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(tmp_path / done.stdout.split()[-1]) as wheel:
        packed = {name for name in wheel.namelist() if ".dist-info/" not in name}
        wheel.extractall(tmp_path)
    paths = {path for path in (ROOT / "src").rglob("*") if path.is_file()}
    # Exclude caches of Python and Numba.
    wanted = {
        str(path.relative_to(ROOT / "src"))
        for path in paths
        if "__pycache__" not in path.parts
    }
    assert packed == wanted
    assert "precursors/py.typed" in packed
    program = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); "
        "from precursors.benchmark.score import problems; print(*problems().values())"
    )
    listed = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout.split()
    if state := git_state(ROOT):  # not in an archive of the sources
        [record] = tmp_path.glob("*.dist-info/extra_metadata/commit.json")
        assert json.loads(record.read_text()) == state
    assert len(listed) == 8
    assert all(path.startswith(str(tmp_path)) for path in listed)
