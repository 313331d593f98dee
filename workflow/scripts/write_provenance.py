"""Write where the results come from."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.support.files import write_whole
from precursors.support.provenance import provenance


def main(config: Mapping[str, Any], root: str, output: str | Path) -> None:
    """Write versions, machine, configuration and checksums as JSON."""
    with write_whole(output) as temporary:
        text = json.dumps(provenance(config, root, Path(output).parent), indent=1, ensure_ascii=False)
        temporary.write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.config, snakemake.params.root, snakemake.output.json)
