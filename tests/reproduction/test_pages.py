"""The words of the paper's source show a number as people read it, and refuse what cannot be set."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from pdf_text import pages_of

from precursors.reproduction.pages import files_shown, set_pages

PAPER = Path(__file__).parents[2] / "paper"
MINUS, TIMES = "\u2212", "\u00d7"


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def page(text: str, numbers: dict | None = None) -> bytes:
    """A page set with the words of the paper from a text and numbers."""
    source = Path("source")
    source.mkdir()
    (source / "lib.typ").write_text((PAPER / "lib.typ").read_text(encoding="utf-8"), encoding="utf-8")
    (source / "main.typ").write_text(f'#import "lib.typ": *\n{text}\n', encoding="utf-8")
    names = {f"theta-{scene}": {"value": 0, "unit": "1"} for scene in ("fig10", "fig11", "fig12")}
    Path("results").mkdir(exist_ok=True)
    Path("results/numbers.json").write_text(json.dumps({**names, **(numbers or {})}), encoding="utf-8")
    set_pages(source, ["results/numbers.json"], {}, "page.pdf")
    return Path("page.pdf").read_bytes()


def number(value: float | str, unit: str = "1") -> dict:
    return {"it": {"value": value, "unit": unit}}


@pytest.mark.parametrize(
    ("words", "value", "unit", "said"),
    [
        ('#n("it")', 14, "1", "14"),
        ('#n("it", 4)', 0.48826, "1", "0.4883"),
        ('#n("it", 2)', 0.8, "1", "0.80"),
        ('#n("it", 1)', -0.04, "1", "0.0"),
        ('#n("it", 1)', -0.06, "1", f"{MINUS}0.1"),
        ('#n("it")', "fragile", "1", "fragile"),
        ('#q("it", "ms", 2)', 0.000446347, "s", "0.45 ms"),
        ('#q("it", "MN/m", 1)', 800000, "N/m", "0.8 MN/m"),
        ('#q("it", "%", 0)', 0.355, "1", "36 %"),
        ('#e("it", 0, "s")', 9.96e-10, "s", f"10{MINUS}9 s"),
        ('#e("it", 1)', 2.34e-15, "1", f"2.3 {TIMES} 10{MINUS}15"),
        ('#count("it")', 7, "1", "seven"),
        ('#times("it")', 2, "1", "twice"),
        ('#holds(value("it") > 3)[Many.]', 4, "1", "Many."),
        ('Few. #holds(value("it") > 3)[Many.]', 2, "1", "Few."),
    ],
)
def test_a_number_is_told_as_people_read_it(words, value, unit, said):
    (found,) = pages_of(page(words, number(value, unit)))
    assert found.replace(" ", "") == said.replace(" ", "")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            '#n("lost")',
            r"no number is called lost: .*numbers.py has the names \(.*paper/main.typ:2\)",
        ),
        ('#n("it")', r"2.5 is not whole: say with how many decimals"),
        ('#q("it", "N")', "it is in s and cannot be written in N"),
        ('#set text(font: "Arial")\nHello', "unknown font family: arial"),
        ('#image("/results/figures/fig13.svg")', "file not found"),
        ("@lost", "label `<lost>` does not exist"),
    ],
)
def test_a_page_that_cannot_be_set_as_meant_is_refused_in_one_line(text, says):
    with pytest.raises(ValueError, match=says) as caught:
        page(text, number(2.5, "s"))
    assert "\n" not in str(caught.value)
    assert not Path("page.pdf").exists()


def test_a_file_that_is_missing_is_refused_by_name():
    with pytest.raises(FileNotFoundError, match=r"results/figures/lost\.svg"):
        set_pages(PAPER, ["results/figures/lost.svg"], {}, "page.pdf")


def texts() -> dict[str, str]:
    return {path.name: path.read_text(encoding="utf-8") for path in (PAPER / "sections").glob("*.typ")}


def test_every_section_is_part_of_the_paper():
    main = (PAPER / "main.typ").read_text(encoding="utf-8")
    assert {name for name in texts() if f'#include "sections/{name}"' in main} == set(texts())


def test_the_text_shows_the_figures_of_the_paper():
    shown = files_shown(PAPER)
    assert {f"results/figures/{name}.svg" for name in ("fig09", "fig10", "fig11", "fig12", "fig13")} <= set(
        shown
    )
    assert "results/tables/claims.csv" in shown


# What is no number of ours: comments, names, symbols, places in the paper, and lengths of columns.
NO_NUMBERS = [
    r"(?m)^\s*//.*$",
    r'"[^"\n]*"',
    r"\$[^$]*\$",
    r"`[^`]*`",
    r"@[a-z0-9_-]+|<[a-z0-9-]+>",
    r"\b(?:Figs?|Eqs?|Sects?)\.\s[0-9.]*[0-9](?:(?:,|\sto|\sand)\s[0-9.]*[0-9])*",
    r"\bDOP853\b",
    r"[0-9.]+(?:mm|pt|em|fr|%)",
    r"\) \* [0-9]",
]
# A word of the source with what it is given; what is in the innermost brackets goes first.
CALL = r"[\w.-]+\([^()]*\)"


def prose(text: str) -> str:
    """What is left of a section without its words, names, symbols and places in the paper."""
    for pattern in NO_NUMBERS:
        text = re.sub(pattern, " ", text)
    while re.search(CALL, text):
        text = re.sub(CALL, " ", text)
    return text


@pytest.mark.parametrize("name", sorted(texts()))
def test_no_number_stands_in_the_prose(name):
    lines = [line.strip() for line in prose(texts()[name]).splitlines()]
    assert [
        line for line in lines if re.search(r"[0-9]", line) and not line.startswith(("#let", "#set", "let "))
    ] == []


def test_a_number_in_the_prose_would_be_seen():
    assert re.search(r"[0-9]", prose('Of #n("events") events (Figs. 10 to 13) 6 are kept.'))
