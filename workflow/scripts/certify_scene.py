"""Prove the transitions of a scene and write the certificate."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.accuracy.proof import ExactChain, certify


def main(chain: Mapping[str, Any], duration: float, output: str | Path) -> None:
    """Prove the run of a chain, given as fractions, for `duration` [s]."""
    certify(ExactChain.from_text(chain), duration).save(output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.params.chain, snakemake.params.duration, snakemake.output.certificate)
