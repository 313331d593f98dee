"""Put single faults into copies of the project and print those that the tests do not
see (`make mutants`).

A fault is one edit: a comparison, a sign or a product the other way round, another
constant, a condition negated, a statement left out, in the library, in the workflow's
scripts and in the explorer's JavaScript. No fault is what cannot change a result: a
number or JavaScript that only says where ink goes, the sign of a ball about zero
(`BALL`), a setting at which something is charted (`SETTINGS`), a guard against a slip
of ours and how code is compiled (`NEUTRAL`), where ticks and panels stand (`LAYOUT`),
how much room is made and how much is done at once (`ROOM`).

First every test is run without a fault, which says what it costs and which functions it
enters. Then each fault meets the tests that enter its function, until one fails or they
have cost `SECONDS`: quick ones first, and files of its own room and those that name its
module before others. Nothing is seen to enter a compiled function or a script of the
page: tests that import its module meet it. Those of the workflow meet faults of scripts.

`survivors.md` says why a fault cannot be seen, or need not be. Such a fault counts as
one that survives, and is not tried. The command fails where less than `SHARE` is seen
with one of the seeds.
"""

from __future__ import annotations

import argparse
import ast
import builtins
import compileall
import contextlib
import hashlib
import importlib
import multiprocessing
import os
import re
import resource
import secrets
import shutil
import signal
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from importlib.machinery import SourceFileLoader
from itertools import product
from multiprocessing.connection import Connection
from pathlib import Path
from time import perf_counter
from types import CodeType
from typing import Any, NamedTuple

import psutil
import pytest
from browser import find_browser

ROOT = Path(__file__).parents[1]
SOURCES, SCRIPTS = Path("src"), Path("workflow/scripts")
# tests that import it meet the faults of the JavaScript
PAGE = "src/maegawa2010/explorer/page.py"
COMPILED = {"kernel", "methods", "larger", "models"}  # directories with compiled code
LEFT = ("results", "wheelhouse", ".venv", ".git", ".snakemake", ".*_cache")
# These compare files that are already there, or run the workflow.
ASIDE = ("tests/cluster/*", "tests/golden/test_golden.py", "tests/workflow/test_[dfr]*")
# What takes long to import: loaded once, before a process is forked for each fault.
HEAVY = (
    "flint", "h5py", "jsonschema", "matplotlib.pyplot", "numba", "pandas",
    "scipy.integrate", "scipy.linalg", "scipy.optimize", "scipy.stats", "snakemake.cli", "sympy", "yaml",
)  # fmt: skip
SHARE = 0.80
# Processor time of the tests that a fault meets, when they have no fault.
SECONDS = 20.0
# Of one test [s]: beside so many times what it costs without a fault; more where it may
# have to compile.
TIMES, LIMIT, COMPILING = 5.0, 10.0, 60.0
# s, for all that a fault meets, where a test waits for something that never comes
PATIENCE = 300.0
PAIRS = (
    (ast.Lt, ast.LtE),
    (ast.Gt, ast.GtE),
    (ast.Eq, ast.NotEq),
    (ast.And, ast.Or),
    (ast.Add, ast.Sub),
)
OPPOSITE: dict[type[ast.AST], type[Any]] = dict((*PAIRS, (ast.Mult, ast.Div)))
OPPOSITE |= {new: old for old, new in OPPOSITE.items()}
OF_SCRIPTS = {"<": "<=", ">": ">=", "===": "!==", "&&": "||", "+": "-", "*": "/"}
OF_SCRIPTS |= {new: old for old, new in OF_SCRIPTS.items()}
# Comments and texts, then an operator between blanks, then a number.
SCRIPT = re.compile(
    r"""//.*|/\*[\s\S]*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`"""
    r"|(?<= )(?P<operator>[<>]=?|[!=]==|&&|\|\||[-+*/])(?= )|(?<![\w.#])(?P<number>\d+(?:\.\d+)?)(?![\w.])"
)
BALL = re.compile(r"arb\(0, |around$")  # about zero
SETTINGS = {
    "CHARTED",
    "values",
    "quick",
    "ROUNDS",
}  # what is charted
# Arguments that change no result: guards against a slip of ours, signs of symbols, how
# code is compiled, when a line reaches the screen.
NEUTRAL = {
    "strict",
    "frozen",
    "slots",
    "exist_ok",
    "parents",
    "stacklevel",
    "maxsize",
    "nogil",
    "cache",
}
NEUTRAL |= {"positive", "real", "indent", "eq", "forceinline", "flush"}
# Of arrays that grow as needed, of batches and of a line of the cache: runs do not
# depend on them.
ROOM = {
    "FIRST_ROOM",
    "SHARED_ROOM",
    "LARGEST_BATCH",
    "BATCHES_PER_THREAD",
    "BLOCKS_PER_BATCH",
}
ROOM |= {"WINDOWS_PER_CALL", "LEGS_PER_CALL", "KEPT", "LINE", "_NUMBERS_AT_ONCE"}
LAYOUT = {
    "align_ylabels",
    "grid",
    "minorticks_off",
    "set_major_locator",
    "set_minor_locator",
    "tick_params",
}
LAYOUT |= {"subplots_adjust", "tick_top"}
Function = tuple[
    str, int
]  # a file and the line where the function begins, 0 for the module


