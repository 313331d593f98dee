"""What a file of rules lists: tables, figures, and ensembles of runs.

Functions are given by their full names, so that reading the rules imports
none of them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

Files = str | Sequence[str] | Mapping[str, str]


class Entries(dict[str, Any]):
    """Entries by name, each name once."""

    def __setitem__(self, name: str, entry: Any) -> None:
        if name in self:
            raise ValueError(f"{name} is the name of two scenes, tables or figures")
        super().__setitem__(name, entry)


def listed(files: Files) -> list[str]:
    """Files of an input: one, or those of a list or mapping."""
    if isinstance(files, str):
        return [files]
    return [*(files.values() if isinstance(files, Mapping) else files)]


@dataclass(frozen=True, kw_only=True)
class Table:
    """A job that makes tables of its inputs.

    Attributes
    ----------
    function : str
        "package.module:name"; it returns a table, or tables by their names.
    message : str
        What it does.
    inputs : mapping
        Arguments of the function that are read from files: a file, or a list or mapping
        of files.
    options : mapping
        Its other arguments.
    also : sequence of str
        Files that it reads by itself.
    tables, beside : sequence of str
        Tables that it gives: those that the report has, by default one of the entry's
        name, and those that it leaves out.
    seconds : int
        Time that it takes, if it is a job for a cluster's queue.
    threads : int
        Cores that it can use.
    """

    function: str
    message: str
    inputs: Mapping[str, Files] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    also: Sequence[str] = ()
    tables: Sequence[str] | None = None
    beside: Sequence[str] = ()
    seconds: int = 0
    threads: int = 1

    def outputs(self, name: str) -> tuple[list[str], list[str]]:
        """Files of the tables: those that the report has, and those beside them."""
        shown = [name] if self.tables is None else self.tables
        files = [
            [f"results/tables/{table}.csv" for table in tables]
            for tables in (shown, self.beside)
        ]
        return files[0], files[1]


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A figure that is drawn from tables.

    Attributes
    ----------
    section : str
        Its heading in the report; one job draws all figures of a section.
    function : str
        "package.module:draw".
    shows : str
        What it shows.
    tables : mapping
        Arguments of `draw` that are read from files.
    options : mapping
        Its other arguments.
    caption : str
        File of workflow/report; by default that of the figure's name.
    look : mapping
        Arguments of `precursors.figures.style.Look`, if it has one.
    """

    section: str
    function: str
    shows: str
    tables: Mapping[str, Files] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    caption: str = ""
    look: Mapping[str, Any] | None = None


@dataclass(frozen=True, kw_only=True)
class Ensemble:
    """Many runs, divided into jobs.

    Attributes
    ----------
    function : str
        "package.module:name"; it returns a `maegawa2010.studies.members.Study`.
    options : mapping
        Its arguments.
    run : str
        "package.module:name"; it runs the members of a study, and returns a row of each.
    seconds : int
        Time that a job takes.
    """

    function: str
    options: Mapping[str, Any]
    run: str = "maegawa2010.studies.members:run_members"
    seconds: int = 2
