"""Replace the golden files by those of the build and of the library; `git diff` shows the
changes."""

import shutil
import sys
from importlib import import_module
from pathlib import Path
from typing import Any
from unittest import mock

import codecheck
from explorer import example
from places import GOLDEN, RESULTS, ROOT

from precursors.figures import style
from precursors.support.files import write_whole

# Committed copies of results, for readers who do not build.
BUILT = {
    "explorer.html": "docs/explorer.html",
    "paper.pdf": "paper/paper.pdf",
    "supplement.pdf": "paper/supplement.pdf",
}


def pictures() -> dict[Path, Any]:
    """Functions that draw small pictures, by file: each test lists its own in PICTURES,
    and the files are beside the test."""
    drawn: dict[Path, Any] = {}
    for file in sorted((ROOT / "tests").rglob("test_*.py")):
        if "\nPICTURES = {" in file.read_text(encoding="utf-8"):
            module = file.relative_to(ROOT / "tests").with_suffix("")
            for name, how in import_module(".".join(module.parts)).PICTURES.items():
                drawn[file.with_name(f"{name}.png")] = how
    return drawn


def write_picture(path: Path, how: Any) -> None:
    """Write a picture of few pixels; `how` is its function, or its function and a look."""
    draw, look = how if isinstance(how, tuple) else (how, style.LOOK)
    with mock.patch.object(style, "PNG_DPI", 60):
        style.save(draw(), path, look)


def main() -> None:
    """Copy golden files from results/, and draw the small pictures."""
    for file in codecheck.manifest(ROOT):
        shutil.copy(ROOT / file, GOLDEN)
    for path, how in pictures().items():
        write_picture(path, how)
    write_whole(example.PICTURE, example.picture())
    for name, committed in BUILT.items():
        shutil.copyfile(RESULTS / name, ROOT / committed)


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(f"golden files: {error}")
