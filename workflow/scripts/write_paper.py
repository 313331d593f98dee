"""Write the reproduction paper, and the numbers in its text."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.reproduction.numbers import numbers
from precursors.reproduction.pages import set_pages
from precursors.reproduction.tables import Tables
from precursors.support.files import write_text


def main(
    source: str | Path,
    shown: Sequence[str],
    config: Mapping[str, Any],
    rules: Mapping[str, str],
    numbers_file: str,
    output: str | Path,
) -> None:
    """Set the pages of `source` from results/tables and the files that it shows, made by these rules."""
    found = numbers(Tables("results/tables"), config)
    write_text(numbers_file, json.dumps(found, indent=1, ensure_ascii=False) + "\n")
    set_pages(source, [*shown, numbers_file], rules, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            Path(snakemake.input.main).parent,
            list(map(str, snakemake.input.shown)),
            snakemake.params.config,
            snakemake.params.rules,
            snakemake.output.numbers,
            snakemake.output.pdf,
        )
