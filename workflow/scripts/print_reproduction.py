"""Print the paper's numbers beside ours, where the slider is not the paper's, and where the figures are."""

from __future__ import annotations

import sys
from pathlib import Path

from precursors.reproduction.subject import changes
from precursors.support.files import read_json, read_table


def main(table: str | Path, figures: str | Path, provenance: str | Path) -> None:
    """Print the table of the reproduction for reading, four digits a number."""
    found = read_table(table).rename_axis(index=None).set_index("scene")
    print(found.to_string(float_format="{:.4g}".format, na_rep="-", justify="left", index_names=False))
    if changed := ", ".join(changes(read_json(provenance)["config"])):
        print(f"Not the paper's slider: {changed}")
    print(f"Figures: {', '.join(sorted(path.name for path in Path(figures).glob('*.svg')))} in {figures}")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except (ValueError, OSError) as error:
        sys.exit(f"reproduction: {error}")
