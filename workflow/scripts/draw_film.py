"""Draw the film of a scene: its farthest precursor and its first global slip in slow motion."""

from pathlib import Path

from job import job

from precursors.figures.film import film_clips, write_film
from precursors.solver.run import Run


def main(run: str | Path, output: str | Path) -> None:
    """Write the film of a run as a GIF."""
    write_film(film_clips(Run.load(run)), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.run, snakemake.output.film)
