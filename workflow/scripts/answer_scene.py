"""Ask the model of a scene all that it answers: one row per number."""

from job import job

from precursors.hierarchy.models import answers_table
from precursors.model.chain import Chain
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        chain = Chain.from_slider(**snakemake.params.slider)
        write_table(answers_table(chain, snakemake.params.model), snakemake.output.table)
