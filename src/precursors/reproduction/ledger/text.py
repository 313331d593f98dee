"""The ledger for reading, statements in full."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from textwrap import fill

import pandas as pd

from precursors.reproduction.ledger.rules import KINDS, VERDICTS

WIDTH = 110
INDENT = "    "


def ledger_text(ledger: pd.DataFrame) -> str:
    """Every claim of a ledger, its statement in full, and how many of each kind have which verdict."""
    return "\n".join([*_entries(ledger), *_kinds(ledger)])


def counted(claims: pd.DataFrame) -> str:
    """How many of some claims have each verdict."""
    counts = Counter(claims["verdict"])
    return ", ".join(f"{counts[name]} {name}" for name in VERDICTS if name in counts) or "none"


def _entries(ledger: pd.DataFrame) -> Iterator[str]:
    """A claim for reading: its verdict, where it stands, what it says, and both numbers."""
    for number, (_, claim) in enumerate(ledger.iterrows(), start=1):
        paper, ours = (_with_unit(claim[key], claim["unit"]) for key in ("paper", "ours"))
        lines = [
            f"{number:2d}  {claim['verdict'].upper()}  [{claim['id']}]  {claim['where']}",
            claim["statement"],
            f"paper: {paper}   ours: {ours}   ({claim['rule']})",
        ]
        for i, line in enumerate(lines):
            yield fill(line, WIDTH, initial_indent=INDENT if i else "", subsequent_indent=INDENT)


def _kinds(ledger: pd.DataFrame) -> Iterator[str]:
    for name, meaning in KINDS.items():
        of_kind = ledger[ledger["kind"] == name]
        yield fill(f"{len(of_kind)} of kind {name} ({meaning}): {counted(of_kind)}", WIDTH)


def _with_unit(text: str, unit: str) -> str:
    """Write the unit behind numbers, and a dash for none."""
    is_number = text[:1].isdigit() or text[:1] == "-"
    return f"{text} {unit}" if is_number and unit not in ("", "1") else text or "-"
