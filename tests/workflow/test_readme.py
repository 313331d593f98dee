"""What the READMEs show is true: numbers and files are those computed."""

import re
import tomllib
from pathlib import Path

import pandas as pd
import pytest
import yaml

from precursors import Chain, find_precursors, find_slips, simulate
from precursors.analysis.slips import apparent_friction, slip_table

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
NUMBERS = (ROOT / "docs/numbers.md").read_text(encoding="utf-8")
RESULTS = (ROOT / "results/README.md").read_text(encoding="utf-8")
# What the workflow makes on demand, by rule or by file.
ON_DEMAND = (
    "prove_scenes",
    "results/certificates/fig10.json.gz",
)
OF_MAKE = ("tables/bench.csv", "report.html")
ASKED_SCENE = """\
  quick:
    title: what a smaller model says
    theta: 0
    model: quasistatic
"""


def listed(scenes: list[str]) -> dict[str, re.Pattern[str]]:
    """Paths in results/README.md, each with what it stands for; names in braces are wildcards."""
    paths = [
        path
        for line in RESULTS.splitlines()
        if line.startswith("| `")
        for path in re.findall(r"`([^`]+)`", line.split(" | ")[0])
        if not path.endswith("/")
    ]

    def stands_for(path: str) -> str:
        parts = re.split(r"(\{[^}]+\})", path)
        names = {"{scene}": f"({'|'.join(scenes)})"}
        return "".join(
            re.escape(part)
            if not part.startswith("{")
            else f"({part[1:-1].replace(',', '|')})"
            if "," in part
            else names.get(part, r"[\w-]+")
            for part in parts
        )

    return {path: re.compile(stands_for(path)) for path in paths}


def rows(page: str, header: str) -> list[list[str]]:
    """Cells of the table whose header begins with some words."""
    table = page[page.index(f"| {header}") :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_the_list_of_results_is_that_of_the_workflow(workspace):
    workspace.edit("config.yaml", "\nfig13: [", f"{ASKED_SCENE}\nfig13: [")
    config = yaml.safe_load((workspace.path / "config.yaml").read_text(encoding="utf-8"))
    patterns = listed(list(config["scenes"]))
    dry_run = workspace.run("-n", "-F", "all", *ON_DEMAND)
    assert dry_run.code == 0, dry_run.text
    files = sorted(set().union(*(outputs for _, _, outputs in dry_run.plan)))
    outputs = [file.removeprefix("results/") for file in files]
    assert len(outputs) > 100
    assert [path for path in outputs if not any(p.fullmatch(path) for p in patterns.values())] == []
    made = {name for name, pattern in patterns.items() if any(map(pattern.fullmatch, outputs))}
    assert sorted(patterns.keys() - made) == sorted(OF_MAKE)


def test_the_reproduction_shown_is_the_golden_one():
    golden = pd.read_csv(ROOT / "tests/golden/reproduction.csv")
    for scene, _, events_paper, events, mu_paper, mu_sapp, time in rows(README, "scene | theta"):
        table = golden[golden["scene"] == scene].set_index("quantity")
        counted = table.loc["events counted in Fig. 13, the first global slip included"]
        friction = table.loc["apparent static friction coefficient mu_sapp"]
        assert [int(events_paper), int(events)] == [counted["paper"], counted["reproduced"]]
        assert float(mu_paper) == friction["paper"]
        assert mu_sapp == f"{friction['reproduced']:.4f}"
        assert time == f"{table.loc['time of the first global slip', 'reproduced']:.3f}"


@pytest.mark.parametrize(("theta", "events", "mu_sapp", "end"), rows(NUMBERS, "theta | events counted | mu"))
def test_the_fragile_scene_is_as_fragile_as_shown(theta, events, mu_sapp, end):
    run = simulate(Chain.from_slider(theta=theta), until="global slip")
    slips = find_slips(run)
    assert int(events) == len(find_precursors(slips))
    assert mu_sapp == f"{apparent_friction(slip_table(run)).mu_sapp:.4f}"
    assert end == f"{run.duration:.3f}"


def test_files_that_are_linked_exist():
    links = [
        link for link in re.findall(r"\]\(([^)#]+)", README) if not link.startswith(("http", "../../actions"))
    ]
    assert len(links) >= 5
    assert [link for link in links if not (ROOT / link).is_file()] == []


def test_the_paper_is_cited_with_its_doi():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    (paper,) = citation["references"]
    assert {"title", "authors", "license", "abstract"} <= citation.keys()  # what an archive asks for
    assert [author["family-names"] for author in paper["authors"]] == ["Maegawa", "Suzuki", "Nakano"]
    assert f"doi:{paper['doi']}" in README


def test_the_version_to_cite_is_that_of_the_package_and_of_the_changelog():
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    (latest, *_) = re.findall(r"^## \[([^\]]+)\]", changelog, flags=re.MULTILINE)
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))["version"]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert latest == cited == project["version"]
    assert project["license"] == "MIT"
    assert f"version {cited}, commit" in " ".join(README.split())
