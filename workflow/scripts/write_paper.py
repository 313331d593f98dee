"""Typeset a document of paper/, with the same bytes on every machine."""

import re
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path

from maegawa2010.paper.documents import cited_results
from maegawa2010.support.job import job
from precursors.support.files import write_whole

# Date in the PDF: always the same, so that its bytes do not change.
EPOCH = 0


def main(
    main_file: str | Path, results: Iterable[str | Path], output: str | Path
) -> None:
    """Typeset a Typst file, which reads its directory as /paper and the results by
    their paths.

    Raises
    ------
    ValueError
        In one line: which result is missing, or the errors or warnings of Typst and
        where they occur.
    """
    import matplotlib
    import typst  # slow, and the tests of other scripts import this directory

    main_file = Path(main_file)
    missing = sorted({*cited_results(main_file)} - {*map(str, results)})
    if missing:
        raise ValueError(
            f"paper/{main_file.name} cites {', '.join(missing)}, which no rule makes: "
            "delete the citation, or include the study that makes the result"
        )
    with tempfile.TemporaryDirectory() as directory:
        root = Path(directory)
        shutil.copytree(main_file.parent, root / "paper")
        shutil.copy(main_file.parents[1] / "CITATION.cff", root)
        for path in results:
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, root / path)
        try:
            pages, warnings = typst.compile_with_warnings(
                root / "paper" / main_file.name,
                root=root,
                ignore_system_fonts=True,
                font_paths=[Path(matplotlib.get_data_path(), "fonts/ttf")],
                timestamp=EPOCH,
            )
        except typst.TypstError as error:
            raise ValueError(_line(error)) from None
    if warnings:
        raise ValueError("; ".join(map(_line, warnings)))
    write_whole(output, pages)


def _line(problem: object) -> str:
    """An error or warning of Typst in one line, with its places in the source."""
    places = re.findall(r"(paper/\S+\.typ:\d+)", getattr(problem, "diagnostic", ""))
    message = getattr(problem, "message", str(problem)).removeprefix(
        "assertion failed: "
    )
    return f"{message} ({', '.join(dict.fromkeys(places))})"


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.main, snakemake.input.shown, snakemake.output[0])