class Fault(NamedTuple):
    """What stands in a file from one byte to another, what is put there instead, and in
    which function."""

    path: Path
    start: int
    end: int
    new: str
    function: Function

    def told(self) -> str:
        """Where it is, what stood there and what stands there: the same when other
        lines change."""
        text = (ROOT / self.path).read_bytes()
        old = " ".join(text[self.start : self.end].decode().split())
        line = (
            text[text.rfind(b"\n", 0, self.start) + 1 :]
            .split(b"\n", 1)[0]
            .decode()
            .strip()
        )
        place = (
            self.path.relative_to(SOURCES)
            if self.path.is_relative_to(SOURCES)
            else self.path
        )
        where = f" in: {line}" if re.fullmatch(r"[\w.]+|\W{1,3}", old) else ""
        return f"{place}: {old} -> {self.new}{where}"


def first_line(node: ast.FunctionDef) -> int:
    """The line of a function's first decorator, or of its name."""
    return min(part.lineno for part in [node, *node.decorator_list])


def is_neutral(node: ast.AST) -> bool:
    """Whether no result depends on a node: a setting of a chart, any of which would do,
    or a guard."""
    match node:
        case ast.keyword(arg=name) | ast.Assign([ast.Name(name)]):
            return name in SETTINGS | NEUTRAL | ROOM
        case ast.Expr(ast.Call(ast.Attribute(attr=name))):
            return name in LAYOUT
    return isinstance(node, ast.JoinedStr | ast.Raise | ast.Import | ast.ImportFrom)


def edits(node: ast.AST) -> Iterator[tuple[ast.expr | ast.stmt, ast.AST]]:
    """What may be put in the place of a node, or of a part of it."""
    match node:
        case ast.Compare(left, [operator], right) if type(operator) in OPPOSITE:
            yield node, ast.Compare(left, [OPPOSITE[type(operator)]()], right)
        case ast.BinOp(left, operator, right) if type(
            operator
        ) in OPPOSITE and not BALL.match(ast.unparse(right)):
            yield node, ast.BinOp(left, OPPOSITE[type(operator)](), right)
        case ast.BoolOp(operator, values):
            yield node, ast.BoolOp(OPPOSITE[type(operator)](), values)
        case ast.Constant(bool(value)):
            yield node, ast.Constant(not value)
        case ast.Constant(int(value)):
            yield node, ast.Constant(value + 1)
        case ast.Constant(float(value)):
            yield node, ast.Constant(1.5 * value or 1.0)
        case ast.If(test) | ast.While(test) | ast.IfExp(test) if (
            "TYPE_CHECKING" not in ast.dump(test)
        ):
            yield test, ast.UnaryOp(ast.Not(), test)
        case ast.AugAssign() | ast.Expr(ast.Call()):
            yield node, ast.Pass()


