"""Put single faults into copies of the library and print those that the tests do not see (`make mutants`).

A fault is one edit of the text: a comparison, a sign or a product the other way round, another constant, a
condition negated, a statement left out. A constant of a figure's layout is not one. Every fault is met by the
test files that import its module, the nearest first, until one fails or they have taken `SECONDS`.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from subprocess import DEVNULL, STDOUT
from time import perf_counter
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
COPIED = (
    "src",
    "tests",
    "workflow",
    "config.yaml",
    "pyproject.toml",
    "paper",
    "docs",
    "README.md",
    "Snakefile",
)
# These read results that are already there, or the workflow's files.
ASIDE = (
    "tests/golden",
    "tests/cluster",
    "tests/workflow/test_d",
    "tests/workflow/test_r",
    "tests/workflow/test_f",
)
SECONDS = 20.0  # of tests, for each fault
PATIENCE = 150.0  # s for one test file, which takes up to a minute when the kernel is compiled anew
OTHERWISE = {
    "Lt": ("<", "<="), "LtE": ("<=", "<"), "Gt": (">", ">="), "GtE": (">=", ">"), "Eq": ("==", "!="),
    "NotEq": ("!=", "=="), "And": ("and", "or"), "Or": ("or", "and"), "Add": ("+", "-"), "Sub": ("-", "+"),
    "Mult": ("*", "/"), "Div": ("/", "*"),
}  # fmt: skip


class Fault(NamedTuple):
    """What stands in a file from one byte to another, and what is put there instead."""

    path: Path
    start: int
    end: int
    new: bytes

    def told(self) -> str:
        """Where it is, what stood there and what stands there."""
        text = self.path.read_bytes()
        line = text.count(b"\n", 0, self.start) + 1
        old = " ".join(text[self.start : self.end].decode().split())
        context = text.splitlines()[line - 1].decode().strip()
        return f"{self.path.relative_to(ROOT)}:{line}: {old} -> {self.new.decode()}   in: {context}"


def other_constant(value: bool | int | float) -> bool | int | float:
    """Another value of the same type."""
    if isinstance(value, bool):
        return not value
    return value + 1 if isinstance(value, int) else 1.5 * value or 1.0


def faults_of(path: Path) -> Iterator[Fault]:
    """All faults of a module."""
    text = path.read_bytes()
    starts = [0, *(i + 1 for i, byte in enumerate(text) if byte == ord("\n"))]

    def place(node: ast.expr | ast.stmt) -> tuple[int, int]:
        end = starts[(node.end_lineno or 1) - 1] + (node.end_col_offset or 0)
        return starts[node.lineno - 1] + node.col_offset, end

    def between(left: ast.expr, right: ast.expr, operator: ast.AST) -> Iterator[Fault]:
        old, new = OTHERWISE.get(type(operator).__name__, ("", ""))
        first, last = place(left)[1], place(right)[0]
        found = re.search(rb"(?<![\w*/<>=!])" + re.escape(old).encode() + rb"(?![\w*/<>=])", text[first:last])
        if old and found:
            yield Fault(path, first + found.start(), first + found.end(), new.encode())

    def visit(node: ast.AST) -> Iterator[Fault]:
        if isinstance(node, ast.JoinedStr | ast.Raise | ast.Import | ast.ImportFrom):
            return
        if isinstance(node, ast.Compare):
            terms = [node.left, *node.comparators]
            for i, operator in enumerate(node.ops):
                yield from between(terms[i], terms[i + 1], operator)
        elif isinstance(node, ast.BinOp):
            yield from between(node.left, node.right, node.op)
        elif isinstance(node, ast.BoolOp):
            yield from between(node.values[0], node.values[1], node.op)
        elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            if "figures" not in path.parts:
                yield Fault(path, *place(node), repr(other_constant(node.value)).encode())
        elif isinstance(node, ast.If | ast.While | ast.IfExp) and "TYPE_CHECKING" not in ast.dump(node.test):
            start, end = place(node.test)
            yield Fault(path, start, end, b"(not (" + text[start:end] + b"))")
        elif isinstance(node, ast.AugAssign) or (
            isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        ):
            yield Fault(path, *place(node), b"pass")
        for name, field in ast.iter_fields(node):
            if name not in ("annotation", "returns"):
                for child in field if isinstance(field, list) else [field]:
                    if isinstance(child, ast.AST):
                        yield from visit(child)

    yield from visit(ast.parse(text))


def modules() -> dict[str, Path]:
    """Every module of the library, the scripts and the tests by the name that an import uses."""
    found = {}
    for base in (ROOT / "src", ROOT / "workflow/scripts", ROOT / "tests"):
        for path in base.rglob("*.py"):
            name = ".".join(path.relative_to(base).with_suffix("").parts)
            found[name.removesuffix(".__init__")] = path
    return found


def imports(path: Path, known: dict[str, Path]) -> set[Path]:
    """Modules that a file imports anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return {known[name] for name in names if name in known}


