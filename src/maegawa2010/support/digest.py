"""Digest of what a job computes: the syntax trees of its script and of all that this
imports."""

import ast
import hashlib
from functools import cache
from pathlib import Path


def digest_code(root: str | Path, script: str) -> str:
    """Digest of a script of the workflow and of all modules that it imports.

    Comments, docstrings and the format of the code are left out. `root` is the directory
    of the Snakefile, `script` a name such as "simulate_scene".

    Raises
    ------
    OSError
        If there is no such script, or a file cannot be read.
    """
    sources = Path(root, "src")
    waiting = [*Path(root, "workflow").rglob(f"{script}.py")]
    if len(waiting) != 1:
        raise FileNotFoundError(
            f"workflow: {script}.py must be one script, but there are {len(waiting)}"
        )
    found: dict[Path, str] = {}
    while waiting:
        if (path := waiting.pop()) not in found:
            found[path], imported = _read(sources, path)
            waiting += imported
    trees = sorted(
        (path.relative_to(root).as_posix(), tree) for path, tree in found.items()
    )
    return hashlib.sha256(repr(trees).encode()).hexdigest()[:16]


@cache
def _read(sources: Path, path: Path) -> tuple[str, list[Path]]:
    """Digest of a file's syntax tree, and the files that it imports."""
    source = path.read_bytes()
    tree = ast.parse(source)
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names += [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(
            node, ast.Module | ast.ClassDef | ast.FunctionDef
        ) and ast.get_docstring(node, False):
            node.body = node.body[1:]
    imported = [file for name in names if (file := _file_of(sources, name))]
    if b"import_module(" in source:  # by names that only a run knows
        imported += path.parent.glob("[!_]*.py")
    return hashlib.sha256(ast.dump(tree).encode()).hexdigest(), imported


def _file_of(sources: Path, name: str) -> Path | None:
    """The module of that name, or the module or package that defines it, if it is
    ours."""
    module = sources.joinpath(*name.split("."))
    paths = [module.with_suffix(".py"), module / "__init__.py"]
    if "." in name:
        paths += [module.parent.with_suffix(".py"), module.parent / "__init__.py"]
    return next((path for path in paths if path.is_file()), None)
