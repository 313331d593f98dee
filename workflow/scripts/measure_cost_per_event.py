"""Time the transitions of longer and longer chains."""

from job import job  # before NumPy: it sets the number of threads

# isort: split

from precursors.accuracy.cost_per_event import measure_cost
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        write_table(measure_cost(), snakemake.output.table)
