from pathlib import Path

from maegawa2010.studies.horizon.chains import is_about
from maegawa2010.support.job import job
from precursors.proof import Certificate, ExactChain, certify
from precursors.support.files import write_whole

with job() as snakemake:
    known = {
        path: Certificate.load(path) for path in snakemake.input.get("committed", [])
    }
    params = snakemake.params
    for text, duration, output in zip(
        params.chains, params.durations, snakemake.output, strict=True
    ):
        chain = ExactChain(**text)
        fitting = [
            path
            for path, certificate in known.items()
            if is_about(certificate, chain, duration)
        ]
        if fitting:
            write_whole(output, Path(fitting[0]).read_bytes())
        else:
            certify(chain, duration).save(output)
