"""Draw Fig. 9: the chain, its drive and its loads."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.chain_schematic import draw_chain_schematic


def main(outputs: Sequence[str | Path]) -> None:
    """Draw the schematic, once for each file name."""
    figure = draw_chain_schematic()
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.output)
