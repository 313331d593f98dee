"""Draw a scene: the tangential load, and when and where blocks slipped (Figs. 10-12)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.figures import style
from precursors.figures.scene import draw_scene


def main(
    slips: str | Path, trace: str | Path, slider: dict[str, Any], title: str, outputs: Sequence[str | Path]
) -> None:
    """Draw the tables of a scene, once for each file name."""
    figure = draw_scene(
        style.read_slips(slips),
        style.read_trace(trace),
        n_blocks=slider["n_blocks"],
        length_m=slider["length"],
        label=f"{style.theta_text(slider['theta'])}: {style.plain(title)}",
    )
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.input.slips,
            snakemake.input.trace,
            snakemake.params.slider,
            snakemake.params.title,
            snakemake.output,
        )
