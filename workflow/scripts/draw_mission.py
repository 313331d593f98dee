"""Draw the mission: a box for each file of rules, and an arrow to each file that needs what it makes."""

import re
import subprocess
import sys
from pathlib import Path

from job import job

from precursors.figures import mission
from precursors.support.files import write_text


def main(snakefile: Path, output: str) -> None:
    """Draw the graph of all rules that Snakemake prints."""
    command = [sys.executable, "-m", "snakemake", "all", "--rulegraph", "mermaid-js", "--nolock"]
    shown = subprocess.run(
        [*command, "-s", snakefile.name], cwd=snakefile.parent, capture_output=True, text=True
    )
    write_text(output, picture(shown.stdout, snakefile))


def picture(graph: str, snakefile: Path) -> str:
    """Draw a graph of rules in Mermaid's language; the first line of a file of rules says what they make."""
    included = re.findall(r'^include: "(.+/(\w+)\.smk)"', snakefile.read_text(encoding="utf-8"), re.MULTILINE)
    texts = {name: (snakefile.parent / file).read_text(encoding="utf-8") for file, name in included}
    boxes = {name: text.splitlines()[0].removeprefix("# ") for name, text in texts.items()}
    home = {
        rule: name for name, text in texts.items() for rule in re.findall(r"^rule (\w+):", text, re.MULTILINE)
    }
    rules = dict(re.findall(r"(id\d+)\[(\w+)\]", graph))
    # Rules without a name of their own draw figures.
    place = {
        key: "figures" if rule.startswith("draw_") else home.get(rule, "") for key, rule in rules.items()
    }
    arrows = [(place[before], place[after]) for before, after in re.findall(r"(id\d+) --> (id\d+)", graph)]
    edges = {(before, after) for before, after in arrows if before != after and before and after}
    if not edges:
        raise ValueError("Snakemake printed no graph of rules")
    return mission.draw(boxes, sorted(edges))


if __name__ == "__main__":
    with job() as snakemake:
        main(Path(snakemake.input.snakefile), snakemake.output[0])