def faults_of(path: Path) -> Iterator[Fault]:
    """All faults of a module."""
    text = (ROOT / path).read_bytes()
    starts = [0, *(i + 1 for i, byte in enumerate(text) if byte == ord("\n"))]
    in_figure = "figures" in path.parts

    def visit(node: ast.AST, function: int) -> Iterator[Fault]:
        if is_neutral(node):
            return
        for old, new in edits(node):
            if not (
                in_figure and isinstance(new, ast.Constant)
            ):  # where something is drawn, and how large
                start = starts[old.lineno - 1] + old.col_offset
                end = starts[(old.end_lineno or 1) - 1] + (old.end_col_offset or 0)
                bracketed = (
                    f"({ast.unparse(new)})"
                    if isinstance(new, ast.UnaryOp)
                    else ast.unparse(new)
                )
                yield Fault(path, start, end, bracketed, (str(path), function))
        if isinstance(node, ast.FunctionDef):
            function = first_line(node)
        for name, field in ast.iter_fields(node):
            if name not in ("annotation", "returns"):
                for child in field if isinstance(field, list) else [field]:
                    if isinstance(child, ast.AST):
                        yield from visit(child, function)

    yield from visit(ast.parse(text), 0)


def script_faults(path: Path) -> Iterator[Fault]:
    """All faults of a JavaScript file; numbers are of the layout but in the solver."""
    text = (ROOT / path).read_text(encoding="utf-8")
    for found in SCRIPT.finditer(text):
        if operator := found["operator"]:
            new = OF_SCRIPTS[operator]
        elif found["number"] and path.stem == "solver":
            new = (
                repr(1.5 * float(found[0]))
                if "." in found[0]
                else str(int(found[0]) + 1)
            )
        else:
            continue
        start, end = (len(text[:place].encode()) for place in found.span())
        yield Fault(path, start, end, new, (PAGE, 0))


def chosen_faults(under: list[str], number: int, seed: int) -> list[Fault]:
    """A sample of the faults, which changes only in modules that change."""
    paths = [*(ROOT / SOURCES).rglob("*.py"), *(ROOT / SCRIPTS).glob("*.py")]
    if find_browser():
        paths += (
            path for path in (ROOT / SOURCES).rglob("*.js") if path.stem != "drawing"
        )
    else:
        print("no Chromium or Chrome here: the explorer's JavaScript is left out")
    faults = {}
    for path in sorted(file.relative_to(ROOT) for file in paths):
        if str(path).startswith(tuple(under)):
            for fault in (script_faults if path.suffix == ".js" else faults_of)(path):
                faults[hashlib.sha256(f"{seed} {fault}".encode()).digest()] = fault
    return [faults[key] for key in sorted(faults)[:number]]


def mark_functions(copy: Path) -> set[Function]:
    """Have every function of a copy add itself to a set when it is entered; compiled
    modules stay."""
    entered = set[Function]()
    vars(builtins)["_enter"] = lambda *function: entered.add(function)
    whole = SourceFileLoader.get_code

    def get_code(loader: SourceFileLoader, name: str) -> CodeType | None:
        path = Path(loader.get_filename(name))
        if not any(path.is_relative_to(copy / part) for part in (SOURCES, SCRIPTS)):
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


def spent() -> float:
    """Processor time of this process and of those that it started, a browser among them
    [s]."""
    seconds = sum(os.times()[:4])
    for process in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.Error):
            seconds += sum(process.cpu_times()[:2])
    return seconds


class Test(NamedTuple):
    """A test, its processor time without a fault [s], and which functions it enters."""

    name: str
    seconds: float
    entered: frozenset[Function]


class Job(NamedTuple):
    """Tests to run, file by file, each with the processor time after which it has
    failed [s], and a fault."""

    files: list[dict[str, float]]
    fault: Fault | None = None


class Outcome(NamedTuple):
    """Whether all tests passed, the processor time with imports and fixtures [s], and
    the tests."""

    passed: bool
    seconds: float = 0.0
    tests: tuple[Test, ...] = ()


