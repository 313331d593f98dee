"""Every dependency is used, asked for, pinned, and justified in docs/dependencies.md."""

import ast
import re
import sys
import tomllib
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
    "scipy-stubs": ("Makefile", r"/mypy"),
    "pandas-stubs": ("Makefile", r"/mypy"),
    "types-pyyaml": ("Makefile", r"/mypy"),
    "types-jsonschema": ("Makefile", r"/mypy"),
    "snakemake-executor-plugin-slurm": ("workflow/profiles/slurm/profile.yaml", r"executor: slurm"),
}
# Parts of a package that is asked for, which name it in their own documentation.
PARTS = {"mpmath": "sympy", "llvmlite": "numba", "mpl_toolkits": "matplotlib", "_pytest": "pytest"}


def packages() -> list[str]:
    """Names of all packages that are asked for, without versions."""
    asked = [*PROJECT["dependencies"], *chain.from_iterable(PROJECT["optional-dependencies"].values())]
    return sorted({re.match(r"[A-Za-z0-9_-]+", line)[0].lower() for line in asked})


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


IMPORTED = imported()


@pytest.mark.parametrize("package", packages())
def test_a_package_that_is_asked_for_is_used(package):
    if package in BY_NAME:
        name, words = BY_NAME[package]
        assert re.search(words, (ROOT / name).read_text(encoding="utf-8"))
    else:
        assert MODULES.get(package, package.replace("-", "_")) in IMPORTED


@pytest.mark.parametrize("package", packages())
def test_a_package_that_is_asked_for_is_justified_in_a_line(package):
    lines = (ROOT / "docs/dependencies.md").read_text(encoding="utf-8").splitlines()
    rows = [line.split("|") for line in lines if re.match(r"\| [a-z]", line)]
    [row] = [row for row in rows if package in re.split(r",? ", row[1].strip())]
    assert float(row[2]) > 0
    assert len(row[3].split()) > 1


def test_everything_that_is_imported_is_asked_for():
    own = {
        path.stem
        for folder in ("src", "workflow", "tests", "benchmarks", "paper")
        for path in (ROOT / folder).rglob("*.py")
    }
    own |= {path.name for folder in ("src", "tests") for path in (ROOT / folder).iterdir()}
    asked = {MODULES.get(package, package.replace("-", "_")) for package in packages()}
    others = {
        name: path for name, path in IMPORTED.items() if name not in {*sys.stdlib_module_names, *own, *asked}
    }
    assert {name: str(path) for name, path in others.items() if PARTS.get(name) not in asked} == {}


def test_every_line_of_the_lock_has_a_hash():
    text = (ROOT / "requirements.lock").read_text(encoding="utf-8").replace("\\\n", " ")
    pinned = re.findall(r"^[A-Za-z0-9_.-]+==.*", text, re.MULTILINE)
    assert len(pinned) > 50
    assert all("--hash=sha256:" in block for block in pinned)
