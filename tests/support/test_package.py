"""The package: its public names, what it loads, its wheel and its citation."""

import inspect
import os
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

import precursors

ROOT = Path(__file__).parents[2]
# The compiler, and what only simulations and tables need.
HEAVY = {"numba", "h5py", "pandas"}
# What the rules of the workflow import.
RULES = "from precursors.ensembles import studies; from precursors.reproduction import inputs, shown"


def loaded(program: str) -> set[str]:
    """Modules that a program has loaded when it ends, in a process of its own."""
    command = [sys.executable, "-c", f"import sys\n{program}\nprint(*sys.modules)"]
    return set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())


@pytest.mark.parametrize("name", precursors.__all__)
def test_every_public_name_is_there(name):
    thing = getattr(precursors, name)
    assert thing.__name__ == name
    assert name in dir(precursors)
    own = vars(thing) if isinstance(thing, type) else {}
    public = [thing, *(getattr(thing, part) for part in own if not part.startswith("_"))]
    assert [one for one in public if callable(one) and not inspect.getdoc(one)] == []


def test_a_name_that_is_not_there_is_refused():
    with pytest.raises(ImportError, match="simulation"):
        from precursors import simulation  # noqa: F401
    assert not hasattr(precursors, "Chains")


@pytest.mark.parametrize(
    ("program", "missing"),
    [
        ("import precursors", HEAVY | {"numpy"}),
        ("from precursors import Chain", HEAVY),
        ("import precursors.model.scenes", HEAVY),
        ("import precursors.figures.scene", HEAVY - {"pandas"}),
        (
            "from precursors import Chain, simulate; simulate(Chain.from_slider(), 0.1)",
            {"h5py", "pandas", "matplotlib"},
        ),
        ("from precursors.cli import main; main(['audit', 'none.h5'])", {"numba"}),
        (RULES, HEAVY | {"matplotlib", "scipy", "sympy"}),
    ],
)
def test_nothing_is_loaded_before_it_is_needed(program, missing):
    assert not loaded(program) & missing


def test_the_library_works_without_its_extras():
    """What only the workflow, the paper, the page and the proof need is not there."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = {name for extra in project["optional-dependencies"].values() for name in map(package, extra)}
    assert not extras & set(map(package, project["dependencies"]))
    absent = ("sympy", "snakemake", "jsonschema", "yaml", "flint", "typst", "heyoka", "sksundae")
    loaded(
        f"sys.modules.update(dict.fromkeys({absent!r}))\n"
        "from precursors import Chain, audit, find_slips, simulate\n"
        "import precursors.cli, precursors.hierarchy.models, precursors.ensembles.study, precursors.methods\n"
        "import precursors.figures.scene, precursors.figures.precursor_lengths\n"
        "try: precursors.certify(Chain.from_slider(), 1)\n"
        "except ModuleNotFoundError as error: assert 'pip install \"precursors[proof]\"' in str(error)\n"
        "else: raise AssertionError"
    )


def package(requirement: str) -> str:
    return re.match(r"[\w-]+", requirement)[0]


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    """A directory with the content of the wheel, which is built without a network."""
    directory = tmp_path_factory.mktemp("wheel")
    program = f"from hatchling.build import build_wheel; print(build_wheel({str(directory)!r}))"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(directory / done.stdout.split()[-1]) as wheel:
        wheel.extractall(directory / "site")
    return directory / "site"


def test_the_wheel_has_every_file_of_the_package_and_nothing_else(unpacked):
    files = {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*") if path.is_file()}
    source = ROOT / "src"
    wanted = {p.relative_to(source).as_posix() for p in (source / "precursors").rglob("*") if p.is_file()}
    wanted = {name for name in wanted if "__pycache__" not in name}
    assert "precursors/py.typed" in wanted
    assert {name for name in files if ".dist-info/" not in name} == wanted


def test_the_package_works_from_the_wheel_alone(unpacked, tmp_path):
    program = (
        "import precursors, precursors.cli; print(precursors.__file__, precursors.cli.main(['plot', '-h']))"
    )
    environment = {**os.environ, "PYTHONPATH": str(unpacked), "HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.stderr == ""
    assert "usage: precursors plot" in done.stdout
