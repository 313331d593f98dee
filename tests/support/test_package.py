"""What is imported from the package is there, and nothing is loaded before it is needed."""

import subprocess
import sys
from importlib.resources import files

import pytest

import precursors

# The compiler and what only simulations and tables need.
HEAVY = {"numba", "h5py", "pandas"}


def loaded(program: str) -> set[str]:
    """Modules that a program has loaded when it ends, in a process of its own."""
    command = [sys.executable, "-c", f"import sys\n{program}\nprint(*sys.modules)"]
    return set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())


@pytest.mark.parametrize("name", precursors.__all__)
def test_every_public_name_is_there(name):
    assert getattr(precursors, name).__name__ == name
    assert name in dir(precursors)


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
    ],
)
def test_nothing_is_loaded_before_it_is_needed(program, missing):
    assert not loaded(program) & missing


def test_the_types_of_the_package_are_offered_to_type_checkers():
    assert files("precursors").joinpath("py.typed").is_file()
