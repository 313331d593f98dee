"""Which modules of the library a script uses: read from its import statements, nothing is imported."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

PACKAGE = "precursors"
# Ten times as fast as Python's parser, which a test holds it against: every job of the workflow waits for it.
_MODULE = rf"{PACKAGE}(?:\.\w+)*"
_IMPORT = re.compile(rf"^ *(?:from ({_MODULE}) import (\([^)]*\)|[^\n]*)|import ({_MODULE})\b)", re.M)
_FOR_TYPES = re.compile(r"^if TYPE_CHECKING:\n(?: +.*\n|\n)*", re.M)


class Import(NamedTuple):
    """`from module import name`; the name is empty in `import module`."""

    module: str
    name: str


class Use(NamedTuple):
    """A module that is used: all of it, or only because it says where an imported name comes from."""

    module: str
    wholly: bool


def files_used(
    script: str | Path, library: str | Path, aside: Mapping[str, Sequence[str]] | None = None
) -> list[str]:
    """Files of the library whose edit may change what a script does, relative to the library and sorted.

    These are the modules that the script imports, at its top or in a function, what they import, and so on.
    Of a package they are the modules that its imported names come from, and the `__init__.py` that says so;
    all of its modules, if it imports them by names that it computes. What is imported for type checkers alone
    does not count.

    Parameters
    ----------
    script : path
        A Python file outside the library.
    library : path
        Directory of the package.
    aside : mapping
        Imports that do not count: the module that imports ("run", or "scripts/run_chunk" for a script), and
        those that it imports ("ensembles/catalogue").
    """
    library, aside = Path(library), aside or {}
    first = f"scripts/{Path(script).stem}"
    waiting = [use for use in uses_of(Path(script), library) if use.module not in aside.get(first, ())]
    met: set[Use] = set()
    while waiting:
        use = waiting.pop()
        if use in met:
            continue
        met.add(use)
        if use.wholly:
            of_this = uses_of(library / f"{use.module}.py", library)
            waiting += [other for other in of_this if other.module not in aside.get(use.module, ())]
    return sorted({f"{use.module}.py" for use in met})


@cache
def uses_of(file: Path, library: Path) -> tuple[Use, ...]:
    """What a file uses itself."""
    text = file.read_text(encoding="utf-8")
    found = [use for item in imports(text) for use in _found(item, library)]
    if file.name == "__init__.py" and file.parent != library and "import_module(" in text:
        found += [_use(module, library) for module in file.parent.glob("*.py")]
    return tuple(found)


def imports(text: str, for_types: bool = False) -> list[Import]:
    """What the text of a Python file imports from the library; for type checkers too, if asked for."""
    found = []
    for module, names, alone in _IMPORT.findall(text if for_types else _FOR_TYPES.sub("", text)):
        if alone:
            found.append(Import(alone, ""))
        listed = re.sub(r"#.*", "", names).strip("() \n").split(",")
        found += [Import(module, name.split()[0]) for name in listed if name.strip()]
    return found


@cache
def _found(item: Import, library: Path) -> tuple[Use, ...]:
    """The modules that an import is about."""
    target = library.joinpath(*item.module.split(".")[1:])
    if not target.is_dir():
        return (_use(target.with_suffix(".py"), library),)
    below = target / item.name
    if item.name and (below.is_dir() or below.with_suffix(".py").is_file()):
        return _found(Import(f"{item.module}.{item.name}", ""), library)
    init = target / "__init__.py"
    text = init.read_text(encoding="utf-8")
    handed_on = [other for other in imports(text, for_types=True) if other.name == item.name != ""]
    of_others = [use for other in handed_on for use in _found(other, library)]
    return (_use(init, library, wholly=not handed_on), *of_others)


def _use(file: Path, library: Path, wholly: bool = True) -> Use:
    return Use(file.relative_to(library).with_suffix("").as_posix(), wholly)
