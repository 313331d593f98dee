"""Judging the claims by the tables as they lie in a directory."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from precursors.model.chain import FloatArray
from precursors.reproduction.ledger.claims import ROBUSTNESS, Claim, ClaimError, Evidence
from precursors.reproduction.ledger.rules import (
    FRAGILE,
    MISPRINT,
    NO_RESULT,
    NOT_REPRODUCED,
    REPRODUCED,
    ROWS,
    RULES,
    TAKES,
)
from precursors.support.files import read_table

# More values than this are told by their number, the smallest and the largest.
MOST_VALUES_SHOWN = 6


@dataclass(frozen=True)
class Judgement:
    """A line of the ledger; numbers with four digits, which are those of any processor unless `varies`."""

    id: str
    where: str
    kind: str
    statement: str
    unit: str
    paper: str
    ours: str
    rule: str
    verdict: str
    varies: str


def judge(
    claims: Iterable[Claim], tables: str | os.PathLike[str], names: Iterable[str] | None = None
) -> list[Judgement]:
    """Judge claims by the tables of a directory as they lie there; what has no row is not reproduced.

    A claim of no result is held against the tables of these `names`, or against all that lie there: while a
    workflow runs, others are being written.

    Raises
    ------
    ClaimError
        In one line: a table or column that a claim names is missing or holds no numbers, or a claim of no
        result that has one.
    """
    library = _Library(Path(tables), names)
    judgements = []
    for claim in claims:
        try:
            judgements.append(_judge(claim, library))
        except ClaimError as error:
            raise ClaimError(f"claim {claim.id}: {error}") from None
    return judgements


def to_table(judgements: Iterable[Judgement]) -> pd.DataFrame:
    """The ledger as a table, one row a claim; all text."""
    names = [field.name for field in fields(Judgement)]
    return pd.DataFrame([asdict(judgement) for judgement in judgements], columns=names, dtype=str)


def differences(found: pd.DataFrame, expected: pd.DataFrame, same_processor: bool = False) -> list[str]:
    """Say in a line each which claims are not as expected: new, gone, or of another verdict or numbers.

    Numbers of claims that vary are compared if both ledgers are of the same processor.
    """
    new, old = found.set_index("id"), expected.set_index("id")
    lines = [f"{name}: not among the expected claims" for name in new.index.difference(old.index, sort=False)]
    lines += [f"{name}: is missing" for name in old.index.difference(new.index, sort=False)]
    for name in new.index.intersection(old.index, sort=False):
        varies = new.loc[name, "varies"] == "True" and not same_processor
        for key in ("verdict",) if varies else ("verdict", "ours", "paper", "rule"):
            if new.loc[name, key] != old.loc[name, key]:
                lines.append(f"{name}: {key} is {new.loc[name, key]!r}, expected {old.loc[name, key]!r}")
    return lines


class _Library:
    """The tables of a directory, each read once."""

    def __init__(self, directory: Path, names: Iterable[str] | None) -> None:
        self.directory = directory
        self.names = None if names is None else set(names)
        self._tables: dict[str, pd.DataFrame] = {}

    def table(self, name: str) -> pd.DataFrame:
        if name not in self._tables:
            self._tables[name] = _read(self.directory / f"{name}.csv")
        return self._tables[name]

    def speaks_of(self, words: Sequence[str]) -> str | None:
        """The first column, or quantity that a table lists, which has one of the words in its name."""
        pattern = re.compile("|".join(map(re.escape, words)), re.IGNORECASE)
        for path in sorted(self.directory.glob("*.csv")):
            # The ledger itself speaks of what is not tested.
            if path.stem in ("claims", "erratum"):
                continue
            if self.names is not None and path.stem not in self.names:
                continue
            names = list(_read(path, nrows=0).columns)
            if "quantity" in names:
                names += _read(path, usecols=["quantity"])["quantity"].astype(str).unique().tolist()
            for name in filter(pattern.search, names):
                return f"{path.name}: {name}"
        return None


def _read(path: Path, **how: Any) -> pd.DataFrame:
    try:
        return read_table(path, **how)
    except FileNotFoundError:
        raise ClaimError(f"{path} is missing: the workflow writes it") from None
    except (ValueError, OSError) as error:
        raise ClaimError(str(error)) from None


def _judge(claim: Claim, library: _Library) -> Judgement:
    rule = RULES[claim.rule]
    values = _values(claim.evidence, library)
    reference = _reference(claim, library) if rule.compares else np.array([])
    ours = shown(values)
    if claim.rule == NO_RESULT:
        found = library.speaks_of(claim.words)
        if found:
            raise ClaimError(f"there is a result now ({found}): it needs a rule that tests it")
        ours = "not in the model"
        verdict = rule.otherwise
    elif len(values) == 0 or np.isnan([*values, *reference]).any():
        verdict = NOT_REPRODUCED
    elif rule.compares and len(reference) not in (1, len(values)):
        raise ClaimError(
            f"{len(values)} values are compared with {len(reference)}: allowed is one or as many"
        )
    elif not rule.holds(values, reference, claim.margin):
        verdict = rule.otherwise
    else:
        verdict = FRAGILE if _is_fragile(claim, library) else REPRODUCED
    return Judgement(
        id=claim.id,
        where=claim.where,
        kind=claim.kind,
        statement=claim.statement,
        unit=claim.unit,
        paper="; ".join(value if isinstance(value, str) else f"{value:.6g}" for value in claim.paper),
        ours=ours,
        rule=_rule_text(claim, reference),
        verdict=verdict,
        varies=str(claim.varies),
    )


def _values(evidence: Sequence[Evidence], library: _Library) -> FloatArray:
    return np.concatenate([np.array([]), *(_take(item, library) for item in evidence)])


def _reference(claim: Claim, library: _Library) -> FloatArray:
    if claim.against:
        return _values(claim.against, library)
    return np.array(claim.paper if claim.limit is None else [claim.limit], dtype=float)


def _take(item: Evidence, library: _Library) -> FloatArray:
    name, table = item.table, library.table(item.table)
    if item.rows != "all":
        _column(name, table, "is_global")
        table = ROWS[item.rows](table)
    for column, value in item.where:
        table = table[_column(name, table, column) == value]
    values = _numbers(name, table, item.column)
    if item.minus:
        values = values - _numbers(name, table, item.minus)
    if item.over:
        with np.errstate(divide="ignore", invalid="ignore"):
            values = values / _numbers(name, table, item.over)
    if item.by:
        along = _numbers(name, table, item.by)
        taken = np.polyfit(along, values, 1)[0] if len(values) > 1 else np.nan
    else:
        taken = TAKES[item.take](values)
    return np.atleast_1d(np.asarray(taken, dtype=np.float64))


def _column(name: str, table: pd.DataFrame, column: str) -> pd.Series:
    if column not in table:
        raise ClaimError(f"{name}.csv has no column {column!r}: it has {', '.join(table.columns)}")
    return table[column]


def _numbers(name: str, table: pd.DataFrame, column: str) -> FloatArray:
    values = pd.to_numeric(_column(name, table, column), errors="coerce")
    text = table[column][values.isna() & table[column].notna()]
    if len(text):
        raise ClaimError(f"{name}.csv, column {column}: {text.iloc[0]!r} is no number")
    return values.to_numpy(dtype=np.float64)


def _is_fragile(claim: Claim, library: _Library) -> bool:
    """Whether one of the numbers that the claim hangs on is in the class fragile."""
    classes = []
    for scene, quantity in claim.fragile:
        table = library.table(ROBUSTNESS)
        named = (_column(ROBUSTNESS, table, "scene") == scene) & (
            _column(ROBUSTNESS, table, "quantity") == quantity
        )
        if not named.any():
            raise ClaimError(f"{ROBUSTNESS}.csv has no row for {quantity} of {scene}")
        classes += _column(ROBUSTNESS, table, "class")[named].tolist()
    return "fragile" in classes


def shown(values: FloatArray) -> str:
    """Write values with four digits: equal ones once, and many by their number and range."""
    if len(values) == 0:
        return "none"
    texts = [f"{value:.4g}" for value in values]
    is_one, is_many = len(set(texts)) == 1, len(values) > MOST_VALUES_SHOWN
    if is_one:
        return f"{len(values)} values of {texts[0]}" if is_many else texts[0]
    if is_many:
        return f"{len(values)} values from {values.min():.4g} to {values.max():.4g}"
    return "; ".join(texts)


def _rule_text(claim: Claim, reference: FloatArray) -> str:
    text, margin = claim.rule, claim.margin
    if claim.against or claim.limit is not None:
        text += ", meant is " if RULES[claim.rule].otherwise == MISPRINT else " "
        text += shown(reference)
    if margin.digits is not None:
        text += f" {margin.digits} digits"
    if margin.tolerance:
        text += f", within {margin.tolerance:g}" + (f" {claim.unit}" if claim.unit != "1" else "")
    if margin.relative:
        text += f", within {margin.relative:g} of it"
    return text