class Watch:
    """Times the tests, notes what they enter, and ends the process where one costs more
    than it may."""

    def __init__(self, entered: set[Function], job: Job) -> None:
        self.entered, self.most = (
            entered,
            {name: most for file in job.files for name, most in file.items()},
        )
        self.shared, self.tests, self.before, self.cost = (
            set[Function](),
            list[Test](),
            0.0,
            0.0,
        )

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        if nodeid in self.most:
            limit = int(sum(os.times()[:2]) + self.most[nodeid]) + 1
            resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        now = spent()
        self.cost = max(
            self.cost, now
        )  # a browser that has ended is not counted any longer
        if report.when == "call":
            self.tests.append(
                Test(report.nodeid, now - self.before, frozenset(self.entered))
            )
        else:  # what imports and fixtures enter counts for every test of the file
            self.shared |= self.entered
        if (
            report.when != "setup" or not self.tests
        ):  # what fixtures cost: of the first test for the file
            self.before = now
        self.entered.clear()


def run_tests(copy: Path, job: Job, answer: Connection) -> None:
    """Run tests in this process, which is a fork, until one fails."""
    os.setsid()
    os.chdir(copy)
    for stream in (sys.stdout, sys.stderr):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    sys.path[:] = [
        str(copy / "src"),
        *(place for place in sys.path if Path(place) != ROOT / "tests"),
    ]
    sys.dont_write_bytecode = job.fault is not None
    os.environ |= {"PYTHONDONTWRITEBYTECODE": "1" if job.fault else ""}
    os.environ |= {"PYTHONPATH": str(copy / "src"), "XDG_CACHE_HOME": str(copy.parent)}
    watch = Watch(set() if job.fault else mark_functions(copy), job)
    options = ["-x", "-q", "--tb=no", "-p", "no:cacheprovider", "-p", "no:xdist"]
    passed = all(
        pytest.main([*options, *file], plugins=[watch]) == 0 for file in job.files
    )
    tests = (test._replace(entered=test.entered | watch.shared) for test in watch.tests)
    answer.send(Outcome(passed, max(spent(), watch.cost), tuple(tests)))


def attempt(place: Path, job: Job) -> Outcome:
    """Run a job in a process of its own: without a fault in the shared copy, else in
    one of this worker."""
    copy = place / "whole"
    if fault := job.fault:
        copy = place / str(os.getpid())
        if not copy.exists():
            shutil.copytree(place / "whole", copy, symlinks=True)
        text = (copy / fault.path).read_bytes()
        (copy / fault.path).write_bytes(
            text[: fault.start] + fault.new.encode() + text[fault.end :]
        )
    fork = multiprocessing.get_context("fork")
    here, there = fork.Pipe(duplex=False)
    process = fork.Process(target=run_tests, args=(copy, job, there))
    process.start()
    there.close()
    outcome = Outcome(False)
    with contextlib.suppress(EOFError):
        if here.poll(PATIENCE):
            outcome = here.recv()
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)  # the process and what it started
    process.join()
    if fault:
        shutil.copy2(place / "whole" / fault.path, copy / fault.path)
    return outcome


def chosen_tests(fault: Fault, sound: dict[str, Outcome]) -> Job:
    """The tests that a fault meets: files that have most to do with it first, and quick
    tests first."""
    stem, every = (
        fault.path.stem,
        [test for outcome in sound.values() for test in outcome.tests],
    )
    places = fault.function, (fault.function[0], 0)
    place = next(
        (place for place in places if any(place in test.entered for test in every)),
        None,
    )
    room = (
        "workflow"
        if fault.path.is_relative_to(SCRIPTS)
        else fault.path.parts[2].removesuffix(".py")
    )

    def enters(test: Test) -> bool:
        return place is None or place in test.entered

    found = []
    for file, outcome in sound.items():
        is_named = re.search(rf"\b{stem}\b", (ROOT / file).read_text()) is not None
        is_near = Path(file).parts[1] == room
        # A job of Snakemake is a process of its own, which nothing watches.
        is_met = place or is_named or (is_near and fault.path.is_relative_to(SCRIPTS))
        if is_met and any(map(enters, outcome.tests)):
            start = outcome.seconds - sum(test.seconds for test in outcome.tests)
            far = 2 - is_named - is_near
            found.append((far, outcome.seconds, start, outcome.tests))
    files, cost = list[dict[str, float]](), 0.0
    limit = COMPILING if fault.path.parent.name in COMPILED else LIMIT
    # Others of a file see what a test that entered the function has left in a cache:
    # they come last.
    for first, (*_, start, tests) in product((True, False), sorted(found)):
        chosen = dict[str, float]()
        for test in sorted(
            tests, key=lambda test: (stem not in test.name, test.seconds)
        ):
            expected = test.seconds + (0.0 if chosen else start)
            if enters(test) == first and (cost + expected <= SECONDS or not cost):
                chosen[test.name] = limit + TIMES * expected
                cost += expected
        files += [chosen] if chosen else []
    return Job(files, fault)


