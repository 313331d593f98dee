"""What the READMEs show is true: numbers and files are those computed."""

from pathlib import Path

import pandas as pd
import pytest
import yaml

from precursors import Chain, apparent_friction, find_precursors, find_slips, simulate

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
NUMBERS = (ROOT / "docs/numbers.md").read_text(encoding="utf-8")


def rows(page: str, header: str) -> list[list[str]]:
    """Cells of the table whose header begins with some words."""
    table = page[page.index(f"| {header}") :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_the_reproduction_shown_is_the_golden_one():
    golden = pd.read_csv(ROOT / "tests/golden/reproduction.csv")
    for scene, _, events_paper, events, mu_paper, mu_sapp, time in rows(
        README, "scene | theta"
    ):
        table = golden[golden["scene"] == scene].set_index("quantity")
        counted = table.loc["events_counted"]
        friction = table.loc["mu_sapp"]
        assert [int(events_paper), int(events)] == [
            counted["paper"],
            counted["reproduced"],
        ]
        assert float(mu_paper) == friction["paper"]
        assert mu_sapp == f"{friction['reproduced']:.4f}"
        assert time == f"{table.loc['global_slip_s', 'reproduced']:.3f}"


@pytest.mark.parametrize(
    ("theta", "events", "mu_sapp", "end"), rows(NUMBERS, "theta | events counted | mu")
)
def test_the_fragile_scene_is_as_fragile_as_shown(theta, events, mu_sapp, end):
    run = simulate(Chain.from_slider(theta=theta), until="global slip")
    slips = find_slips(run)
    assert int(events) == len(find_precursors(slips))
    assert mu_sapp == f"{apparent_friction(run):.4f}"
    assert end == f"{run.duration:.3f}"


def test_every_file_that_an_independent_check_compares_is_made_by_the_workflow_and_kept(
    untouched,
):
    text = (ROOT / "codecheck.yml").read_text(encoding="utf-8")
    manifest = yaml.safe_load(text)["manifest"]
    files = {entry["file"] for entry in manifest if entry["comment"]}
    assert len(files) == len(manifest) > 10
    assert files <= untouched[1].made
    kept = {path.name for path in (ROOT / "tests/golden").iterdir()}
    assert {Path(file).name for file in files} <= kept
