"""The package builds as a wheel that works from elsewhere, and its citation is one."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
import yaml
from jsonschema import Draft202012Validator

ROOT = Path(__file__).parents[2]
DATA = (".html", ".js", ".css", ".typed", ".typ", ".yaml", ".json")

# What Citation File Format 1.2.0 asks for, of the keys that are used here; no other key is allowed.
TEXT = {"type": "string", "minLength": 1}
DOI = {"type": "string", "pattern": r"^10\.\d{4,9}(\.\d+)?/[A-Za-z0-9:/_;\-.()\[\]\\]+$"}
PERSON_OR_ENTITY = {
    "type": "object",
    "additionalProperties": False,
    "properties": {"family-names": TEXT, "given-names": TEXT, "name": TEXT},
    "oneOf": [{"required": ["name"]}, {"required": ["family-names", "given-names"]}],
}
AUTHORS = {"type": "array", "minItems": 1, "uniqueItems": True, "items": PERSON_OR_ENTITY}
NUMBER = {"anyOf": [{"type": "integer"}, TEXT]}
CITATION = {
    "type": "object",
    "additionalProperties": False,
    "required": ["authors", "cff-version", "message", "title"],
    "properties": {
        "abstract": TEXT,
        "authors": AUTHORS,
        "cff-version": {"const": "1.2.0"},
        "license": {"const": "MIT"},
        "message": TEXT,
        "title": TEXT,
        "type": {"enum": ["dataset", "software"]},
        "version": NUMBER,
        "references": {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "object",
                "additionalProperties": False,
                "required": ["authors", "title", "type"],
                "properties": {
                    "authors": AUTHORS,
                    "title": TEXT,
                    "type": {"const": "article"},
                    "journal": TEXT,
                    "volume": NUMBER,
                    "start": NUMBER,
                    "end": NUMBER,
                    "year": NUMBER,
                    "doi": DOI,
                },
            },
        },
    },
}


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    """A directory with what the wheel holds, built without a network."""
    directory = tmp_path_factory.mktemp("wheel")
    program = f"from hatchling.build import build_wheel; print(build_wheel({str(directory)!r}))"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(directory / done.stdout.split()[-1]) as wheel:
        wheel.extractall(directory / "site")
    return directory / "site"


def test_the_wheel_has_every_file_of_the_package(unpacked):
    source = ROOT / "src"
    wanted = {
        path.relative_to(source).as_posix()
        for path in (source / "precursors").rglob("*")
        if path.suffix in (".py", *DATA) and "__pycache__" not in path.parts
    }
    assert {"precursors/py.typed", "precursors/explorer/page.html"} <= wanted
    assert wanted <= {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*")}


def test_the_wheel_has_no_tests_results_or_caches(unpacked):
    top = {path.name for path in unpacked.iterdir()}
    assert {name for name in top if not name.endswith(".dist-info")} == {"precursors"}
    assert [path for path in unpacked.rglob("*") if path.suffix in (".nbi", ".nbc", ".pyc")] == []


def test_the_package_works_from_the_wheel_alone(unpacked, tmp_path):
    program = (
        "import precursors, importlib.metadata, importlib.resources as r\n"
        "from precursors import Chain\n"
        "from precursors.figures.explorer import page\n"
        "from precursors.cli import main\n"
        "print(precursors.__file__, Chain.from_slider().n_blocks, importlib.metadata.version('precursors'))\n"
        "page = r.files('precursors.figures.explorer').joinpath('page.html')\n"
        "print(page.is_file(), main(['plot', '-h']))\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(unpacked), "HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    assert done.stdout.startswith(f"{unpacked}/precursors/__init__.py 10 0.1.0\n")
    assert "usage:" in done.stdout


def test_the_citation_is_one_by_the_citation_file_format():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert [error.message for error in Draft202012Validator(CITATION).iter_errors(citation)] == []


def test_version_and_license_are_the_same_everywhere():
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert (project["version"], project["license"]) == (citation["version"], citation["license"])
    assert (ROOT / "LICENSE").read_text(encoding="utf-8").startswith("MIT License")