def main() -> int:
    """Try a sample of the faults for each seed, and print those that pass."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--number", type=int, default=100, help="faults for each seed")
    parser.add_argument("--seed", type=int, nargs="+", help="default: a new one")
    parser.add_argument("--jobs", type=int, default=2)
    words = "only files whose path begins so, or so"
    parser.add_argument("--under", nargs="+", default=[""], help=words)
    chosen = parser.parse_args()
    begin, seeds = perf_counter(), chosen.seed or [secrets.randbelow(10**6)]
    print("--seed", *seeds, flush=True)
    for name in HEAVY:
        importlib.import_module(name)
    samples = {seed: chosen_faults(chosen.under, chosen.number, seed) for seed in seeds}
    words = (ROOT / "tools/survivors.md").read_text()
    explained = dict(re.findall(r"^- `(.+)`\n  (.+)", words, re.MULTILINE))
    faults = [fault for sample in samples.values() for fault in sample]
    tried = [fault for fault in dict.fromkeys(faults) if fault.told() not in explained]
    survivors = {fault for fault in faults if fault.told() in explained}
    fork = multiprocessing.get_context("fork")
    with (
        tempfile.TemporaryDirectory() as directory,
        ProcessPoolExecutor(chosen.jobs, fork) as pool,
    ):
        place = Path(directory).resolve()
        sound = record(pool, place)
        print(
            f"{len(sound)} test files without a fault: {perf_counter() - begin:.0f} s",
            flush=True,
        )
        jobs = [chosen_tests(fault, sound) for fault in tried]
        for fault, outcome in zip(
            tried, pool.map(partial(attempt, place), jobs), strict=True
        ):
            if outcome.passed:
                survivors.add(fault)
                print(
                    f"survives {len(outcome.tests)} tests: {fault.told()}", flush=True
                )
    shares = []
    for seed, sample in samples.items():
        left = [fault for fault in sample if fault in survivors]
        known = sum(fault.told() in explained for fault in left)
        shares.append(1 - len(left) / len(sample))
        print(
            f"--seed {seed}: {shares[-1]:.1%} of {len(sample)} faults are seen; ",
            end="",
        )
        print(f"survivors.md explains {known} of {len(left)} survivors")
    used = sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    print(f"{perf_counter() - begin:.0f} s, {used:.0f} s of processor time")
    return int(min(shares) < SHARE)


def record(pool: ProcessPoolExecutor, place: Path) -> dict[str, Outcome]:
    """Copy the project to `place`, and run every test file there, those that fail left
    out."""
    tests = (path.relative_to(ROOT) for path in ROOT.glob("tests/*/test_*.py"))
    files = sorted(
        str(path) for path in tests if not any(path.match(pattern) for pattern in ASIDE)
    )
    ignore = shutil.ignore_patterns(*LEFT)
    shutil.copytree(
        ROOT,
        place / "whole",
        symlinks=True,
        ignore=lambda folder, names: ignore(
            folder, names if folder == str(ROOT) else []
        ),
    )
    (place / "whole/results").symlink_to(ROOT / "results")
    compileall.compile_dir(place / "whole/src", quiet=2)
    code = Path(
        os.environ.get("XDG_CACHE_HOME") or "~/.cache", "precursors"
    ).expanduser()
    if code.is_dir():  # machine code that is kept
        shutil.copytree(code, place / "precursors")
    found = pool.map(partial(attempt, place), [Job([{file: 0.0}]) for file in files])
    sound = dict(zip(files, found, strict=True))
    for file in [file for file, outcome in sound.items() if not outcome.passed]:
        print(f"{file} fails without a fault: left out", flush=True)
        del sound[file]
    return sound


if __name__ == "__main__":
    sys.exit(main())
