"""Take over the committed certificates that are about the very chains asked for; prove the others."""

import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.accuracy.proof import Certificate, ExactChain, certify
from precursors.accuracy.proof.chains import is_about
from precursors.support.files import write_whole


def main(
    committed: Iterable[str | Path],
    chains: Iterable[Mapping[str, Any]],
    durations: Iterable[float],
    outputs: Iterable[str | Path],
) -> None:
    """Write the certificate of each chain, given as fractions, for its duration [s]."""
    known = {path: Certificate.load(path) for path in committed}
    for text, duration, output in zip(chains, durations, outputs, strict=True):
        chain = ExactChain.from_text(text)
        fitting = [path for path, certificate in known.items() if is_about(certificate, chain, duration)]
        if fitting:
            with write_whole(output) as temporary:
                shutil.copyfile(fitting[0], temporary)
        else:
            certify(chain, duration).save(output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.input.get("committed", []),
            snakemake.params.chains,
            snakemake.params.durations,
            snakemake.output,
        )
