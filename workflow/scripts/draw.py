"""Draw the figures of a section."""

import gc
from pathlib import Path
from pkgutil import resolve_name

from job import job, read

from precursors.figures import style

# looking for garbage among a figure's many objects takes a seventh of the time
gc.disable()
with job() as snakemake:
    for name, figure in snakemake.params.figures.items():
        asked = {"look": style.Look(**figure["look"])} if figure["look"] else {}
        draw = resolve_name(figure["function"])
        tables = read(figure["tables"], snakemake.params.readers)
        drawn = draw(**tables, **figure["options"], **asked)
        for output in snakemake.output:
            if Path(output).stem == name:
                style.save(drawn, output, **asked, title=figure["shows"])
