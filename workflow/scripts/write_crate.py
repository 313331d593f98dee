"""Write the metadata that make the results an RO-Crate."""

from pathlib import Path

from job import job

from precursors.support.crate import write_crate
from precursors.support.files import read_json


def main(provenance: str | Path, output: str | Path) -> None:
    """Write the metadata beside the provenance."""
    write_crate(read_json(provenance), Path(output).parent)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.provenance, snakemake.output.metadata)
