"""Print what the paper prints beside what was reproduced, and where the figures are."""

from __future__ import annotations

import csv
import io
import sys
from pathlib import Path


def main(table: str | Path, figures: str | Path) -> None:
    """Print the table of the reproduction for reading, four digits a number."""
    header, *rows = csv.reader(io.StringIO(Path(table).read_text(encoding="utf-8"), newline=""))
    cells = [header]
    for scene, theta, quantity, unit, paper, reproduced in rows:
        cells.append([scene, digits(theta), quantity, unit, digits(paper), digits(reproduced)])
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    for line in cells:
        print("  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=True)).rstrip())
    print(f"Figures: {', '.join(sorted(path.name for path in Path(figures).glob('*.svg')))} in {figures}")


def digits(number: str) -> str:
    """Write a number with four digits, and none as a dash."""
    return f"{float(number):.4g}" if number else "-"


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except (ValueError, OSError) as error:
        sys.exit(f"reproduction: {error}")
