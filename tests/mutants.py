"""Put single faults into copies of the library and print those that the tests do not see (`make mutants`).

A fault is one edit of the text: a comparison, a sign or a product the other way round, another constant, a
condition negated, a statement left out. A constant of a figure's layout is not one, nor a step or a tolerance
at which a method is charted. First every test file is run without a fault, which says how long it takes and
which functions it enters. Then each fault is met by the files that enter its function, until they are four
and would take `SECONDS`: those that name its module first, then those of its own room, and quick ones before
slow ones. Nothing enters a compiled function: those that import its module meet it.

`survivors.md` says in a line why a fault cannot be seen, or need not be. Such a fault counts as one that
survives, and is tried again only with --all. The command fails where a survivor is not explained, or less
than `SHARE` is seen.
"""

from __future__ import annotations

import argparse
import ast
import builtins
import compileall
import contextlib
import faulthandler
import hashlib
import importlib
import multiprocessing
import os
import re
import shutil
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from importlib.machinery import SourceFileLoader
from multiprocessing.connection import Connection, wait
from pathlib import Path
from time import perf_counter
from types import CodeType
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[1]
LIBRARY = Path("src/precursors")
LEFT = ("results", "wheelhouse", ".venv", ".git", ".snakemake", ".*_cache")
# These compare files that are already there, or run the workflow.
ASIDE = ("tests/cluster/*", "tests/golden/test_golden.py", "tests/workflow/test_[dfr]*")
WARM = "tests/ensembles/test_study.py"  # compiles the kernel for all others
# What takes long to import: loaded once, before a process is forked for each fault.
HEAVY = (
    "flint", "h5py", "hypothesis", "jsonschema", "matplotlib.pyplot", "numba", "pandas",
    "scipy.integrate", "scipy.linalg", "scipy.optimize", "scipy.stats", "snakemake.cli", "sympy", "yaml",
)  # fmt: skip
SHARE = 0.85
SETTINGS = {"values", "quick", "whole", "quick_whole", "STEPS", "SIZES", "ROUNDS"}  # what is charted
SECONDS, FILES = 20.0, 4  # of tests without a fault, in processor time; at least so many files
# Of one test, which may have to compile the kernel, and of all that a fault meets [s]; or so many times what
# the slowest file takes without a fault, where the machine has other work.
LIMIT, PATIENCE, TIMES = 60.0, 600.0, (1.5, 10.0)
OTHERWISE = {
    "Lt": ("<", "<="), "LtE": ("<=", "<"), "Gt": (">", ">="), "GtE": (">=", ">"), "Eq": ("==", "!="),
    "NotEq": ("!=", "=="), "And": ("and", "or"), "Or": ("or", "and"), "Add": ("+", "-"), "Sub": ("-", "+"),
    "Mult": ("*", "/"), "Div": ("/", "*"),
}  # fmt: skip
Function = tuple[str, int]  # a file of the library and the line where the function begins, 0 for the module


class Fault(NamedTuple):
    """What stands in a file from one byte to another, what is put there instead, and in which function."""

    path: Path
    start: int
    end: int
    new: bytes
    function: Function

    def told(self) -> str:
        """Where it is, what stood there and what stands there: the same when other lines change."""
        text = (ROOT / self.path).read_bytes()
        old = " ".join(text[self.start : self.end].decode().split())
        line = text[text.rfind(b"\n", 0, self.start) + 1 :].split(b"\n", 1)[0].decode().strip()
        return f"{self.path.relative_to(LIBRARY)}: {old} -> {self.new.decode()} in: {line}"


def other_constant(value: bool | int | float) -> bool | int | float:
    """Another value of the same type."""
    if isinstance(value, bool):
        return not value
    return value + 1 if isinstance(value, int) else 1.5 * value or 1.0


def first_line(node: ast.FunctionDef) -> int:
    """The line of a function's first decorator, or of its name."""
    return min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])


