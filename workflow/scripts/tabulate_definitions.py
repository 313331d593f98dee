"""Tabulate what every reading of "global slip", "short", "front" and theta gives beside the paper."""

from job import job

from precursors.reproduction.definitions import definitions_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        options = {name: value for name, value in snakemake.params.items() if name != "code"}
        write_table(definitions_table(**options), snakemake.output.table)
