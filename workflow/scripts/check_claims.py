"""Check the existing results without recomputing them: print every claim with its
verdict (`make check`).

The exit code is 1 if a verdict is not the expected one.
"""

import json
import sys
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
from maegawa2010.scenes import is_papers
from maegawa2010.support.provenance import NOT_RESULTS, checksums
from precursors.support.files import read_table

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


def main(
    tables: str | Path = "results/tables",
    expected: str | Path = "tests/golden/claims.csv",
) -> None:
    """Print the claims by the tables of a directory, and exit with 1 if a verdict is
    unexpected."""
    results = Path(tables).parent
    made = results / "provenance.json"
    told = json.loads(made.read_text(encoding="utf-8")) if made.is_file() else {}
    if told and not is_papers(told["config"], SCENES):
        sys.exit("check: config.yaml is not the paper's: nothing to compare")
    try:
        again = comparisons(tables)
        found = evaluate(
            {name: read_table(Path(tables, f"{name}.csv")) for name in CLAIM_TABLES}
            | again
        )
    except FileNotFoundError as error:
        sys.exit(f"check: {error.filename} is missing: run make all first")
    except (OSError, ValueError) as error:
        sys.exit(f"check: {error}")
    print(printed(found))
    if again:
        print(f"\nCommitted tables: {agreement(pd.concat(again.values()))}.")
    unexpected = differences(found, read_table(expected))
    unexpected += changed(results, told.get("outputs", {}))
    if unexpected:
        sys.exit("\n".join(f"check: {line}" for line in unexpected))


def changed(results: Path, told: Mapping[str, str]) -> list[str]:
    """Results whose checksums are not those told, a line each."""
    there = checksums(results.rglob("*"), results, leave_out=NOT_RESULTS)
    return [
        f"{results / name} is not as it was made: delete it, and run make all"
        for name in told
        if name in there and there[name] != told[name]
    ]


def printed(claims: pd.DataFrame) -> str:
    """Each claim under the heading of its kind: section, statement, verdict, numbers,
    and its shares of the ensembles; then the totals."""
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
    """The verdict, the value found, the rule, the shares of the ensembles, and the
    note."""
    unit = "" if claim["unit"] == "1" else f" {claim['unit']}"
    of = f" ({claim['of']})" if claim["of"] else ""
    found = f"found {claim['ours']}{unit}{of}; rule: {claim['rule']}."
    shares = [
        f"{100 * float(claim[f'{name}_share']):.0f}\N{NO-BREAK SPACE}% of the {runs}"
        for name, runs in RUNS.items()
        if claim[f"{name}_share"]
    ]
    agree = f" Agree: {', '.join(shares)}." if shares else ""
    note = f" {claim['note']}" if claim["note"] else ""
    return f"{claim['verdict_text'].upper()}: {found}{agree}{note}"


if __name__ == "__main__":
    main(*sys.argv[1:])
