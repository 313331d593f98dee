"""Draw the figures of a section, as the list in workflow/rules/figures.smk has them."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from job import job

from precursors.figures import style
from precursors.support.files import read_table


def main(
    figure: str,
    tables: Mapping[str, str | Sequence[str]],
    options: Mapping[str, Any],
    outputs: Sequence[str | Path],
) -> None:
    """Draw the tables, once for each file name; several files under one name become a list of tables."""
    read = {
        name: read_table(paths) if isinstance(paths, str) else [read_table(path) for path in paths]
        for name, paths in tables.items()
    }
    drawn = import_module(f"precursors.figures.{figure}").draw(**read, **options)
    for output in outputs:
        style.save(drawn, output)


if __name__ == "__main__":
    with job() as snakemake:
        for name, figure in snakemake.params.figures.items():
            files = [file for file in snakemake.output if Path(file).stem == name]
            main(figure.get("module", name), figure.get("tables", {}), figure.get("options", {}), files)
