"""Measure what runs cost, and work out what large maps cost."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job  # before NumPy: it sets the number of threads

# isort: split

from precursors.ensembles.scaling import measure_costs, time_of_maps
from precursors.ensembles.scaling_text import scaling_text
from precursors.support.files import write_table, write_whole


def main(config: Mapping[str, Any], costs: str | Path, maps: str | Path, text: str | Path) -> None:
    """Write the measured times, what follows from them for maps, and both as docs/scaling.md has them."""
    settings = config["scaling"]
    table = measure_costs(config)
    timed = table[table["kind"] == "map"]
    measured = dict(zip(timed["case"], timed["seconds_per_run"], strict=True))
    write_table(table, costs)
    large = time_of_maps(measured, settings["points"], settings["cores"], settings["seconds_per_job"])
    write_table(large, maps)
    with write_whole(text) as temporary:
        temporary.write_text("\n".join(scaling_text(table, large)), encoding="utf-8")


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.config, snakemake.output.costs, snakemake.output.maps, snakemake.output.text)
