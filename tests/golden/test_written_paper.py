"""The paper: the same bytes from the same results, and other sentences from others."""

from __future__ import annotations

import shutil
from pathlib import Path

import pandas as pd
import pytest
import write_paper
import yaml
from pdf_text import pages_of
from pypdf import PdfReader

from precursors.reproduction.paper import PaperError, configured, files_shown, read_sources, tables_needed

ROOT = Path(__file__).parents[2]
PAPER = ROOT / "paper"
PDF = ROOT / "results/paper.pdf"
SOURCES = read_sources(PAPER / "numbers.yaml")
SHOWN = files_shown(PAPER)
CONFIG = configured(SOURCES, yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8")))
MAKERS = {file: {"rule": "this_test", "modules": []} for file in SHOWN}
FEWEST_PAGES, MOST_PAGES = 10, 14
LEAST_TEXT = 500


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with what the paper is made of, to be changed."""
    tables = [f"results/tables/{table}.csv" for table in tables_needed(SOURCES)]
    for file in {*SHOWN, *tables}:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / file, tmp_path / file)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write() -> bytes:
    write_paper.main(PAPER, SHOWN, "results/tables", CONFIG, MAKERS, "numbers.json", "paper.pdf")
    return Path("paper.pdf").read_bytes()


def change(table: str, column: str, value: object, **where: object) -> None:
    path = Path(f"results/tables/{table}.csv")
    content = pd.read_csv(path)
    rows = pd.Series(True, index=content.index)
    for name, wanted in where.items():
        rows &= content[name] == wanted
    assert rows.any()
    content[column] = content[column].astype(object)
    content.loc[rows, column] = value
    content.to_csv(path, index=False)


def test_the_paper_is_of_the_length_of_a_paper_and_every_page_says_something():
    pages = pages_of(PDF.read_bytes())
    assert FEWEST_PAGES <= len(pages) <= MOST_PAGES
    assert min(map(len, pages)) > LEAST_TEXT


def test_captions_name_the_rule_and_the_module_that_drew_a_figure():
    text = " ".join(pages_of(PDF.read_bytes()))
    for maker in (
        "Rule draw_fig09, module figures/chain_schematic.py.",
        "Rule draw_scene, module figures/scene.py.",
        "Rule draw_fig13, module figures/precursor_lengths.py.",
        "Rule draw_spread, module figures/spread.py.",
        "Rule judge_claims.",
    ):
        assert maker in text


def test_fonts_are_those_that_typst_brings_along():
    fonts = {
        font.get_object()["/BaseFont"].split("+")[-1]
        for page in PdfReader(PDF).pages
        for font in page["/Resources"].get("/Font", {}).values()
    }
    assert fonts
    assert all(font.startswith(("LibertinusSerif", "NewCM", "DejaVuSansMono")) for font in fonts), fonts


def test_the_same_results_give_the_same_bytes_and_others_another_sentence(here):
    first = write()
    assert write() == first
    assert "we find 6, 9 and 14. It gives" in pages_of(first)[0]
    claims = pd.read_csv("results/tables/claims.csv")
    not_reproduced = (claims[claims["kind"] == "result"]["verdict"] == "not reproduced").sum()
    events = "events kept, the first global slip included"
    change("reproduction", "reproduced", 7, scene="fig11", quantity=events)
    change("claims", "verdict", "not reproduced", id="count-trailing")
    change("step_sweep", "transitions_right", 338, scene="fig12", method="rk4_skip")
    change("resolution_models", "q50", 0.4444, model="both_25", quantity="mu_sapp", n_blocks=20)
    text = " ".join(pages_of(write()))
    assert "we find 7, 9 and 14. It gives" in text
    assert f"{not_reproduced + 1} are not reproduced" in text
    assert "agree with the exact ones may be luck. (In these results it is not so.)" in text
    assert "keep the coefficient above it. (In these results it is not so.)" in text
    assert "the medians lie between 0.444 and" in text


def test_a_result_that_is_missing_is_refused_in_one_line(here):
    change("certificates", "chain", "another", chain="uniform")
    with pytest.raises(PaperError, match=r"^number \S+: .*certificates\.csv has 0 rows with chain = uniform"):
        write()
    assert not Path("paper.pdf").exists()
