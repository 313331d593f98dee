"""Write docs/figures.md: the rule and the modules that make each figure, from a dry run of the workflow."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

DRY_RUN = ("-n", "-F", "all", "results/films/fig10.gif")
MANY = 4  # files of one kind that are still listed one by one
PAGES = ("results/explorer.html", "results/paper.pdf")
HEADER = """\
# Figures, and what makes them

Written by `make docs` from a dry run of the workflow; a test fails where it is stale. A rule runs a thin
script, modules of `src/precursors/` draw, and `tables/` and the like are files in `results/`.

| figure | rule | script | drawn by | from |
|---|---|---|---|---|
"""


def main(listing: str, root: Path) -> str:
    """Return the page, from what `snakemake -n -F` prints; rules and scripts are looked up in `root`."""
    files = _rule_files(root)
    lines = []
    for rule, inputs, outputs in _jobs(listing):
        code = [name.partition("src/precursors/")[2] for name in inputs if "src/precursors/" in name]
        drawing = [
            name for name in code if re.match(r"(figures|explorer|paper)/(?!style|__init__)\w+\.py", name)
        ]
        data = _shortened([name.removeprefix("results/") for name in inputs if name.startswith("results/")])
        for output in filter(_is_figure, outputs):
            made_by, script = files[rule]
            name = Path(output).stem if output.endswith(".svg") else Path(output).name
            cells = [
                f"`{name}`",
                f"[{rule}](../{made_by})",
                f"[{Path(script).name}](../{script})",
                ", ".join(f"[{Path(module).stem}](../src/precursors/{module})" for module in drawing),
                ", ".join(f"`{name}`" for name in data) if data else "the configuration",
            ]
            lines.append(f"| {' | '.join(cells)} |")
    return HEADER + "".join(f"{line}\n" for line in sorted(lines))


def dry_run(root: Path) -> str:
    """What Snakemake would run, had nothing been made yet."""
    command = [sys.executable, "-m", "snakemake", *DRY_RUN]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ValueError((done.stderr or done.stdout).strip().splitlines()[-1])
    return done.stdout + done.stderr


def _jobs(listing: str) -> Iterator[tuple[str, list[str], list[str]]]:
    """Rule, inputs and outputs of every job."""
    for block in re.split(r"^(?=(?:local)?rule )", listing, flags=re.MULTILINE)[1:]:
        rule = block.partition(":")[0].split()[1]
        inputs, outputs = (
            found[1].split(", ") if (found := re.search(rf"^    {kind}: (.+)$", block, re.MULTILINE)) else []
            for kind in ("input", "output")
        )
        yield rule, inputs, outputs


def _shortened(files: list[str]) -> list[str]:
    """Files in order, and in place of many of one kind the kind."""
    kinds = Counter(_kind(file) for file in files)
    return sorted({_kind(file) if kinds[_kind(file)] > MANY else file for file in files})


def _kind(file: str) -> str:
    path = Path(file)
    return (path.parent / f"*{path.suffix}").as_posix()


def _is_figure(file: str) -> bool:
    return file in PAGES or bool(re.fullmatch(r"results/(figures/.+\.svg|films/.+)", file))


def _rule_files(root: Path) -> dict[str, tuple[str, str]]:
    """File and script of every rule that has a script."""
    found = {}
    for file in sorted((root / "workflow/rules").glob("*.smk")):
        for text in re.split(r"^rule ", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            script = re.search(r'"\.\./(scripts/\w+\.py)"', text)
            if script:
                name = text.partition(":")[0]
                found[name] = (f"workflow/rules/{file.name}", f"workflow/{script[1]}")
    return found


if __name__ == "__main__":
    here = Path(__file__).parents[2]
    try:
        (here / "docs/figures.md").write_text(main(dry_run(here), here), encoding="utf-8")
    except (ValueError, OSError) as error:
        sys.exit(f"docs/figures.md: {error}")
