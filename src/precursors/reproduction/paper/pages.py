"""Setting the pages: Typst source, numbers and results in, the same PDF out on every machine."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from precursors.reproduction.paper.numbers import PaperError
from precursors.support.files import write_whole

# No page says when it was made.
EPOCH = 0


# Words of paper/lib.typ that show a file of the results, and where it lies.
SHOWN = {
    "drawn": "results/figures/{}.svg",
    "listed": "results/tables/{}.csv",
    "rows": "results/tables/{}.csv",
}


def files_shown(source: str | os.PathLike[str]) -> list[str]:
    """Figures and whole tables that the text shows, each once, sorted."""
    texts = [path.read_text(encoding="utf-8") for path in Path(source).rglob("*.typ")]
    names = {
        place.format(name)
        for word, place in SHOWN.items()
        for text in texts
        for name in re.findall(rf'\b{word}\("([^"]+)"', text)
    }
    return sorted(names)


def set_pages(
    source: str | os.PathLike[str],
    files: Mapping[str, str | os.PathLike[str]],
    output: str | os.PathLike[str],
    main: str = "main.typ",
) -> None:
    """Set the paper with the fonts that Typst brings along and nothing but the files named.

    Parameters
    ----------
    source : path
        Directory with the Typst source; it is /paper to the text.
    files : mapping
        What the text may read: its path in the text (results/tables/claims.csv), and the file.
    output : path
        PDF to write, whole or not at all.
    main : str
        The file of `source` to begin with.

    Raises
    ------
    PaperError
        In one line: a file that is missing, or what Typst says is wrong and where; its warnings too.
    """
    import typst

    with tempfile.TemporaryDirectory() as directory:
        root = Path(directory)
        shutil.copytree(source, root / "paper")
        take_along(files, root)
        try:
            pages, warnings = typst.compile_with_warnings(
                root / "paper" / main, root=root, ignore_system_fonts=True, timestamp=EPOCH
            )
        except typst.TypstError as error:
            raise PaperError(_line(error, root)) from None
    if warnings:
        raise PaperError("; ".join(_line(warning, root) for warning in warnings))
    with write_whole(output) as temporary:
        temporary.write_bytes(pages)


def take_along(files: Mapping[str, str | os.PathLike[str]], root: str | os.PathLike[str]) -> None:
    """Copy the files that the text may read below `root`, each to its path in the text.

    Raises
    ------
    PaperError
        In one line: a file that is missing, or not what was written there.
    """
    for name, file in files.items():
        target = Path(root) / name
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            target.write_bytes(Path(file).read_bytes())
        except FileNotFoundError:
            raise PaperError(f"{file} is missing: the paper shows it") from None
        except (ValueError, OSError) as error:
            raise PaperError(str(error)) from None


def _line(problem: Any, root: Path) -> str:
    """What Typst says, in one line, with the file and line of the source where it says so."""
    places = re.findall(rf"{root.name}/(paper/\S+\.typ:\d+)", problem.diagnostic)
    message = problem.message.removeprefix("assertion failed: ")
    return f"{message} ({', '.join(dict.fromkeys(places))})"
