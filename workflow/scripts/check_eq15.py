"""Check Eq. 15 for some scenes, one row per check, and tabulate the load against the speed of the drive."""

from job import job

from precursors.reproduction.eq15 import drive_speeds_table, eq15_table
from precursors.solver.run import Run
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        paths = zip(snakemake.params.scenes, snakemake.input.runs, strict=True)
        runs = {scene: Run.load(path) for scene, path in paths}
        speeds = drive_speeds_table({scene: run.chain for scene, run in runs.items()})
        write_table(speeds, snakemake.output.speeds)
        write_table(eq15_table(runs, snakemake.params.duration, speeds), snakemake.output.table)
