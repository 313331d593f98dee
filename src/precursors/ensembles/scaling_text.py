"""What runs cost, as docs/scaling.md tells it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from precursors.ensembles.scaling import growth_exponent

# Smaller chains spend much of their time on being made.
GROWS_FROM = 20


def scaling_text(costs: pd.DataFrame, maps: pd.DataFrame) -> list[str]:
    """The passages of docs/scaling.md that quote numbers: against N, against T, a new process, the maps."""
    of_kind: dict[str, list[dict[str, Any]]] = {}
    for row in costs.to_dict("records"):
        of_kind.setdefault(row["kind"], []).append({str(name): value for name, value in row.items()})
    return [
        _first_slips(of_kind["first slip"]),
        _durations(of_kind["duration"]),
        _starts(of_kind["start"]),
        _maps(of_kind["map"], maps),
    ]


def _first_slips(rows: Sequence[Mapping[str, Any]]) -> str:
    large = [row for row in rows if row["n_blocks"] >= GROWS_FROM]
    exponent = growth_exponent([row["n_blocks"] for row in large], [row["seconds_per_run"] for row in large])
    table = _table(
        ["N", "transitions of a run", "time of a run", "time of a transition"],
        [
            [
                f"{row['n_blocks']:.0f}",
                f"{row['transitions_per_run']:.0f}",
                in_words(row["seconds_per_run"]),
                in_words(row["seconds_per_transition"]),
            ]
            for row in rows
        ],
    )
    return f"{table}\nFrom N = {GROWS_FROM} on the time of a run grows as N^{exponent:.1f}.\n"


def _durations(rows: Sequence[Mapping[str, Any]]) -> str:
    cells = {(row["duration_s"], row["case"].split(",")[0]): row for row in rows}
    scenes = list(dict.fromkeys(scene for _, scene in cells))
    lines = []
    for duration in sorted({duration for duration, _ in cells}):
        times = [in_words(cells[duration, scene]["seconds_per_run"]) for scene in scenes]
        each = [cells[duration, scene]["seconds_per_transition"] for scene in scenes]
        lines.append([f"{duration:g} s", *times, f"{in_words(min(each))} to {in_words(max(each))}"])
    return _table(["T", *scenes, "time of a transition"], lines)


def _starts(rows: Sequence[Mapping[str, Any]]) -> str:
    return _table(
        ["a new process, up to and including", "processor time"],
        [[row["case"], in_words(row["seconds_per_run"])] for row in rows],
    )


def _maps(timed: Sequence[Mapping[str, Any]], maps: pd.DataFrame) -> str:
    per_run = {row["case"]: in_words(row["seconds_per_run"]) for row in timed}
    heads = [f"{n} core" if n == 1 else f"{n} cores" for n in dict.fromkeys(maps["cores"])]
    lines: dict[str, list[str]] = {}
    for row in maps.to_dict("records"):
        name = row["map"]
        line = lines.setdefault(name, [name, per_run.get(name, ""), in_words(3600.0 * row["core_hours"])])
        line.append(f"{in_words(3600.0 * row['wall_hours'])} in {row['chunks']} chunks")
    points = f"{maps['points'].iloc[0]:,}".replace(",", " ")
    return _table([f"map of {points} points", "time of a run", "core time", *heads], list(lines.values()))


def in_words(seconds: float) -> str:
    """A time with two digits and the unit that suits it."""
    units = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}
    least = {"us": 0.0, "ms": 1e-3, "s": 1.0, "min": 120.0, "h": 3600.0}
    unit = [name for name, smallest in least.items() if seconds >= smallest][-1]
    return f"{float(f'{seconds / units[unit]:.2g}'):g} {unit}"


def _table(heads: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    rows = [heads, ["---"] * len(heads), *lines]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)
