"""Results that the documents in paper/ cite: tables and figures."""

import re
from pathlib import Path


def cited_results(document: Path) -> list[str]:
    """Paths of the tables and figures that a Typst file names in calls of the functions
    of paper/lib.typ; figures are the arguments of `drawn`."""
    text = document.read_text(encoding="utf-8")
    tables = re.findall(r'\b(?:rows|row|value|num|share)\(\s*"(\w+)"', text)
    figures = re.findall(r'"(\w+)"', " ".join(re.findall(r"\bdrawn\(([^)]*)\)", text)))
    paths = [f"results/tables/{name}.csv" for name in tables]
    return sorted({*paths, *(f"results/figures/{name}.svg" for name in figures)})
