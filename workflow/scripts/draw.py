"""Draw the figures of a section, as the list in workflow/rules/figures.smk has them."""

import gc
from collections.abc import Mapping, Sequence
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from job import job, read

from precursors.figures import style


def main(
    module: str,
    outputs: Sequence[str | Path],
    readers: Mapping[str, str],
    tables: Mapping[str, Any],
    options: Mapping[str, Any],
    look: Mapping[str, Any],
) -> None:
    """Draw the tables, once for each file name; several files under one name become a list of tables."""
    asked = {"look": style.Look(**look)} if look else {}
    draw = resolve_name(f"precursors.figures.{module}:draw")
    drawn = draw(**read(tables, readers), **options, **asked)
    for output in outputs:
        style.save(drawn, output, **asked)


if __name__ == "__main__":
    gc.disable()  # looking for garbage among a figure's many objects takes a seventh of the time
    with job() as snakemake:
        for name, figure in snakemake.params.figures.items():
            files = [file for file in snakemake.output if Path(file).stem == name]
            arguments = [figure.get(key, {}) for key in ("tables", "options", "look")]
            main(figure.get("module", name), files, snakemake.params.readers, *arguments)
