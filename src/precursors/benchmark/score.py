"""Score result files on the proved problems of docs/benchmark.md."""

import math
import re
from collections.abc import Mapping
from decimal import Decimal, InvalidOperation
from functools import cache
from itertools import takewhile
from pathlib import Path
from typing import Any

import numpy as np

from precursors.analysis.slips import slip_table
from precursors.analysis.summary import summary_of
from precursors.benchmark.compare import Truth, compare, until_global_slip
from precursors.model.checks import not_negative
from precursors.proof import Certificate
from precursors.solver.run import Record
from precursors.support.files import read_bytes

CERTIFICATES = Path(__file__).with_name("certificates")
NEEDED = ("time_s", "block", "mode", "tangential_load_N")
# Transitions: time [s], block, mode, load [N].
Rows = list[Any]


def problems() -> dict[str, Path]:
    """Return the certificate file of each problem, by its name."""
    files = sorted(CERTIFICATES.glob("*.json.gz"))
    return {path.name.removesuffix(".json.gz"): path for path in files}


@cache
def solution(problem: str) -> Truth:
    """Return the proved transitions of a problem."""
    known = problems()
    require(problem in known, problem, f"the problems are {', '.join(known)}")
    return Truth.proved(Certificate.load(known[problem]))


def score(path: str | Path, problem: str, ties: float = 0.0) -> dict[str, Any]:
    """Compare a result file with the proved solution of a problem.

    Rows whose times differ by at most `ties` [s] may be in any order. Each error
    is the largest before the first wrong transition. A value is NaN if the file ends
    too early to know it.

    Raises
    ------
    ValueError
        If the file is not a result of this problem; the message is one line.
    """
    truth = solution(problem)
    chain = truth.run.chain
    end = truth.run.duration
    listed = read_result(path, chain.n_blocks)
    check_units(path, listed[0], truth.run.transitions[0])
    rows = [row for row in listed if row["time_s"] <= end]
    given = [tuple(row[name] for name in NEEDED) for row in rows]
    true = truth.run.transitions.tolist()
    ordered = in_true_order(given, true, Decimal(repr(not_negative("ties", ties, "s"))))
    columns = np.array(ordered, dtype=float).reshape(-1, len(NEEDED)).T
    result = Record.from_columns(chain, end, *columns)
    whole = compare(result, truth)
    start = compare(until_global_slip(result), truth.until_global_slip())
    values = {
        "problem": problem,
        "transitions_right": whole.transitions_right,
        "transitions_true": whole.transitions_true,
        "first_wrong": in_words(ordered[whole.transitions_right :]),
        "should_be": in_words(true[whole.transitions_right :]),
        "time_error_s": whole.time_error,
        "load_error_N": whole.load_error,
        "time_error_to_global_slip_s": start.time_error,
        "load_error_to_global_slip_N": start.load_error,
    }
    for which, run in (("", result), ("_true", truth.run)):
        numbers = summary_of(slip_table(run))
        counted = numbers.events_counted if numbers.reached else math.nan
        values |= {
            f"events_counted{which}": counted,
            f"mu_sapp{which}": numbers.mu_sapp,
        }
    return values | {"ends_s": float(listed[-1]["time_s"])}


def in_words(transitions: Rows) -> str:
    """Describe the first transition of a list, or return "none"."""
    words = (
        f"block {i} to mode {m} at {float(t):.12g} s" for t, i, m, _ in transitions
    )
    return next(words, "none")


def in_true_order(listed: Rows, true: Rows, ties: Decimal) -> Rows:
    """Reorder transitions that are at most `ties` [s] apart as in the truth."""
    ordered = list(listed)
    for k, (_, block, mode, _) in enumerate(true[: len(listed)]):
        end = ordered[k][0] + ties
        tied = takewhile(end.__ge__, (time for time, *_ in ordered[k:]))
        blocks = [row[1] for row in ordered[k : k + len(list(tied))]]
        place = k + blocks.index(block) if block in blocks else k
        if ordered[place][1:3] != (block, mode):
            break
        ordered.insert(k, ordered.pop(place))
    return ordered


def read_result(path: str | Path, n_blocks: int) -> list[dict[str, Any]]:
    """Read the rows of a result file; blocks are numbered from 1."""
    text = read_bytes(path).decode("utf-8-sig", errors="replace")
    separator = next((s for s in ";\t" if re.search(f"(?m)^[^#\n]*{s}", text)), ",")
    lines = {
        number: [cell.strip('" ') for cell in line.split(separator)]
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip(' ,;\t"') and line[0] != "#"
    }
    header = lines.pop(min(lines)) if lines else []
    first = 0 if "block_from_0" in header else 1
    last = first + n_blocks - 1
    names = [name.removesuffix("_from_0") for name in header]
    for name in NEEDED:
        times = names.count(name)
        require(
            times == 1, path, f"{name} must occur once in the header, not {times} times"
        )
    require(bool(lines), path, "there is no transition below the header")
    modes: dict[Any, Any] = dict.fromkeys(range(first, last + 1), 0)
    rows: list[dict[str, Any]] = []
    time = Decimal(0)
    for number, cells in lines.items():
        at = f"{path}, line {number}"
        require(len(cells) == len(names), at, f"it must have {len(names)} cells")
        row = {
            name: decimal(f"{at}: {name}", cell)
            for name, cell in zip(names, cells, strict=True)
            if name in NEEDED
        }
        block = row["block"]
        mode = row["mode"]
        from_0 = " (is the column block_from_0?)" if block == 0 else ""
        allowed = f"block must be {first} to {last}, but is {block}{from_0}"
        require(block in modes, at, allowed)
        require(mode in (-1, 0, 1), at, f"mode must be -1, 0 or 1, but is {mode}")
        repeated = f"block {block} is in mode {mode} already: is a row missing?"
        require(mode != modes[block], at, repeated)
        require(row["time_s"] >= time, at, "time_s must not fall from row to row")
        time = row["time_s"]
        modes[block] = mode
        rows.append(row | {"block": int(block) + 1 - first, "mode": int(mode)})
    return rows


def check_units(path: str | Path, first: Mapping[str, Any], true: np.void) -> None:
    """Refuse a file whose first time or load has the right value in another unit, such
    as ms, min or kN."""
    for name in ("time_s", "tangential_load_N"):
        ratio = float(first[name]) / true[name.removesuffix("_s").removesuffix("_N")]
        for factor in (1e-6, 1e-3, 1 / 60, 1e3, 1e6):
            is_other = math.isclose(ratio, factor, rel_tol=0.01)
            require(not is_other, path, f"{name} is {factor:.3g} times what it must be")


def decimal(where: str, text: str) -> Decimal:
    """Read a number exactly, with a decimal point or comma."""
    try:
        number = Decimal(text.replace(",", ".").replace("_", "?"))
    except InvalidOperation:
        number = Decimal("nan")
    if not number.is_finite():
        raise ValueError(f"{where} must be a finite number, but is {text!r}")
    return number


def require(holds: bool, where: object, otherwise: str) -> None:
    """Raise a ValueError unless a condition holds."""
    if not holds:
        raise ValueError(f"{where}: {otherwise}")
