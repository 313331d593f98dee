"""The paper: the same bytes from the same results, and other sentences from others."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import write_paper
import yaml
from pdf_text import pages_of
from pypdf import PdfReader

from precursors.reproduction.numbers import TABLES, numbers
from precursors.reproduction.pages import files_shown
from precursors.reproduction.tables import Tables

ROOT = Path(__file__).parents[2]
PDF = ROOT / "results/paper.pdf"
SHOWN = files_shown(ROOT / "paper")
CONFIG = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
FEWEST_PAGES, MOST_PAGES = 10, 14
LEAST_TEXT = 500


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with what the paper is made of, to be changed."""
    for file in {*SHOWN, *(f"results/tables/{table}.csv" for table in TABLES)}:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / file, tmp_path / file)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(config: Mapping[str, Any] = CONFIG) -> bytes:
    rules = dict.fromkeys(SHOWN, "this_test")
    write_paper.main(ROOT / "paper", SHOWN, config, rules, "results/numbers.json", "paper.pdf")
    return Path("paper.pdf").read_bytes()


def change(table: str, column: str, value: object, **where: object) -> None:
    path = Path(f"results/tables/{table}.csv")
    content = pd.read_csv(path).astype({column: object})
    chosen = pd.Series(True, index=content.index)
    for name, wanted in where.items():
        chosen &= content[name] == wanted
    assert chosen.any()
    content.loc[chosen, column] = value
    content.to_csv(path, index=False)


def test_the_paper_has_the_length_of_a_paper_and_every_page_says_something():
    pages = pages_of(PDF.read_bytes())
    assert FEWEST_PAGES <= len(pages) <= MOST_PAGES
    assert min(map(len, pages)) > LEAST_TEXT


def test_the_numbers_beside_the_paper_are_what_the_tables_give():
    written = (ROOT / "results/numbers.json").read_text(encoding="utf-8")
    assert json.loads(json.dumps(numbers(Tables(ROOT / "results/tables"), CONFIG))) == json.loads(written)


def test_captions_name_the_rule_that_made_what_they_show():
    text = " ".join(pages_of(PDF.read_bytes()))
    for rule in ("draw_fig09", "draw_scene", "draw_fig13", "draw_spread", "evaluate_claims"):
        assert f"Rule {rule}." in text


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
    change("fig11_slips", "counted", True, counted=False, is_global=False, front=1)
    change("claims", "verdict", "not reproduced", id="count-trailing")
    text = " ".join(pages_of(write()))
    assert "we find 6, 9 and 14. It gives" not in text
    assert f"contradicts {not_reproduced + 1}." in text


def test_a_result_that_is_missing_is_refused_in_one_line(here):
    change("certificates", "chain", "another", chain="uniform")
    with pytest.raises(ValueError, match=r"^the paper's numbers of proof: 0 rows have chain = uniform"):
        write()
    assert not Path("paper.pdf").exists()


def test_a_table_without_a_number_is_refused_by_the_name_of_the_number(here):
    change("lyapunov", "exponent_per_s", float("nan"), scene="fig10")
    with pytest.raises(ValueError, match=r"^the paper's number lyapunov-fig10 is nan in the tables"):
        write()


def test_the_numbers_read_the_tables_that_the_workflow_gives_them_and_no_other():
    tables = Tables(ROOT / "results/tables")
    numbers(tables, CONFIG)
    assert set(tables) <= set(TABLES)


def test_every_number_is_said_somewhere():
    text = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "paper").rglob("*.typ"))
    # A name is said for one scene at least, or put together from its beginning, as "mu-" and the scene.
    begins = tuple(re.findall(r'"([a-z0-9-]+-)" \+', text))
    names = {name for name in numbers(Tables(ROOT / "results/tables"), CONFIG) if not name.startswith(begins)}
    assert {name for name in names if f'"{name.rsplit("-", 1)[0]}' not in text} == set()
