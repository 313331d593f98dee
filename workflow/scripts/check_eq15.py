"""Check the derivation of Eq. 15 and write it: everything as JSON, one line a claim as CSV."""

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from job import job

from precursors.model.chain import Chain
from precursors.reproduction.eq15 import check_eq15, table
from precursors.support.files import write_table, write_whole


def main(scenes: Mapping[str, Chain], duration: float, json_path: str | Path, csv_path: str | Path) -> None:
    """Write the checks for the chains of some scenes, each pushed for at most `duration` [s]."""
    checks = check_eq15(scenes, duration)
    claims = [dataclasses.asdict(row) for row in table(checks)]
    text = json.dumps({"claims": claims, **dataclasses.asdict(checks)}, indent=1, allow_nan=False)
    with write_whole(json_path) as temporary:
        temporary.write_text(text + "\n", encoding="utf-8")
    write_table(pd.DataFrame(claims), csv_path)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            {name: Chain.from_slider(**slider) for name, slider in snakemake.params.sliders.items()},
            snakemake.params.duration,
            snakemake.output.json,
            snakemake.output.csv,
        )
