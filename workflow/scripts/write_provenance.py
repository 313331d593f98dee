import json
from pathlib import Path

from maegawa2010.support.job import job
from maegawa2010.support.provenance import provenance
from precursors.support.files import write_text

with job() as snakemake:
    output = Path(snakemake.output.json)
    record = provenance(snakemake.config, Path(snakemake.params.root), output.parent)
    write_text(output, json.dumps(record, indent=1))
