"""Shared by the scripts that run a chunk of a study of many runs."""

from maegawa2010.studies.members import Study
from maegawa2010.studies.runs import run_members
from precursors.support.files import write_table


def run_chunk(study: Study, chunk: str, path: str) -> None:
    """Run one chunk of a study, "1of4" to "4of4": every n-th member, a row each with
    what its run gave."""
    i, n = map(int, chunk.split("of"))
    found = run_members(study.chunk(i, n))
    write_table(found.rename_axis("member").reset_index(), path)
