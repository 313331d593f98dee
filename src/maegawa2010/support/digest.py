"""Digest of what a job computes: the syntax trees of its script and of all that this
imports."""

import ast
import hashlib
from functools import cache
from pathlib import Path


def digest_code(root: str | Path, script: str) -> str:
    """Digest of a script of the workflow and of all modules that it imports.

    Comments, docstrings and the format of the code are left out, and so is what only a
    type checker imports. `root` is the directory of the Snakefile, `script` a name such
    as "simulate_scene".

    Raises
    ------
    OSError
        If a file cannot be read.
    """
    sources = Path(root, "src")
    waiting = [*Path(root, "workflow").glob(f"*/{script}.py")]
    waiting += Path(root, "workflow").glob(f"studies/*/{script}.py")
    if not waiting:
        raise FileNotFoundError(f"workflow: no script {script}.py")
    found: dict[Path, str] = {}
    while waiting:
        if (path := waiting.pop()) not in found:
            found[path], imported = _read(sources, path)
            waiting += imported
    trees = sorted(
        (path.relative_to(root).as_posix(), tree) for path, tree in found.items()
    )
    return hashlib.sha256(repr(trees).encode()).hexdigest()[:16]


def _file(module: Path) -> Path | None:
    """The file of a module or package, if there is one."""
    files = (module.with_suffix(".py"), module / "__init__.py")
    return next((file for file in files if file.is_file()), None)


@cache
def _read(sources: Path, path: Path) -> tuple[str, list[Path]]:
    """Digest of a file's syntax tree, and the files that it imports."""
    source = path.read_bytes()
    tree = ast.parse(source)
    is_lazy = path.name == "__init__.py" and b"import_module(" in source
    if not is_lazy:
        tree.body = [part for part in tree.body if not _is_for_types(part)]
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
    files = [_file_of(sources, path.parent, name) for name in names]
    imported = [file for file in files if file]
    if is_lazy:
        imported += path.parent.glob("[!_]*.py")  # by names that only a run knows
    return hashlib.sha256(ast.dump(tree).encode()).hexdigest(), imported


@cache
def _file_of(sources: Path, beside: Path, name: str) -> Path | None:
    """The module of that name, or the one that defines it, or the package that has it;
    None outside the sources and the directory."""
    *parents, last = name.split(".")
    start = sources if (sources / name.split(".")[0]).is_dir() else beside
    package = start.joinpath(*parents)
    if (module := _file(package / last)) or not (found := _file(package)):
        return module
    if last in (lazy := _imported_later(found)):
        return _file_of(sources, beside, f"{lazy[last]}.{last}")
    return found


@cache
def _imported_later(package: Path) -> dict[str, str]:
    """Modules of the names that a package imports when they are first asked for, and a
    type checker at once."""
    return {
        alias.name: str(node.module)
        for part in ast.parse(package.read_bytes()).body
        if _is_for_types(part)
        for node in ast.walk(part)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }


def _is_for_types(part: ast.stmt) -> bool:
    return isinstance(part, ast.If) and ast.unparse(part.test) == "TYPE_CHECKING"
