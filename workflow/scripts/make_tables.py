"""Make the tables of an entry of TABLES."""

from pathlib import Path
from pkgutil import resolve_name

from job import job, read

# isort: split
import pandas as pd

from precursors.support.files import write_table

with job() as snakemake:
    params = snakemake.params
    arguments = {
        name: read(files, params.readers) for name, files in params.inputs.items()
    }
    # A function, "package.module:name", returns a table, or tables by their names.
    found = resolve_name(params.function)(**arguments, **params.options)
    for path in snakemake.output:
        table = found if isinstance(found, pd.DataFrame) else found[Path(path).stem]
        write_table(table, path)
