"""The reproduction paper: its numbers, taken from results by name, and its pages, set from them by Typst."""

from precursors.reproduction.paper.numbers import (
    Number,
    PaperError,
    Source,
    collect_numbers,
    configured,
    is_configured,
    read_sources,
    tables_needed,
    write_numbers,
)
from precursors.reproduction.paper.pages import files_shown, set_pages

__all__ = [
    "Number",
    "PaperError",
    "Source",
    "collect_numbers",
    "configured",
    "files_shown",
    "is_configured",
    "read_sources",
    "set_pages",
    "tables_needed",
    "write_numbers",
]