def is_setting(node: ast.AST) -> bool:
    """Whether a node gives steps, tolerances or sizes at which something is charted: any would do."""
    if isinstance(node, ast.keyword):
        return node.arg in SETTINGS
    if isinstance(node, ast.Assign):
        return all(isinstance(target, ast.Name) and target.id in SETTINGS for target in node.targets)
    return isinstance(node, ast.Dict) and any(
        isinstance(key, ast.Constant) and key.value in SETTINGS for key in node.keys
    )


def faults_of(path: Path) -> Iterator[Fault]:
    """All faults of a module."""
    text = (ROOT / path).read_bytes()
    starts = [0, *(i + 1 for i, byte in enumerate(text) if byte == ord("\n"))]

    def place(node: ast.expr | ast.stmt) -> tuple[int, int]:
        end = starts[(node.end_lineno or 1) - 1] + (node.end_col_offset or 0)
        return starts[node.lineno - 1] + node.col_offset, end

    def edits(node: ast.AST) -> Iterator[tuple[int, int, bytes]]:
        pairs: list[tuple[ast.expr, ast.expr, ast.AST]] = []
        if isinstance(node, ast.Compare):
            terms = [node.left, *node.comparators]
            pairs = list(zip(terms[:-1], terms[1:], node.ops, strict=True))
        elif isinstance(node, ast.BinOp):
            pairs = [(node.left, node.right, node.op)]
        elif isinstance(node, ast.BoolOp):
            pairs = [(node.values[0], node.values[1], node.op)]
        elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            if "figures" not in path.parts:
                yield *place(node), repr(other_constant(node.value)).encode()
        elif isinstance(node, ast.If | ast.While | ast.IfExp) and "TYPE_CHECKING" not in ast.dump(node.test):
            start, end = place(node.test)
            yield start, end, b"(not (" + text[start:end] + b"))"
        elif isinstance(node, ast.AugAssign) or (
            isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        ):
            yield *place(node), b"pass"
        for left, right, operator in pairs:
            old, new = OTHERWISE.get(type(operator).__name__, ("", ""))
            first, last = place(left)[1], place(right)[0]
            sign = rb"(?<![\w*/<>=!])" + re.escape(old).encode() + rb"(?![\w*/<>=])"
            if old and (found := re.search(sign, text[first:last])):
                yield first + found.start(), first + found.end(), new.encode()

    def visit(node: ast.AST, function: int) -> Iterator[Fault]:
        if isinstance(node, ast.JoinedStr | ast.Raise | ast.Import | ast.ImportFrom) or is_setting(node):
            return
        for start, end, new in edits(node):
            yield Fault(path, start, end, new, (str(path), function))
        if isinstance(node, ast.FunctionDef):
            function = first_line(node)
        for name, field in ast.iter_fields(node):
            if name not in ("annotation", "returns"):
                for child in field if isinstance(field, list) else [field]:
                    if isinstance(child, ast.AST):
                        yield from visit(child, function)

    yield from visit(ast.parse(text), 0)


def chosen_faults(under: str, number: int, seed: int) -> list[Fault]:
    """A sample of the faults, which changes only in modules that change."""
    faults = {}
    for path in sorted((ROOT / LIBRARY).rglob("*.py")):
        if str(path.relative_to(ROOT / LIBRARY)).startswith(under):
            alike = Counter[str]()
            for fault in faults_of(path.relative_to(ROOT)):
                told = fault.told()
                alike[told] += 1
                faults[hashlib.sha256(f"{seed} {alike[told]} {told}".encode()).digest()] = fault
    return [faults[key] for key in sorted(faults)[:number]]


class Outcome(NamedTuple):
    """What test files said, their time [s], their processor time [s], and which functions they entered."""

    verdict: str
    wall: float = 0.0
    seconds: float = 0.0
    entered: frozenset[Function] = frozenset()


class Limit(NamedTuple):
    """Ends the process in which a test takes so long [s]."""

    seconds: float

    def pytest_runtest_logstart(self) -> None:
        faulthandler.dump_traceback_later(self.seconds, exit=True)


