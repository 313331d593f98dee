"""The article depends on the results only: all its numbers come from tables."""

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
import write_paper
from pdf_text import pages_of
from places import ROOT
from pypdf import PdfReader

from maegawa2010.paper.documents import cited_results

SOURCE = ROOT / "paper"
MOST_PAGES = 7
LEAST_TEXT = 500  # characters of a page


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with copies of the results that the article cites."""
    for file in cited_results(SOURCE / "paper.typ"):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / file, tmp_path / file)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write() -> bytes:
    write_paper.main(
        SOURCE / "paper.typ", cited_results(SOURCE / "paper.typ"), "paper.pdf"
    )
    return Path("paper.pdf").read_bytes()


def test_the_article_has_at_most_seven_full_pages_in_known_fonts():
    article = ROOT / "results/paper.pdf"
    pages = pages_of(article.read_bytes())
    assert len(pages) <= MOST_PAGES
    assert min(map(len, pages)) > LEAST_TEXT
    fonts = {
        font.get_object()["/BaseFont"].split("+")[-1]
        for page in PdfReader(article).pages
        for font in page["/Resources"].get("/Font", {}).values()
    }
    assert fonts
    assert all(
        font.startswith(("LibertinusSerif", "NewCM", "DejaVuSans", "STIX"))
        for font in fonts
    ), fonts


def test_equal_results_give_equal_bytes_and_others_do_not(here):
    assert write() == (ROOT / "results/paper.pdf").read_bytes()
    table = pd.read_csv("results/tables/reproduction.csv")
    table.replace({"reproduced": {56: 57}}).to_csv(
        "results/tables/reproduction.csv", index=False
    )
    assert "of the 57 events are short" in " ".join(pages_of(write()))


def test_a_missing_row_or_file_stops_the_build_in_one_line(here):
    table = pd.read_csv("results/tables/certificates.csv")
    table[table["chain"] != "uniform"].to_csv(
        "results/tables/certificates.csv", index=False
    )
    line = r"certificates.csv, chain = uniform: 0 rows, but the text needs one"
    with pytest.raises(ValueError, match=rf"^{line}[^\n]*$"):
        write()
    assert not Path("paper.pdf").exists()
    shown = cited_results(SOURCE / "paper.typ")
    shown.remove("results/figures/hero.svg")
    line = "paper.typ cites results/figures/hero.svg, which no rule makes: "
    with pytest.raises(ValueError, match=rf"^paper/{line}[^\n]*$"):
        write_paper.main(SOURCE / "paper.typ", shown, "paper.pdf")


def test_a_finding_that_a_table_contradicts_stops_the_build(here):
    table = pd.read_csv("results/tables/noise_differences.csv")
    table.replace({"verdict": {"different": "same"}}).to_csv(
        "results/tables/noise_differences.csv", index=False
    )
    with pytest.raises(ValueError, match=r"^the tables no longer bear out: [^\n]*$"):
        write()
    assert not Path("paper.pdf").exists()


# Digits that are no results: in comments, names, symbols, code, references to the
# original, and lengths.
NO_NUMBERS = [
    r"(?m)//.*$",
    r'"[^"\n]*"',
    r"\b0\.833\b|L = 0\.7\b",  # quoted from the original
    r"\$(?:(?!\d\.\d)[^$])*\$",
    r"`[^`]*`",
    r"@[a-z0-9_-]+|<[a-z0-9-]+>",
    r"\b(?:Figs?|Eqs?|Sects?)\.\s[0-9.]*[0-9](?:(?:,|\sto|\sand)\s[0-9.]*[0-9])*",
    r"\b(?:DOP853|CC BY 4\.0|RK4|block 1)\b",
    r"[0-9.]+(?:mm|pt|em|fr)\b",
    r"(?m)^\s*#?let .*$|^\s*(?:align|columns): .*$",
]
CALL = r"#?[\w.-]+\([^()]*\)"


def typed(text: str) -> list[str]:
    """Lines of a document with a digit that is not in code, a name, a symbol or a
    reference to the original."""
    for pattern in NO_NUMBERS:
        text = re.sub(pattern, " ", text)
    while re.search(CALL, text):
        text = re.sub(CALL, " ", text)
    return [line for line in text.splitlines() if re.search(r"[0-9]", line)]


def test_the_article_has_no_typed_number_and_one_would_be_seen():
    assert typed((SOURCE / "paper.typ").read_text(encoding="utf-8")) == []
    assert typed('Of #num("slips", "n", 0) events (Figs. 10 to 13) 6 are counted.')
