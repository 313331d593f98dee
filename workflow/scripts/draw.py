"""Draw a figure: `params.figure` is its module, the inputs are its tables, the other params its options."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any

from job import job

from precursors.figures import style
from precursors.support.files import read_table


def main(
    figure: str, tables: Mapping[str, str | Sequence[str]], options: Mapping[str, Any], outputs: Sequence[str]
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
        tables, options = dict(snakemake.input.items()), dict(snakemake.params.items())
        options.pop("code")
        main(options.pop("figure"), tables, options, snakemake.output)
