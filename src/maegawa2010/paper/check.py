"""Check existing results (`make check`): judge the claims by the tables, and find files
that have changed since they were made."""

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from textwrap import fill, indent
from typing import Any

import pandas as pd

from maegawa2010.paper.claim import EXPERIMENT, IN_WORDS, READINGS, RESULT
from maegawa2010.paper.claims import differences, evaluate
from maegawa2010.paper.committed import agreement, comparisons
from maegawa2010.paper.inputs import CLAIM_TABLES, SCENES
from maegawa2010.scenes import is_paper_slider
from maegawa2010.support.provenance import NOT_RESULTS, checksums
from precursors.support.files import AnyPath, read_table

WIDTH = 110
HEADINGS = {
    READINGS: "Numbers that chose our readings",
    RESULT: "Claims about the model",
    EXPERIMENT: "Beside the experiment",
}
RUNS = {
    "noise": "runs with 0.1 % noise",
    "digits": "sliders with the same printed inputs",
}


def check(results: Path, expected: AnyPath) -> tuple[str, list[str]]:
    """Return the claims as text, and a line for each thing that is wrong: an unexpected
    verdict, or a file that has changed since it was made.

    Raises
    ------
    FileNotFoundError
        If a table is missing.
    ValueError
        If a table cannot be read, or the results are of another slider.
    """
    path = results / "provenance.json"
    made = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    if made and not is_paper_slider(made["config"], SCENES):
        raise ValueError("config.yaml is not the paper's: nothing to compare")
    tables = {name: read_table(results / f"tables/{name}.csv") for name in CLAIM_TABLES}
    again = comparisons(results / "tables")
    claims = evaluate(tables | again)
    wrong = differences(claims, read_table(expected))
    text = in_words(claims)
    if again:
        text += f"\n\n{agreement(pd.concat(again.values()))}"
    if made:
        newer, changed = changes(results, path.stat().st_mtime, made["outputs"])
        if newer:
            text += f"\n\n{files(newer)} newer than provenance.json: run make all"
        wrong += [
            f"{results / name} has changed since it was made: delete it and run make all"
            for name in changed
        ]
    return text, wrong


def changes(
    results: Path, time: float, made: Mapping[str, str]
) -> tuple[list[str], list[str]]:
    """Names of results whose checksum is no longer that in `made`, in two lists.

    The first has figures and runs newer than `time`, for example figures in another
    size. The second has all others.
    """
    there = checksums(results.rglob("*"), results, leave_out=NOT_RESULTS)
    other = [name for name in made if there.get(name, made[name]) != made[name]]
    newer = [
        name
        for name in other
        if not name.startswith("tables/") and (results / name).stat().st_mtime > time
    ]
    return newer, [name for name in other if name not in newer]


def files(names: list[str]) -> str:
    """How many files, as the subject of a sentence."""
    return f"{names[0]} is" if len(names) == 1 else f"{len(names)} results are"


def in_words(claims: pd.DataFrame) -> str:
    """Write each claim under the heading of its kind, and then the totals."""
    texts = claims.astype(object).where(claims.notna(), "").astype(str)
    lines, totals = [], [""]
    number = 0
    for kind, of_kind in texts.groupby("kind", sort=False):
        heading = HEADINGS[str(kind)]
        lines += ["", heading, ""]
        for claim in of_kind.to_dict("records"):
            number += 1
            lines.append(f"{number:2d}  {claim['statement']}")
            lines.append(f"    [{claim['claim']}]  {claim['section']}")
            lines.append(indent(fill(evidence(claim), WIDTH - 4), " " * 4))
        verdicts = Counter(of_kind["verdict"])
        counts = ", ".join(
            f"{words} {verdicts[verdict]}"
            for verdict, words in IN_WORDS[str(kind)].items()
            if verdicts[verdict]
        )
        totals.append(f"{heading}: {len(of_kind)} ({counts})")
    return "\n".join(lines[1:] + totals)


def evidence(claim: Mapping[Any, str]) -> str:
    """The verdict, our value, the rule, the shares of the ensembles, and the note."""
    unit = "" if claim["unit"] == "1" else f" {claim['unit']}"
    of = f" ({claim['of']})" if claim["of"] else ""
    value = f"found {claim['ours']}{unit}{of}; rule: {claim['rule']}."
    shares = [
        f"{100 * float(claim[f'{name}_share']):.0f}\N{NO-BREAK SPACE}% of the {runs}"
        for name, runs in RUNS.items()
        if claim[f"{name}_share"]
    ]
    agree = f" Agree: {', '.join(shares)}." if shares else ""
    note = f" {claim['note']}" if claim["note"] else ""
    return f"{claim['verdict_text'].upper()}: {value}{agree}{note}"
