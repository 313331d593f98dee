"""Setting the pages of the paper: Typst source, numbers and results in, the same PDF out on every machine."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

from precursors.support.files import write_whole

# No page says when it was made.
EPOCH = 0
# Words of paper/lib.typ that show a file of the results.
SHOWN = {
    "drawn": "results/figures/{}.svg",
    "listed": "results/tables/{}.csv",
    "rows": "results/tables/{}.csv",
}


def files_shown(source: str | os.PathLike[str]) -> list[str]:
    """Figures and whole tables that the text shows, each once, sorted."""
    text = "".join(path.read_text(encoding="utf-8") for path in Path(source).rglob("*.typ"))
    return sorted(
        {
            place.format(name)
            for word, place in SHOWN.items()
            for name in re.findall(rf'\b{word}\("([^"]+)"', text)
        }
    )


def set_pages(
    source: str | os.PathLike[str],
    results: Iterable[str | os.PathLike[str]],
    rules: Mapping[str, str],
    output: str | os.PathLike[str],
) -> None:
    """Set main.typ of a directory with the fonts that Typst brings along.

    Parameters
    ----------
    source : path
        The directory; the text finds it as /paper.
    results : iterable of path
        Files that the text may read; it finds them by the same paths, such as /results/tables/claims.csv.
    rules : mapping
        Such a path, and the rule of the workflow that wrote it, for the captions.
    output : path
        The PDF.

    Raises
    ------
    ValueError
        In one line: what Typst says is wrong and where; its warnings too.
    """
    import typst  # slow, and nothing else needs it

    with tempfile.TemporaryDirectory() as directory:
        root = Path(directory)
        shutil.copytree(source, root / "paper")
        for path in results:
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, root / path)
        main = root / "paper/main.typ"
        try:
            pages, warnings = typst.compile_with_warnings(
                main, root=root, ignore_system_fonts=True, timestamp=EPOCH, sys_inputs=dict(rules)
            )
        except typst.TypstError as error:
            raise ValueError(_line(error)) from None
    if warnings:
        raise ValueError("; ".join(_line(warning) for warning in warnings))
    with write_whole(output) as temporary:
        temporary.write_bytes(pages)


def _line(problem: object) -> str:
    """What Typst says, in one line, with the place in the source."""
    diagnostic = getattr(problem, "diagnostic", "")
    places = re.findall(r"(paper/\S+\.typ:\d+)", diagnostic)
    message = getattr(problem, "message", str(problem)).removeprefix("assertion failed: ")
    return f"{message} ({', '.join(dict.fromkeys(places))})"