def distances(start: Path, graph: dict[Path, set[Path]]) -> dict[Path, int]:
    """How many imports away every module is that a test file reaches."""
    found, edge, steps = {start: 0}, {start}, 0
    while edge:
        steps += 1
        edge = {there for here in edge for there in graph[here]} - found.keys()
        found |= dict.fromkeys(edge, steps)
    return found


def passes(copy: Path, test: Path) -> tuple[str, float]:
    """What a test file says in a copy, "passed", "failed" or "hangs", and how long it took [s]."""
    start = perf_counter()
    environment = os.environ | {"PYTHONPATH": str(copy / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
    file = str(test.relative_to(ROOT))
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--tb=no", file]
    with subprocess.Popen(
        command, cwd=copy, env=environment, start_new_session=True, stdout=DEVNULL, stderr=STDOUT
    ) as process:
        try:
            code = process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # this test and what it started
            return "hangs", perf_counter() - start
    return ("failed" if code else "passed"), perf_counter() - start


class Trials:
    """Copies of the tree, one a thread, and which test files pass in them without a fault."""

    def __init__(self, place: Path) -> None:
        self.place, self.local = place, threading.local()
        self.sound: dict[Path, bool] = {}

    def copy(self) -> Path:
        """The copy of this thread."""
        if not hasattr(self.local, "copy"):
            self.local.copy = Path(tempfile.mkdtemp(dir=self.place))
            for source in (ROOT / name for name in COPIED):
                put = partial(shutil.copytree, symlinks=True) if source.is_dir() else shutil.copy2
                put(source, self.local.copy / source.name)
            (self.local.copy / "results").symlink_to(ROOT / "results")
        copy: Path = self.local.copy
        return copy

    def verdict(self, fault: Fault, tests: list[Path]) -> str:
        """What the nearest tests say of a fault."""
        target = self.copy() / fault.path.relative_to(ROOT)
        whole, spent = target.read_bytes(), 0.0
        for test in tests:
            target.write_bytes(whole[: fault.start] + fault.new + whole[fault.end :])
            try:
                verdict, time = passes(self.copy(), test)
            finally:
                target.write_bytes(whole)
            if verdict != "passed" and self.is_sound(test):
                return verdict
            spent += time
            if spent > SECONDS:
                break
        return "passed"

    def is_sound(self, test: Path) -> bool:
        """Whether a test file passes without a fault."""
        if test not in self.sound:
            self.sound[test] = passes(self.copy(), test)[0] == "passed"
            if not self.sound[test]:
                print(f"{test.relative_to(ROOT)} fails without a fault: left out", flush=True)
        return self.sound[test]


def main() -> None:
    """Choose faults, try each, and print those that pass."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--number", type=int, default=200)
    parser.add_argument("--seed", type=int, default=2010)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--under", default="", help="only modules whose path in src/precursors begins so")
    chosen = parser.parse_args()
    begin, library = perf_counter(), ROOT / "src/precursors"
    sources = [
        path
        for path in sorted(library.rglob("*.py"))
        if str(path.relative_to(library)).startswith(chosen.under)
    ]
    faults = [fault for path in sources for fault in faults_of(path)]
    faults = random.Random(chosen.seed).sample(faults, min(chosen.number, len(faults)))
    known = modules()
    graph = {path: imports(path, known) for path in known.values()}
    files = sorted(path for path in graph if path.name.startswith("test_"))
    reach = {
        path: distances(path, graph) for path in files if not str(path.relative_to(ROOT)).startswith(ASIDE)
    }
    nearest = {
        fault.path: sorted(
            (test for test in reach if fault.path in reach[test]), key=lambda t: reach[t][fault.path]
        )
        for fault in faults
    }
    with tempfile.TemporaryDirectory() as place, ThreadPoolExecutor(chosen.jobs) as pool:
        trials = Trials(Path(place))
        verdicts = pool.map(lambda fault: trials.verdict(fault, nearest[fault.path]), faults)
        counts = Counter[str]()
        for fault, verdict in zip(faults, verdicts, strict=True):
            counts[verdict] += 1
            if verdict == "passed":
                print(f"survives: {fault.told()}", flush=True)
    seen = 1 - counts["passed"] / len(faults)
    print(f"{seen:.0%} of {len(faults)} faults are seen, in {perf_counter() - begin:.0f} s: {dict(counts)}")


if __name__ == "__main__":
    main()
