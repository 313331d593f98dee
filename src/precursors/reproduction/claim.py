"""What a claim is: a statement of the paper, and the function that compares it with the tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from precursors.model.chain import FloatArray
from precursors.reproduction.tables import Tables, one

REPRODUCED, FRAGILE, NOT_REPRODUCED = "reproduced", "reproduced but fragile", "not reproduced"
AS_DESCRIBED = "as described"
FOLLOWS = "follows from the equations"
MISPRINT, MATTERS, NO_MATTER = "misprint", "changes a number", "changes no number"
NOT_COMPUTED = "not computed here"
VERDICTS = (
    REPRODUCED,
    FRAGILE,
    NOT_REPRODUCED,
    AS_DESCRIBED,
    FOLLOWS,
    MISPRINT,
    MATTERS,
    NO_MATTER,
    NOT_COMPUTED,
)


@dataclass(frozen=True)
class Kind:
    """A kind of claim: what it means, and the verdict where the comparison holds and where it does not."""

    meaning: str
    holds: str = REPRODUCED
    fails: str = NOT_REPRODUCED


KINDS = {
    "input": Kind("the chain computed here is the one described", holds=AS_DESCRIBED),
    "result": Kind("what the model gives, and could have given otherwise"),
    FOLLOWS: Kind("true by algebra for any such chain; no run could contradict it", holds=FOLLOWS),
    "reading": Kind("how a number is printed, or what another reading gives"),
    "experiment": Kind("what is said of the experiment, or of model and experiment together"),
    "misprint": Kind("other words must stand there", holds=NO_MATTER, fails=MISPRINT),
    "open point": Kind("the paper does not say what is meant", holds=NO_MATTER, fails=MATTERS),
}


@dataclass(frozen=True)
class Finding:
    """Our values, whether they agree (None: nothing to compare), by which rule, and the paper's values."""

    ours: FloatArray
    holds: bool | None
    rule: str
    paper: FloatArray


@dataclass(frozen=True)
class Claim:
    """A statement of the paper.

    Attributes
    ----------
    id, where, statement : str
        Name; place in the paper; the statement in our words.
    kind : str
        A key of KINDS.
    unit : str
        Unit of the values.
    find : callable
        Compares the statement with the tables.
    fragile : tuple of (scene, quantity)
        Rows of digits.csv: where one of them is of class fragile, so is the claim.
    """

    id: str
    where: str
    statement: str
    kind: str
    unit: str
    find: Callable[[Tables], Finding]
    fragile: tuple[tuple[str, str], ...]

    def verdict(self, finding: Finding, tables: Tables) -> str:
        """What the finding makes of the claim."""
        if finding.holds is None:
            return NOT_COMPUTED
        kind = KINDS[self.kind]
        if not finding.holds:
            return kind.fails
        classes = [
            one(tables["digits"], "class", scene=s, quantity=q, question="as in the run")
            for s, q in self.fragile
        ]
        return FRAGILE if "fragile" in classes else kind.holds


def claim(
    where: str, kind: str = "result", unit: str = "1", fragile: Iterable[tuple[str, str]] = ()
) -> Callable[[Callable[[Tables], Finding]], Claim]:
    """Make a claim of a function: its name is the claim's, its docstring the statement."""

    def make(find: Callable[[Tables], Finding]) -> Claim:
        return Claim(
            id=find.__name__.replace("_", "-"),
            where=where,
            statement=" ".join((find.__doc__ or "").split()),
            kind=kind,
            unit=unit,
            find=find,
            fragile=tuple(fragile),
        )

    return make


# Rules: each compares our values, one or several, with one value or as many. NaN never agrees.


def equal(
    ours: ArrayLike, paper: ArrayLike = (), to: ArrayLike = (), within: float = 0.0, relative: float = 0.0
) -> Finding:
    """Ours equal what the paper prints, or other values of ours (`to`)."""
    x, expected = _values(ours), _values(paper if np.size(paper) else to)
    rule = " ".join(["equal", shown(to)]).strip()
    rule += f", within {within:g}" if within else ""
    rule += f", within {relative:g} of it" if relative else ""
    return _finding(x, np.abs(x - expected) <= within + relative * np.abs(expected), rule, paper)


def rounds_to(ours: ArrayLike, paper: ArrayLike, digits: int) -> Finding:
    """Ours round to what the paper prints with so many digits after the point."""
    x, printed, half = _values(ours), _values(paper), 0.5 * 10.0**-digits
    agree = (x >= printed - half) & (x < printed + half)
    return _finding(x, agree, f"rounds to {digits} digits", paper)


def above(ours: ArrayLike, limit: ArrayLike) -> Finding:
    """Ours are larger than the limit."""
    return _finding(ours, np.greater(ours, limit), f"above {shown(limit)}")


def at_least(ours: ArrayLike, limit: ArrayLike) -> Finding:
    """Ours are not smaller than the limit."""
    return _finding(ours, np.greater_equal(ours, limit), f"at least {shown(limit)}")


def below(ours: ArrayLike, limit: ArrayLike) -> Finding:
    """Ours are smaller than the limit."""
    return _finding(ours, np.less(ours, limit), f"below {shown(limit)}")


def at_most(ours: ArrayLike, limit: ArrayLike) -> Finding:
    """Ours are not larger than the limit."""
    return _finding(ours, np.less_equal(ours, limit), f"at most {shown(limit)}")


def increasing(ours: ArrayLike) -> Finding:
    """Each of ours is larger than the one before it."""
    return _finding(ours, np.diff(_values(ours)) > 0, "increasing")


def decreasing(ours: ArrayLike) -> Finding:
    """Each of ours is smaller than the one before it."""
    return _finding(ours, np.diff(_values(ours)) < 0, "decreasing")


def same(ours: ArrayLike, within: float) -> Finding:
    """Ours differ by no more than this."""
    return _finding(ours, np.ptp(_values(ours)) <= within, f"same, within {within:g}")


def instead_of(printed: ArrayLike, ours: ArrayLike) -> Finding:
    """What is meant or taken is what the paper's words give; with no number there, nothing can differ."""
    if not np.size(printed):
        return Finding(_values(ours), True, "no number is printed", _values(printed))
    return _finding(ours, np.isclose(ours, printed, rtol=1e-9), "as printed", printed)


def not_computed(paper: ArrayLike = ()) -> Finding:
    """The model does not have the quantity."""
    return Finding(_values(()), None, "none", _values(paper))


NO_EVENT = Finding(np.array([]), False, "no such event", np.array([]))


def shown(values: ArrayLike, most: int = 6) -> str:
    """Write values with four digits: equal ones once, and more than `most` by their number and range."""
    found = _values(values)
    texts = ["none" if np.isnan(value) else f"{value:.4g}" for value in found]
    if len(set(texts)) <= 1:
        return f"{len(found)} values of {texts[0]}" if len(found) > most else "".join(texts[:1])
    if len(found) > most:
        return f"{len(found)} values from {found.min():.4g} to {found.max():.4g}"
    return "; ".join(texts)


def _finding(ours: ArrayLike, agree: ArrayLike, rule: str, paper: ArrayLike = ()) -> Finding:
    return Finding(_values(ours), bool(np.size(agree) and np.all(agree)), rule, _values(paper))


def _values(values: ArrayLike) -> FloatArray:
    return np.atleast_1d(np.asarray(values, dtype=np.float64))
