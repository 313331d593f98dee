"""A table as a web page of its own: readable digits, every digit on pointing, and the CSV file inside."""

from __future__ import annotations

import base64
import csv
import html
import io
import os
from pathlib import Path

from precursors.support.files import write_whole

DIGITS = 6  # shown of a number; the file inside the page has them all

STYLE = """
body { font: 14px/1.35 system-ui, sans-serif; margin: 1em; color: #222; }
table { border-collapse: collapse; }
th, td { padding: .25em .7em; text-align: left; vertical-align: top; }
td { max-width: 34em; overflow-wrap: break-word; }
th { position: sticky; top: 0; background: #e9edf2; cursor: pointer; white-space: nowrap; }
tbody tr:nth-child(even) { background: #f6f7f9; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
"""

# A click on a heading sorts by it, another the other way round.
SCRIPT = """
const body = document.querySelector("tbody");
const value = (row, i) => row.cells[i].title || row.cells[i].textContent;
document.querySelectorAll("th").forEach((heading, i) => heading.addEventListener("click", () => {
  const sign = heading.dataset.order === "up" ? -1 : 1;
  heading.dataset.order = sign > 0 ? "up" : "down";
  const compare = (a, b) => {
    const [x, y] = [value(a, i), value(b, i)];
    return x !== "" && y !== "" && !isNaN(x) && !isNaN(y) ? x - y : x.localeCompare(y);
  };
  body.append(...[...body.rows].sort((a, b) => sign * compare(a, b)));
}));
"""


def write_table_page(table: str | os.PathLike[str], output: str | os.PathLike[str]) -> None:
    """Write a CSV file as a web page that needs no other file and no network.

    Raises
    ------
    ValueError
        If the table is damaged, has no header, or a row has another number of cells than it.
    """
    source = Path(table)
    try:
        page = table_page(source.stem, source.read_text(encoding="utf-8"))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{source} is no table: {error}") from None
    with write_whole(output) as temporary:
        temporary.write_text(page, encoding="utf-8")


def table_page(name: str, text: str) -> str:
    """HTML of a table that is given as the text of a CSV file with a header."""
    header, *rows = list(csv.reader(io.StringIO(text))) or [[]]
    if not header:
        raise ValueError(f"{name}: an empty table: needed is a header")
    for number, row in enumerate(rows, start=2):
        if len(row) != len(header):
            raise ValueError(
                f"{name}: line {number} has {len(row)} cells: allowed is {len(header)}, as the header"
            )
    data = base64.b64encode(text.encode()).decode()
    link = f'<a download="{name}.csv" href="data:text/csv;base64,{data}">{name}.csv</a>'
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
    body = "\n".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    return (
        f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>{name}</title>\n'
        f"<style>{STYLE}</style>\n<p>{len(rows)} rows; {link}</p>\n"
        f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>\n"
        f"<script>{SCRIPT}</script>\n</html>\n"
    )


def _cell(text: str) -> str:
    try:
        number = float(text)
    except ValueError:
        return f"<td>{html.escape(text)}</td>"
    shown = text if len(text) <= DIGITS else f"{number:.{DIGITS}g}"
    return f'<td class="number" title="{text}">{shown}</td>'
