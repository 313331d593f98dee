"""Run one chunk of a study, "1of4" to "4of4": every n-th member, a row each with what
its run gave."""

from job import job

from maegawa2010.studies.members import run_members
from maegawa2010.studies.registry import make_study
from precursors.support.files import write_table

with job() as snakemake:
    study = make_study(snakemake.wildcards.study, snakemake.params.arguments)
    found = run_members(study.chunk(*map(int, snakemake.wildcards.chunk.split("of"))))
    write_table(found.rename_axis("member").reset_index(), snakemake.output.chunk)
