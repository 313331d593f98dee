"""Numbers of the paper come from tables by name, and the source of the paper holds none itself."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
import yaml
from pdf_text import pages_of

from precursors.reproduction.paper import (
    PaperError,
    collect_numbers,
    configured,
    files_shown,
    read_sources,
    set_pages,
    tables_needed,
    write_numbers,
)

PAPER = Path(__file__).parents[2] / "paper"
MINUS, TIMES = "\N{MINUS SIGN}", "\N{MULTIPLICATION SIGN}"
TABLE = """scene,quantity,value,end_s,class
fig10,count,9,2.5,robust
fig10,mu_sapp,0.4858,1.0,fragile
fig12,count,14,4.0,11; 19; 27
"""


@pytest.fixture
def tables(tmp_path: Path) -> Path:
    (tmp_path / "found.csv").write_text(TABLE, encoding="utf-8")
    return tmp_path


def sources(directory: Path, entries: str, lists: str = "{}"):
    path = directory / "numbers.yaml"
    path.write_text(f"lists: {lists}\nnumbers:\n{entries}", encoding="utf-8")
    return read_sources(path)


def collected(directory: Path, entry: str, config=()):
    return collect_numbers(sources(directory, f"  it: {entry}"), directory, dict(config))["it"]


@pytest.mark.parametrize("entry", ["{", "{unit: N, unit: m}", "\0"])
def test_a_file_that_is_not_plain_yaml_is_refused_in_one_line(tables, entry):
    with pytest.raises(
        PaperError, match=r"numbers.yaml: (not valid YAML|the key 'unit' stands twice)"
    ) as error:
        sources(tables, f"  it: {entry}")
    assert "\n" not in str(error.value)


def test_a_number_is_read_from_its_row_and_says_where(tables):
    entry = "{table: found, column: value, where: {scene: fig10, quantity: mu_sapp}, unit: N}"
    number = collected(tables, entry)
    assert (number.value, number.unit) == (0.4858, "N")
    assert number.source == "results/tables/found.csv, value"


def test_a_changed_table_changes_the_number(tables):
    entry = "{table: found, column: value, where: {scene: fig10, quantity: count}}"
    assert collected(tables, entry).value == 9
    (tables / "found.csv").write_text(TABLE.replace("count,9", "count,8"), encoding="utf-8")
    assert collected(tables, entry).value == 8


@pytest.mark.parametrize(
    ("entry", "value"),
    [
        ("{table: found, column: value, take: largest}", 14),
        ("{table: found, column: scene, where: {scene: [fig10, fig12]}, take: count}", 3),
        ("{table: found, column: end_s, minus: value, where: {scene: fig12}}", -10),
        ("{table: found, column: end_s, over: value, where: {scene: fig12}}", 4 / 14),
        ("{table: found, column: class, where: {quantity: mu_sapp}}", "fragile"),
        ("{table: found, column: class, where: {scene: fig12}, part: 2}", 19),
    ],
)
def test_a_number_is_what_the_entry_takes(tables, entry, value):
    assert collected(tables, entry).value == value


def test_a_name_with_a_key_stands_for_one_number_of_each_value(tables):
    entry = '  "count-{scene}": {table: found, column: value, where: {scene: "{scene}", quantity: count}}\n'
    found = sources(tables, entry, "{scene: [fig10, fig12]}")
    numbers = collect_numbers(found, tables, {})
    assert {name: number.value for name, number in numbers.items()} == {"count-fig10": 9, "count-fig12": 14}
    assert tables_needed(found) == ["found"]


def test_a_parameter_is_read_from_the_configuration(tables):
    found = sources(tables, "  mass: {config: chain.mass, unit: kg}")
    values = configured(found, {"chain": {"mass": 0.012}})
    assert collect_numbers(found, tables, values)["mass"].value == 0.012
    with pytest.raises(PaperError, match=r"mass: the configuration has no chain\.mass"):
        configured(found, {"chain": {}})


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ("{table: lost, column: value}", "lost.csv is missing"),
        ("{table: found, column: lost}", "no column lost: it has scene, quantity"),
        (
            "{table: found, column: value, where: {scene: fig11}}",
            "has 0 rows with scene = fig11: needed is one",
        ),
        (
            "{table: found, column: value, where: {scene: fig10}}",
            "has 2 rows with scene = fig10: needed is one",
        ),
        (
            "{table: found, column: value, where: {scene: fig11}, take: first}",
            "has no row with scene = fig11",
        ),
        ("{table: found, column: class, where: {scene: fig12}, part: 4}", "has 3 parts: part 4 is asked for"),
    ],
)
def test_a_number_that_is_not_there_is_refused_by_name(tables, entry, says):
    with pytest.raises(PaperError, match=f"number it: .*{re.escape(says)}"):
        collected(tables, entry)


def test_a_number_that_is_none_is_refused(tables):
    (tables / "found.csv").write_text("scene,value\nfig10,\n", encoding="utf-8")
    with pytest.raises(PaperError, match=r"number it: .*nan is no number"):
        collected(tables, "{table: found, column: value}")


def test_an_optional_number_may_be_missing_and_no_other(tables):
    entry = "  it: {table: found, column: value, where: {scene: fig11}, optional: true}"
    assert collect_numbers(sources(tables, entry), tables, {}) == {}


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ("{table: found, columns: value}", "'columns' is an unknown key: allowed are unit, table, column"),
        ("{table: found}", "needed are a table and its column, or a key of config"),
        ("{column: value}", "needed are a table and its column, or a key of config"),
        ("{table: found, column: value, take: most}", "allowed for take are only, each"),
        ("7", "it = 7: allowed is a table of keys and values"),
    ],
)
def test_an_entry_that_says_something_else_is_refused(tables, entry, says):
    with pytest.raises(PaperError, match=re.escape(says)):
        collected(tables, entry)


def test_numbers_are_written_with_unit_and_source(tables):
    numbers = collect_numbers(
        sources(tables, "  it: {table: found, column: value, take: largest}"), tables, {}
    )
    write_numbers(numbers, tables / "numbers.json")
    assert json.loads((tables / "numbers.json").read_text(encoding="utf-8")) == {
        "it": {"value": 14, "unit": "1", "source": "results/tables/found.csv, value"}
    }


def page(directory: Path, text: str, numbers: dict | None = None) -> bytes:
    """A page set with the words of the paper from a text and numbers."""
    source = directory / "source"
    source.mkdir(exist_ok=True)
    (source / "lib.typ").write_text((PAPER / "lib.typ").read_text(encoding="utf-8"), encoding="utf-8")
    (source / "main.typ").write_text(f'#import "lib.typ": *\n{text}\n', encoding="utf-8")
    names = {
        f"theta-{scene}": {"value": 0, "unit": "1", "source": ""} for scene in ("fig10", "fig11", "fig12")
    }
    (directory / "numbers.json").write_text(json.dumps({**names, **(numbers or {})}), encoding="utf-8")
    (directory / "makers.json").write_text("{}", encoding="utf-8")
    files = {f"results/{name}.json": directory / f"{name}.json" for name in ("numbers", "makers")}
    set_pages(source, files, directory / "page.pdf")
    return (directory / "page.pdf").read_bytes()


def number(value: float | str, unit: str = "1") -> dict:
    return {"it": {"value": value, "unit": unit, "source": ""}}


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
        ('#holds(value("it") > 3)[Many.]', 2, "1", "Many. (In these results it is not so.)"),
    ],
)
def test_a_number_is_told_as_people_read_it(tmp_path, words, value, unit, said):
    (found,) = pages_of(page(tmp_path, words, number(value, unit)))
    assert found.replace(" ", "") == said.replace(" ", "")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('#n("lost")', r"no number is called lost: numbers.yaml has the names \(.*paper/main.typ:2\)"),
        ('#n("it")', r"2.5 is not whole: say with how many decimals"),
        ('#q("it", "N")', "it is in s, which is not told in N"),
        ('#set text(font: "Arial")\nHello', "unknown font family: arial"),
        ('#image("/results/figures/fig13.svg")', "file not found"),
        ("@lost", "label `<lost>` does not exist"),
    ],
)
def test_a_page_that_cannot_be_set_as_meant_is_refused_in_one_line(tmp_path, text, says):
    with pytest.raises(PaperError, match=says) as caught:
        page(tmp_path, text, number(2.5, "s"))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "page.pdf").exists()


def test_a_file_that_is_missing_is_refused_by_name(tmp_path):
    with pytest.raises(PaperError, match=r"lost\.svg is missing: the paper shows it"):
        set_pages(PAPER, {"results/figures/lost.svg": tmp_path / "lost.svg"}, tmp_path / "page.pdf")


def texts() -> dict[str, str]:
    return {path.name: path.read_text(encoding="utf-8") for path in (PAPER / "sections").glob("*.typ")}


def test_every_section_is_part_of_the_paper():
    main = (PAPER / "main.typ").read_text(encoding="utf-8")
    assert {name for name in texts() if f'#include "sections/{name}"' in main} == set(texts())


def test_every_entry_of_the_list_is_said_somewhere():
    said = "\n".join([*texts().values(), (PAPER / "lib.typ").read_text(encoding="utf-8")])
    names = set(re.findall(r'"([a-z0-9][a-z0-9-]*)"', said))
    listed = yaml.safe_load((PAPER / "numbers.yaml").read_text(encoding="utf-8"))["numbers"]
    begin = [name.split("{")[0] for name in listed]
    composed = tuple(name for name in names if name.endswith("-"))
    assert [b for b in begin if not b.startswith(composed) and not any(n.startswith(b) for n in names)] == []


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
