"""The table of results in docs/benchmark.md, from results/tables/benchmark.csv."""

import re

import pandas as pd
from places import ROOT

PAGE = ROOT / "docs/benchmark.md"
PROBLEMS = (
    "trailing",
    "uniform",
    "leading",
    "fast_drive",
    "stiff_drive",
    "slippery",
    "three_blocks",
    "twenty_blocks",
)
BEGIN = "| solver | setting |"


def results_table(scores: pd.DataFrame) -> str:
    """Lines of the table: right transitions, and the error up to the global slip."""
    true = scores.groupby("problem")["transitions_true"].first()
    lines = [
        f"{BEGIN} {' | '.join(PROBLEMS)} |",
        "|---" * (len(PROBLEMS) + 2) + "|",
        f"| the proof | | {' | '.join(str(true[name]) for name in PROBLEMS)} |",
    ]
    for (label, setting), of in scores.groupby(["label", "setting"], sort=False):
        of = of.set_index("problem")
        cells = [
            f"{of['transitions_right'][name]} "
            f"({of['time_error_to_global_slip_s'][name]:.0e})"
            if name in of.index
            else "-"
            for name in PROBLEMS
        ]
        lines.append(f"| {label} | {setting} | {' | '.join(cells)} |")
    return "\n".join(lines)


def write(scores: pd.DataFrame) -> None:
    """Replace the table of the page."""
    text = PAGE.read_text(encoding="utf-8")
    old = re.search(rf"{re.escape(BEGIN)}.*?(?=\n\n)", text, flags=re.DOTALL)
    assert old, f"{PAGE.name} has no table of results"
    PAGE.write_text(text.replace(old[0], results_table(scores)), encoding="utf-8")
