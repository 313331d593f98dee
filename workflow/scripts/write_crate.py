"""Write the metadata that make the results an RO-Crate."""

import json
from pathlib import Path

from job import job

from precursors.crate import write_crate


def main(provenance: str | Path, output: str | Path) -> None:
    """Write the metadata beside the provenance."""
    write_crate(json.loads(Path(provenance).read_text(encoding="utf-8")), Path(output).parent)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.provenance, snakemake.output.metadata)
