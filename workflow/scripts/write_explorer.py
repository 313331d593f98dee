"""Write the explorer: one HTML page to look into the runs of all scenes with."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from job import job

from precursors.figures.explorer import Scene, write_explorer
from precursors.solver.run import Run


def main(
    runs: Sequence[str | Path], titles: Mapping[str, str], thetas: Mapping[str, float], output: str | Path
) -> None:
    """Write the page; the scenes are the keys of `titles` and `thetas`, in the order of `runs`."""
    scenes = [
        Scene(name, title, thetas[name], Run.load(run))
        for run, (name, title) in zip(runs, titles.items(), strict=True)
    ]
    write_explorer(scenes, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.runs, snakemake.params.titles, snakemake.params.thetas, snakemake.output.page)
