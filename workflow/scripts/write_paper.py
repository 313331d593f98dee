"""Write the reproduction paper, and the numbers in its text."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.reproduction.paper import collect_numbers, read_sources, set_pages, write_numbers
from precursors.support.files import write_whole


def main(
    source: str | Path,
    shown: Sequence[str | Path],
    tables: str | Path,
    config: Mapping[str, Any],
    makers: Mapping[str, Any],
    numbers: str | Path,
    output: str | Path,
) -> None:
    """Set the pages of `source` from the tables of a directory and the files that the text shows.

    `config` holds the numbers that are parameters, and `makers` the rule and modules that made each file.
    """
    write_numbers(collect_numbers(read_sources(Path(source) / "numbers.yaml"), tables, config), numbers)
    made = Path(numbers).with_name(".makers.json")
    try:
        with write_whole(made) as temporary:
            temporary.write_text(json.dumps(makers), encoding="utf-8")
        files = {str(path): path for path in shown}
        set_pages(source, {**files, "results/numbers.json": numbers, "results/makers.json": made}, output)
    finally:
        made.unlink(missing_ok=True)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            Path(snakemake.input.main).parent,
            snakemake.input.shown,
            "results/tables",
            snakemake.params.config,
            snakemake.params.makers,
            snakemake.output.numbers,
            snakemake.output.pdf,
        )
