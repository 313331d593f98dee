from pathlib import Path

from maegawa2010.paper.committed import provenance_table
from maegawa2010.support.job import job
from precursors.support.checkout import git_state
from precursors.support.files import read_bytes, write_table, write_whole

with job() as snakemake:
    inputs, outputs, params = snakemake.input, snakemake.output, snakemake.params
    # Ignore paper/tables: Snakemake has deleted its tables before this job.
    state = git_state(Path(params.root), ignored="paper/tables")
    state = state or {"commit": "unknown", "changed": False}
    commit = f"{state['commit']}{', changed' if state['changed'] else ''}"
    for made, published in zip(inputs.tables, outputs.tables, strict=True):
        write_whole(published, read_bytes(made))
    table = provenance_table(inputs.tables, params.origins, commit)
    write_table(table, outputs.provenance)
