"""Tables and figures that a document of paper/ shows."""

import re
from pathlib import Path


def results_shown(document: Path) -> list[str]:
    """Results that a Typst file names in the words of paper/lib.typ: tables, and the
    figures in `drawn`."""
    text = document.read_text(encoding="utf-8")
    tables = re.findall(r'\b(?:rows|row|value|num|share)\(\s*"(\w+)"', text)
    figures = re.findall(r'"(\w+)"', " ".join(re.findall(r"\bdrawn\(([^)]*)\)", text)))
    paths = [f"results/tables/{name}.csv" for name in tables]
    return sorted({*paths, *(f"results/figures/{name}.svg" for name in figures)})
