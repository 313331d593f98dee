"""Small pictures that are kept: a test file has those of its subject in PICTURES."""

from importlib import import_module
from pathlib import Path
from typing import Any
from unittest import mock

from places import GOLDEN, ROOT

from precursors.figures import style

SMALL = GOLDEN / "small"


def pictures() -> dict[str, Any]:
    """All pictures that test files keep, by name."""
    found: dict[str, Any] = {}
    for file in sorted((ROOT / "tests").glob("*/test_*.py")):
        if "\nPICTURES = {" in file.read_text(encoding="utf-8"):
            module = import_module(f"{file.parent.name}.{file.stem}")
            found |= module.PICTURES
    return found


def write_picture(path: Path, how: Any) -> None:
    """Write a picture of few pixels; `how` draws it, or draws it with a look."""
    draw, look = how if isinstance(how, tuple) else (how, style.LOOK)
    with mock.patch.object(style, "PNG_DPI", 60):
        style.save(draw(), path, look)
