"""Draw the spread of mu_sapp and of the events kept, one figure per question."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.spread import SPREAD_COLUMNS, draw_spread, read_members


def main(
    members: str | Path, spread: str | Path, questions: Sequence[str], outputs: Sequence[str | Path]
) -> None:
    """Draw the figure of a question into each file."""
    tables = read_members(members), style.read_columns(spread, SPREAD_COLUMNS)
    figures = {question: draw_spread(*tables, question) for question in set(questions)}
    for question, output in zip(questions, outputs, strict=True):
        style.save(figures[question], output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.input.members,
            snakemake.input.spread,
            snakemake.params.questions,
            snakemake.output,
        )
