"""Digest of the code of a job: the syntax trees of its script and of all modules that
it imports. Snakemake runs a job again when this digest changes."""

import ast
import hashlib
from functools import cache
from pathlib import Path


def digest_code(root: str | Path, script: str) -> str:
    """Digest of a script of the workflow and of all modules that it imports.

    Comments, docstrings and formatting do not change it. `root` is the directory
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
    digests: dict[Path, str] = {}
    while waiting:
        if (path := waiting.pop()) not in digests:
            digests[path], imported = _read(sources, path)
            waiting += imported
    code = sorted(
        (path.relative_to(root).as_posix(), digest) for path, digest in digests.items()
    )
    return hashlib.sha256(repr(code).encode()).hexdigest()[:16]


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
    if b"import_module(" in source:  # any module of the folder may be imported
        imported += path.parent.glob("[!_]*.py")
    return hashlib.sha256(ast.dump(tree).encode()).hexdigest(), imported


def _file_of(sources: Path, name: str) -> Path | None:
    """File of the module of this name, or of the module or package that defines the
    name, if it is ours."""
    module = sources.joinpath(*name.split("."))
    paths = [module.with_suffix(".py"), module / "__init__.py"]
    if "." in name:
        paths += [module.parent.with_suffix(".py"), module.parent / "__init__.py"]
    return next((path for path in paths if path.is_file()), None)
