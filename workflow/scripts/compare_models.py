"""Ask every model what it answers, for the scenes of Fig. 13: one row per scene, question and model."""

from job import job

from precursors.hierarchy.compare_models import compare_models
from precursors.model.chain import Chain
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        params = snakemake.params
        chains = {name: Chain.from_slider(**slider) for name, slider in params.sliders.items()}
        table = compare_models(chains, params.tolerances, rounds=params.repetitions)
        write_table(table, snakemake.output.table)
