"""Every dependency is used, asked for, pinned, and justified in docs/dependencies.md."""

import ast
import platform
import re
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, distribution
from itertools import chain
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
# Module of a package whose name differs.
MODULES = {"pillow": "PIL", "pyyaml": "yaml", "python-flint": "flint", "scikit-sundae": "sksundae"}
# Used by name and not by import: the file, and the words there that use it.
BY_NAME = {
    "pytest-xdist": ("Makefile", r"pytest -n"),
    "ruff": ("Makefile", r"/ruff "),
    "snakefmt": ("Makefile", r"/snakefmt "),
    "mypy": ("Makefile", r"/mypy"),
    "uv": ("Makefile", r"/uv "),
    "hatchling": ("pyproject.toml", r'build-backend = "hatchling'),
    "setuptools": ("Makefile", r"--build-constraints requirements\.lock"),
    "scipy-stubs": ("Makefile", r"/mypy"),
    "pandas-stubs": ("Makefile", r"/mypy"),
    "types-pyyaml": ("Makefile", r"/mypy"),
    "types-jsonschema": ("Makefile", r"/mypy"),
    "snakemake-executor-plugin-slurm": ("workflow/profiles/slurm/profile.yaml", r"executor: slurm"),
}
# Parts of a package that is asked for, which name it in their own documentation.
PARTS = {"mpmath": "sympy", "llvmlite": "numba", "mpl_toolkits": "matplotlib", "_pytest": "pytest"}


# Brought by a package, and counted with it.
BROUGHT = {"numba": ["llvmlite"]}
# How far a size may be off, as another version's may be.
OTHER_VERSION = 0.25
DOCUMENT = (ROOT / "docs/dependencies.md").read_text(encoding="utf-8")


def name_of(requirement: str) -> str:
    """Name of a package that is asked for."""
    return re.match(r"[A-Za-z0-9_-]+", requirement)[0].lower()


def packages() -> list[str]:
    """Names of all packages that are asked for, without versions."""
    asked = [*PROJECT["dependencies"], *chain.from_iterable(PROJECT["optional-dependencies"].values())]
    return sorted(set(map(name_of, asked)))


@pytest.fixture(scope="module")
def imported() -> dict[str, Path]:
    """Top-level modules that the project imports, with a file that does so; rules are read line by line."""
    found: dict[str, Path] = {}
    for folder in ("src", "workflow", "tests", "benchmarks", "paper"):
        for path in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
                if isinstance(node, ast.ImportFrom) and not node.level:
                    names = [node.module or ""]
                found |= {name.split(".")[0]: path for name in names}
    for path in [ROOT / "Snakefile", *(ROOT / "workflow/rules").glob("*.smk")]:
        for name in re.findall(r"^(?:from|import) (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE):
            found[name] = path
    return found


@pytest.mark.parametrize("package", packages())
def test_a_package_that_is_asked_for_is_used(package, imported):
    if package in BY_NAME:
        name, words = BY_NAME[package]
        assert re.search(words, (ROOT / name).read_text(encoding="utf-8"))
    else:
        assert MODULES.get(package, package.replace("-", "_")) in imported


def justifications() -> dict[str, tuple[float, str]]:
    """Size [MB] and reason of the packages in each row of docs/dependencies.md."""
    text = DOCUMENT.split("## Oldest versions")[0]
    rows = re.findall(r"^\| ([a-z][a-z0-9, -]*) \| (\d+) \| (.*) \|$", text, re.MULTILINE)
    return {names: (float(size), reason) for names, size, reason in rows}


@pytest.mark.parametrize("package", packages())
def test_a_package_that_is_asked_for_is_justified_in_a_line(package):
    [row] = [row for names, row in justifications().items() if package in names.split(", ")]
    assert len(row[1].split()) > 1


def test_no_package_is_justified_that_is_not_asked_for():
    named = {name for names in justifications() for name in names.split(", ")}
    assert sorted(named - {"package"}) == packages()


@pytest.mark.skipif(sys.platform != "linux" or platform.machine() != "x86_64", reason="sizes of other wheels")
@pytest.mark.parametrize("names", justifications())
def test_a_package_has_the_size_that_is_told(names):
    packages = [part for name in names.split(", ") for part in (name, *BROUGHT.get(name, ()))]
    try:
        found = [distribution(package) for package in packages]
    except PackageNotFoundError as error:
        pytest.skip(f"{error.name} is not installed")
    files = [file for package in found for file in package.files if file.suffix != ".pyc"]
    size = sum(file.locate().stat().st_size for file in files if file.locate().is_file()) / 1e6
    assert justifications()[names][0] == pytest.approx(size, rel=OTHER_VERSION, abs=1.0)


@pytest.mark.parametrize("package", sorted(map(name_of, PROJECT["dependencies"])))
def test_the_oldest_version_of_a_library_is_told_as_it_is_asked_for(package):
    [asked] = [line.split(">=")[1] for line in PROJECT["dependencies"] if name_of(line) == package]
    text = DOCUMENT.split("## Oldest versions")[1]
    rows = re.findall(r"^\| ([a-z][a-z0-9, -]*) \| ([0-9., ]+) \|", text, re.MULTILINE)
    told = dict(
        pair for names, versions in rows for pair in zip(names.split(", "), versions.split(", "), strict=True)
    )
    assert told[package] == asked


def test_everything_that_is_imported_is_asked_for(imported):
    own = {
        path.stem
        for folder in ("src", "workflow", "tests", "benchmarks", "paper")
        for path in (ROOT / folder).rglob("*.py")
    }
    own |= {path.name for folder in ("src", "tests") for path in (ROOT / folder).iterdir()}
    asked = {MODULES.get(package, package.replace("-", "_")) for package in packages()}
    others = {
        name: path for name, path in imported.items() if name not in {*sys.stdlib_module_names, *own, *asked}
    }
    assert {name: str(path) for name, path in others.items() if PARTS.get(name) not in asked} == {}


def test_every_line_of_the_lock_has_a_hash():
    text = (ROOT / "requirements.lock").read_text(encoding="utf-8").replace("\\\n", " ")
    pinned = re.findall(r"^[A-Za-z0-9_.-]+==.*", text, re.MULTILINE)
    assert len(pinned) > 50
    assert all("--hash=sha256:" in block for block in pinned)