def mark_functions(copy: Path) -> set[Function]:
    """Have every function of the library add itself to a set when it is entered; compiled modules stay."""
    entered = set[Function]()
    vars(builtins)["_enter"] = lambda *function: entered.add(function)
    whole = SourceFileLoader.get_code

    def get_code(loader: SourceFileLoader, name: str) -> CodeType | None:
        path = Path(loader.get_filename(name))
        if not path.is_relative_to(copy / LIBRARY):
            return whole(loader, name)
        file, text = str(path.relative_to(copy)), path.read_bytes()
        entered.add((file, 0))
        tree = ast.parse(text)
        if not re.search(rb"\b(numba|compiled|inner|outer)\b", text):
            for node in ast.walk(tree):
                if isinstance(node, ast.FunctionDef):
                    mark = ast.parse(f"_enter({file!r}, {first_line(node)})").body
                    has_words = ast.get_docstring(node, clean=False) is not None
                    node.body[has_words:has_words] = mark
        return compile(ast.fix_missing_locations(tree), path, "exec")

    SourceFileLoader.get_code = get_code  # type: ignore[method-assign]
    return entered


def run_tests(copy: Path, files: list[str], marked: bool, limit: float, told: Connection) -> None:
    """Run test files in this process, which is a fork, until one fails."""
    begin = perf_counter()
    os.setsid()
    os.chdir(copy)
    for stream in (sys.stdout, sys.stderr):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    sys.path[:] = [str(copy / "src"), *(place for place in sys.path if Path(place) != ROOT / "tests")]
    os.environ["PYTHONPATH"] = str(copy / "src")
    entered = mark_functions(copy) if marked else set()
    code = pytest.main(["-x", "-q", "-p", "no:cacheprovider", "--tb=no", *files], plugins=[Limit(limit)])
    spent = perf_counter() - begin, sum(os.times()[:4])
    told.send(Outcome("failed" if code else "passed", *spent, frozenset(entered)))


class Copies:
    """Copies of the tree, one a job, in which test files are run in processes of their own."""

    def __init__(self, place: Path, jobs: int) -> None:
        self.whole = place / "whole"
        shutil.copytree(ROOT, self.whole, symlinks=True, ignore=shutil.ignore_patterns(*LEFT))
        (self.whole / "results").symlink_to(ROOT / "results")
        compileall.compile_dir(self.whole / "src", quiet=2)
        self.free = [place / str(job) for job in range(jobs)]

    def refresh(self, copy: Path, fault: Fault | None) -> None:
        """Make a copy whole, with the machine code that is known, and put a fault into it."""
        if not copy.exists():
            shutil.copytree(self.whole, copy, symlinks=True)
        shutil.rmtree(copy / "src")
        shutil.copytree(self.whole / "src", copy / "src")
        if fault:
            path, text = copy / fault.path, (self.whole / fault.path).read_bytes()
            path.write_bytes(text[: fault.start] + fault.new + text[fault.end :])
            if b"compiled" in text:  # Numba looks at a function's own file only
                for kept in path.parent.glob("__pycache__/*.nb[ci]"):
                    kept.unlink()


def outcomes(
    trials: list[tuple[Fault | None, list[str]]], copies: Copies, slowest: float, done: Callable[[Path], None]
) -> Iterator[tuple[int, Outcome]]:
    """What the tests say of each fault, as it becomes known; `done` gets the copy before it is used again."""
    fork = multiprocessing.get_context("fork")
    limit, patience = (max(least, n * slowest) for least, n in zip((LIMIT, PATIENCE), TIMES, strict=True))
    waiting, running = list(enumerate(trials))[::-1], {}
    while waiting or running:
        while waiting and copies.free:
            (index, (fault, files)), copy = waiting.pop(), copies.free.pop()
            copies.refresh(copy, fault)
            here, there = fork.Pipe(duplex=False)
            process = fork.Process(target=run_tests, args=(copy, files, fault is None, limit, there))
            process.start()
            there.close()
            running[here] = process, index, copy, perf_counter() + patience
        ready = wait(running, timeout=min(end for *_, end in running.values()) - perf_counter())
        for here, (process, index, copy, end) in list(running.items()):
            if here not in ready and perf_counter() < end:
                continue
            outcome = Outcome("ended")
            if here in ready:
                with contextlib.suppress(EOFError):
                    outcome = here.recv()
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)  # the process and what it started
            process.join()
            del running[here]
            done(copy)
            copies.free.append(copy)
            yield index, outcome


