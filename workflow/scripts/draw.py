"""Draw the figures of a section, as the list in workflow/rules/figures.smk has them."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from job import job, read

from precursors.figures import style


def main(
    figure: str,
    tables: Mapping[str, Any],
    options: Mapping[str, Any],
    outputs: Sequence[str | Path],
    readers: Mapping[str, str],
) -> None:
    """Draw the tables, once for each file name; several files under one name become a list of tables."""
    drawn = resolve_name(f"precursors.figures.{figure}:draw")(**read(tables, readers), **options)
    for output in outputs:
        style.save(drawn, output)


if __name__ == "__main__":
    with job() as snakemake:
        readers = snakemake.params.readers
        for name, figure in snakemake.params.figures.items():
            files = [file for file in snakemake.output if Path(file).stem == name]
            module, tables = figure.get("module", name), figure.get("tables", {})
            main(module, tables, figure.get("options", {}), files, readers)
