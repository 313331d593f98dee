"""Run one chunk of an ensemble, "1of4" to "4of4": every n-th member, a row each with
what its run gave."""

from pkgutil import resolve_name

from job import job

# isort: split
from precursors.support.files import write_table

with job() as snakemake:
    params = snakemake.params
    study = resolve_name(params.function)(**params.options)
    found = resolve_name(params.run)(
        study.chunk(*map(int, snakemake.wildcards.chunk.split("of")))
    )
    write_table(found.rename_axis("member").reset_index(), snakemake.output.chunk)