def test_files() -> list[str]:
    """Test files that call the library."""
    tests = {path.relative_to(ROOT) for path in ROOT.glob("tests/*/test_*.py")}
    return sorted(str(path) for path in tests if not any(path.match(pattern) for pattern in ASIDE))


def chosen_tests(fault: Fault, sound: dict[str, Outcome]) -> list[str]:
    """The test files that a fault meets."""
    meet = [file for file, outcome in sound.items() if fault.function in outcome.entered]
    if not meet:
        module = (fault.function[0], 0)
        meet = [file for file, outcome in sound.items() if module in outcome.entered]
    room = fault.path.relative_to(LIBRARY).parts[0].removesuffix(".py")
    names = {file: re.search(rf"\b{fault.path.stem}\b", (ROOT / file).read_text()) for file in meet}
    meet.sort(key=lambda file: (names[file] is None, Path(file).parts[1] != room, sound[file].seconds))
    chosen, seconds = list[str](), 0.0
    for file in meet:
        if len(chosen) >= FILES and seconds > SECONDS:
            break
        chosen.append(file)
        seconds += sound[file].seconds
    return chosen


def main() -> int:
    """Choose faults, try each, and print those that pass."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--number", type=int, default=200)
    parser.add_argument("--seed", type=int, default=2010)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--all", action="store_true", help="also those that survivors.md explains")
    parser.add_argument("--under", default="", help="only modules whose path in src/precursors begins so")
    chosen = parser.parse_args()
    begin = perf_counter()
    for name in HEAVY:
        importlib.import_module(name)
    faults = chosen_faults(chosen.under, chosen.number, chosen.seed)
    explained = dict(
        re.findall(r"^- `(.+)`\n  (.+)", (ROOT / "tests/survivors.md").read_text(), re.MULTILINE)
    )
    counts, unexplained, sound = Counter[str](), 0, dict[str, Outcome]()
    with tempfile.TemporaryDirectory() as place:
        copies = Copies(Path(place).resolve(), chosen.jobs)
        files = [WARM] * chosen.jobs + test_files()

        def keep(copy: Path) -> None:
            shutil.copytree(copy / "src", copies.whole / "src", dirs_exist_ok=True)

        for index, outcome in outcomes([(None, [file]) for file in files], copies, PATIENCE, keep):
            if outcome.verdict == "passed":
                sound[files[index]] = outcome
            else:
                print(f"{files[index]} fails without a fault: left out", flush=True)
        print(f"{len(sound)} test files: {perf_counter() - begin:.0f} s", flush=True)
        known = [fault.told() for fault in faults if fault.told() in explained and not chosen.all]
        for told in known:
            print(f"survives: {told}\n    {explained[told]}")
        counts["passed"] = len(known)
        trials = [(fault, chosen_tests(fault, sound)) for fault in faults if fault.told() not in known]
        slowest = max(outcome.wall for outcome in sound.values())
        for index, outcome in outcomes(trials, copies, slowest, lambda copy: None):
            counts[outcome.verdict] += 1
            if outcome.verdict == "passed":
                told = trials[index][0].told()
                unexplained += told not in explained
                print(f"survives: {told}\n    {explained.get(told, 'NOT EXPLAINED')}", flush=True)
            elif counts.total() % 20 == 0:
                print(f"{counts.total()} of {len(faults)}: {perf_counter() - begin:.0f} s", flush=True)
    seen = 1 - counts["passed"] / len(faults)
    print(
        f"{seen:.1%} of {len(faults)} faults are seen, in {perf_counter() - begin:.0f} s: {dict(counts)}; "
        f"{unexplained} survivors are not explained"
    )
    return int(seen < SHARE or unexplained > 0)


if __name__ == "__main__":
    sys.exit(main())
