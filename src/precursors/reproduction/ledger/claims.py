"""Reading the claims: what one consists of, and what is wrong with one that is not written so."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from precursors.model.plain_yaml import read_yaml
from precursors.reproduction.ledger.rules import KINDS, NO_RESULT, ROUNDS, ROWS, RULES, SLOPE, TAKES, Margin

# Table of the spread study: scene, quantity, class (robust, sensitive or fragile).
ROBUSTNESS = "robustness"

EXACTLY = Margin()


class ClaimError(ValueError):
    """A claim that cannot be judged as it is written: which, and what is allowed."""


@dataclass(frozen=True)
class Evidence:
    """Numbers of one table: rows of a column, and what is made of them.

    Attributes
    ----------
    table, column : str
        results/tables/{table}.csv, and its column.
    minus, over : str or None
        A second column, which is subtracted or divided by.
    rows : str
        A key of ROWS.
    where : tuple of (str, value)
        Columns and the values that these rows must have in them.
    take : str
        A key of TAKES.
    by : str or None
        For take: slope, the column that the slope is with respect to.
    """

    table: str
    column: str
    minus: str | None = None
    over: str | None = None
    rows: str = "all"
    where: tuple[tuple[str, Any], ...] = ()
    take: str = "each"
    by: str | None = None


@dataclass(frozen=True)
class Claim:
    """A statement of the paper in our words, and how the results judge it.

    Attributes
    ----------
    id, where, kind, statement : str
        Name; place in the paper; a key of KINDS; the statement.
    rule : str
        A key of RULES.
    evidence, against : tuple of Evidence
        What is judged, and what it is compared with where that is a result as well.
    paper : tuple
        Numbers that the paper prints, or its words; empty if neither.
    limit : float or None
        Number to compare with where the paper prints none.
    unit : str
        Unit of the values.
    margin : Margin
        How exactly.
    varies : bool
        Whether the numbers differ from one processor to another, so that the verdict alone is to stay.
    words : tuple of str
        For rule: no result, what a table would have to speak of to make the claim testable.
    fragile : tuple of (scene, quantity)
        Rows of the robustness table that tell whether the numbers hang on the last digits of the parameters.
    """

    id: str
    where: str
    kind: str
    statement: str
    rule: str
    evidence: tuple[Evidence, ...] = ()
    against: tuple[Evidence, ...] = ()
    paper: tuple[Any, ...] = ()
    limit: float | None = None
    unit: str = ""
    margin: Margin = EXACTLY
    varies: bool = False
    words: tuple[str, ...] = ()
    fragile: tuple[tuple[str, str], ...] = ()


def read_claims(path: str | os.PathLike[str]) -> list[Claim]:
    """Read the claims and refuse what is not in the vocabulary of this module.

    Raises
    ------
    ClaimError
        In one line: which file and claim, what is wrong, and what is allowed.
    """
    try:
        content = read_yaml(path)
    except ValueError as error:
        raise ClaimError(str(error)) from None
    if not isinstance(content, list) or not all(isinstance(entry, dict) for entry in content):
        raise ClaimError(f"{path}: allowed is a list of claims, each a table of keys and values")
    claims = []
    for number, entry in enumerate(content, start=1):
        name = f"{path}: claim {entry.get('id', number)}"
        try:
            claims.append(_claim(entry))
        except ClaimError as error:
            raise ClaimError(f"{name}: {error}") from None
        if claims[-1].id in [claim.id for claim in claims[:-1]]:
            raise ClaimError(f"{name}: the id stands twice: allowed is one claim an id")
    return claims


def tables_needed(claims: Iterable[Claim]) -> list[str]:
    """Names of the tables that the claims are judged by, each once, in order of first use."""
    names = [item.table for claim in claims for item in (*claim.evidence, *claim.against)]
    if any(claim.fragile for claim in claims):
        names.append(ROBUSTNESS)
    return list(dict.fromkeys(names))


def scenes_needed(claims: Iterable[Claim]) -> list[str]:
    """Scenes whose slips and traces the claims are judged by: those of the paper."""
    names = [re.fullmatch(r"(.+)_(slips|trace)", table) for table in tables_needed(claims)]
    return list(dict.fromkeys(name[1] for name in names if name))


_TEXTS = ("id", "where", "kind", "statement", "rule", "unit")
_MARGIN = ("tolerance", "relative", "digits")
_KEYS = (*_TEXTS, *_MARGIN, "evidence", "against", "paper", "limit", "varies", "words", "fragile")


def _claim(entry: Mapping[str, Any]) -> Claim:
    _check_keys(entry, _KEYS, needed=("id", "where", "kind", "statement", "rule"))
    texts = {key: entry[key] for key in _TEXTS if key in entry}
    for key, text in texts.items():
        if not isinstance(text, str) or not text:
            raise ClaimError(f"{key} = {text!r}: allowed is a text")
    _one_of("kind", entry["kind"], KINDS)
    rule = _one_of("rule", entry["rule"], RULES)
    if "limit" in entry and not _is_number(entry["limit"]):
        raise ClaimError(f"limit = {entry['limit']!r}: allowed is a number")
    if not isinstance(entry.get("varies", False), bool):
        raise ClaimError(f"varies = {entry['varies']!r}: allowed are true and false")
    claim = Claim(
        **texts,
        evidence=tuple(_evidence("evidence", entry)),
        against=tuple(_evidence("against", entry)),
        paper=tuple(_list(entry.get("paper", []))),
        limit=entry.get("limit"),
        margin=_margin(rule, entry),
        varies=entry.get("varies", False),
        words=tuple(_list(entry.get("words", []))),
        fragile=tuple(_fragile(entry)),
    )
    if rule == NO_RESULT:
        if claim.evidence or not claim.words or not all(isinstance(word, str) for word in claim.words):
            raise ClaimError(f"rule: {rule} needs words that no table speaks of, and allows no evidence")
        return claim
    if not claim.evidence or claim.words:
        raise ClaimError(f"rule: {rule} needs evidence, and allows no words")
    numbers = bool(claim.paper) and all(map(_is_number, claim.paper))
    if RULES[rule].compares and not (claim.against or claim.limit is not None or numbers):
        raise ClaimError(f"rule: {rule} needs against, limit or numbers of the paper to compare with")
    return claim


def _margin(rule: str, entry: Mapping[str, Any]) -> Margin:
    given = {key: entry[key] for key in _MARGIN if key in entry}
    for key, value in given.items():
        if not _is_number(value) or value < 0:
            raise ClaimError(f"{key} = {value!r}: allowed is a number, not negative")
    if (rule == ROUNDS) != ("digits" in given) or not isinstance(given.get("digits", 0), int):
        raise ClaimError(f"digits: needed with rule: {ROUNDS} as a whole number, and allowed with it only")
    return Margin(**given)


def _fragile(entry: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for item in _list(entry.get("fragile", [])):
        if not isinstance(item, dict):
            raise ClaimError(f"fragile = {item!r}: allowed are scenes and quantity")
        _check_keys(item, ("scenes", "quantity"), needed=("scenes", "quantity"))
        for scene in _list(item["scenes"]):
            yield scene, item["quantity"]


_NAMES = ("table", "column", "minus", "over", "by")
_EVIDENCE = (*_NAMES, "where", "rows", "take", "scenes")


def _evidence(key: str, entry: Mapping[str, Any]) -> Iterator[Evidence]:
    """One evidence for each item and scene; {scene} in a text of the item stands for the scene's name."""
    for item in _list(entry.get(key, [])):
        if not isinstance(item, dict):
            raise ClaimError(f"{key} = {item!r}: allowed are tables of keys and values")
        _check_keys(item, _EVIDENCE, needed=("table", "column"))
        for name in _NAMES:
            if not isinstance(item.get(name, ""), str):
                raise ClaimError(f"{key}.{name} = {item[name]!r}: allowed is a name")
        rows = _one_of(f"{key}.rows", item.get("rows", "all"), ROWS)
        take = _one_of(f"{key}.take", item.get("take", "each"), [*TAKES, SLOPE])
        if (take == SLOPE) != ("by" in item):
            raise ClaimError(f"{key}.by: needed with take: {SLOPE}, and allowed with it only")
        where = item.get("where", {})
        if not isinstance(where, dict):
            raise ClaimError(f"{key}.where = {where!r}: allowed are columns and values")
        for scene in _list(item.get("scenes", "")):
            names = {name: _filled(item[name], scene) for name in _NAMES if name in item}
            conditions = tuple((column, _filled(value, scene)) for column, value in where.items())
            yield Evidence(**names, where=conditions, rows=rows, take=take)


def _filled(value: Any, scene: str) -> Any:
    return value.replace("{scene}", scene) if isinstance(value, str) else value


def _list(value: Any) -> list[Any]:
    """A list as it is, anything else as the only item of one."""
    return value if isinstance(value, list) else [value]


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and bool(np.isfinite(value))


def _one_of(key: str, value: Any, allowed: Collection[str]) -> str:
    if value not in allowed:
        raise ClaimError(f"{key} = {value!r}: allowed are {', '.join(allowed)}")
    return str(value)


def _check_keys(entry: Mapping[str, Any], allowed: Collection[str], needed: Collection[str]) -> None:
    for key in entry:
        if key not in allowed:
            raise ClaimError(f"{key!r} is an unknown key: allowed are {', '.join(allowed)}")
    for key in needed:
        if key not in entry:
            raise ClaimError(f"{key} is missing")
