"""Make the tables of an entry of the list TABLES, or of one that is like it."""

from collections.abc import Mapping
from pkgutil import resolve_name
from typing import Any

from job import job, read

# isort: split
import pandas as pd

from precursors.support.files import write_table


def main(
    function: str,
    inputs: Mapping[str, Any],
    options: Mapping[str, Any],
    tables: Mapping[str, str],
    readers: Mapping[str, str],
) -> None:
    """Call a function of the library, "room.module:name", with what the files of the inputs hold.

    It returns a table, or tables by their names in `tables`, which has the path of each.
    """
    arguments = {name: read(files, readers) for name, files in inputs.items()}
    found = resolve_name(f"precursors.{function}")(**arguments, **options)
    for name, path in tables.items():
        write_table(found if isinstance(found, pd.DataFrame) else found[name], path)


if __name__ == "__main__":
    with job() as snakemake:
        params = snakemake.params
        tables = dict(zip(params.names, snakemake.output, strict=True))
        main(params.function, params.inputs, params.options, tables, params.readers)
