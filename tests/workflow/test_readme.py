"""What the README shows is true: its code runs, its scene is a scene, its numbers are those computed."""

import re
from pathlib import Path

import pandas as pd
import pytest
import yaml

from precursors import Chain, find_precursors, find_slips, simulate
from precursors.slips import apparent_friction

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    (text,) = re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)
    return text


def rows(header: str) -> list[list[str]]:
    """Cells of the table whose header begins with some words."""
    table = README[README.index(f"| {header}") :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_the_code_runs_and_prints_what_is_shown(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert len(block("python").splitlines()) <= 11
    exec(block("python"), {})
    assert capsys.readouterr().out == block("text")
    assert (tmp_path / "results/runs/mine.h5").is_file()


def test_the_scene_to_add_is_four_lines_that_make_a_figure(workspace):
    scene = block("yaml")
    assert len(scene.splitlines()) == 4
    (name,) = yaml.safe_load(scene)
    workspace.edit("config.yaml", "\nfig13: [", f"{scene}\nfig13: [")
    jobs = workspace.would_run()
    assert {f"simulate_scene {name}", f"draw_scene {name}"} <= jobs


def test_the_reproduction_shown_is_the_golden_one():
    golden = pd.read_csv(ROOT / "tests/golden/reproduction.csv")
    for scene, _, events_paper, events, mu_paper, mu_sapp, time in rows("scene | theta"):
        table = golden[golden["scene"] == scene].set_index("quantity")
        kept = table.loc["events kept, the first global slip included"]
        friction = table.loc["apparent static friction coefficient mu_sapp"]
        assert [int(events_paper), int(events)] == [kept["paper"], kept["reproduced"]]
        assert float(mu_paper) == friction["paper"]
        assert mu_sapp == f"{friction['reproduced']:.4f}"
        assert time == f"{table.loc['time of the first global slip', 'reproduced']:.3f}"


@pytest.mark.parametrize(("theta", "events", "mu_sapp", "end"), rows("theta | events kept | mu"))
def test_the_fragile_scene_is_as_fragile_as_shown(theta, events, mu_sapp, end):
    run = simulate(Chain.from_slider(theta=theta), until="global slip")
    slips = find_slips(run)
    assert int(events) == len(find_precursors(slips))
    assert mu_sapp == f"{apparent_friction(run, slips).mu_sapp:.4f}"
    assert end == f"{run.duration:.3f}"


def test_files_that_are_linked_exist():
    links = [link for link in re.findall(r"\]\(([^)]+)\)", README) if not link.startswith("http")]
    assert len(links) >= 5
    assert [link for link in links if not (ROOT / link).is_file()] == []


def test_the_paper_is_cited_with_its_doi():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    (paper,) = citation["references"]
    assert [author["family-names"] for author in paper["authors"]] == ["Maegawa", "Suzuki", "Nakano"]
    assert f"doi:{paper['doi']}" in README
