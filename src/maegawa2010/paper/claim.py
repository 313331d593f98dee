"""A claim is a statement of the paper and a function that decides whether the model
agrees."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from maegawa2010.paper.tables import Tables
from maegawa2010.support.run_statistics import share_interval

# Verdicts. EXACT: the claim holds in the run with exactly the paper's inputs, but in too
# few members of an ensemble around it.
HOLDS = "holds"
EXACT = "exact"
FAILS = "fails"
UNDECIDED = "undecided"
WORDS = {
    HOLDS: "holds",
    EXACT: "not robust",
    FAILS: "does not hold",
    UNDECIDED: "cannot be decided",
}
# Kinds: the six printed numbers that we used to choose between readings of the paper's
# words; all other claims on the model; and claims on the experiment with PMMA.
READINGS = "readings"
RESULT = "result"
EXPERIMENT = "experiment"
# Verdicts in words, for claims of each kind.
IN_WORDS = {
    READINGS: WORDS,
    RESULT: WORDS,
    EXPERIMENT: WORDS | {HOLDS: "agrees", FAILS: "differs"},
}
# A robust claim also holds in at least this share of each ensemble.
ENOUGH = 0.95
# Tables of the ensembles around the run: 0.1 % of noise in the normal loads, and sliders
# with the same printed inputs. Member 0 (column draw) is the run itself.
ENSEMBLES = {"noise": "noise_members", "digits": "digits_members"}


class Share(NamedTuple):
    """A claim holds in k of the n members of an ensemble."""

    k: int
    n: int


@dataclass(frozen=True)
class Finding:
    """Our numbers, and whether the claim holds for them.

    `holds` is None if the numbers do not decide, for example because an interval crosses
    the tolerance. `shares` says in how many members of each ensemble the claim holds.
    `note` is a sentence about the numbers.
    """

    ours: ArrayLike
    holds: bool | None
    shares: Mapping[str, Share] = field(default_factory=dict)
    note: str = ""

    @property
    def verdict(self) -> str:
        """HOLDS, EXACT, FAILS or UNDECIDED: the run decides whether the claim holds, and
        the ensembles whether it holds for these inputs only."""
        if self.holds is None:
            return UNDECIDED
        if not self.holds:
            return FAILS
        intervals = [share_interval(*share) for share in self.shares.values()]
        if any(high < ENOUGH for _, high in intervals):
            return EXACT
        return UNDECIDED if any(low < ENOUGH for low, _ in intervals) else HOLDS


Find = Callable[[Tables], Finding]


def judged(claim: Mapping[Any, str], find: Find, tables: Tables) -> dict[str, Any]:
    """Evaluate a claim: its row of the table of claims.

    A run contradicts the claim if it lacks the events that the claim is about.

    `claim` is a row of claims.csv: its name; section of the paper; kind; statement; rule
    by which the statement holds; unit of the numbers; and `of`, which says what each of
    several numbers refers to.

    Raises
    ------
    ValueError
        In one line: the tables do not have the claim's numbers.
    """
    try:
        finding = find(tables)
    except (IndexError, ZeroDivisionError):
        finding = Finding((), False)
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"claim {claim['claim']}: the tables do not have its numbers: {error}"
        ) from error
    shares = {f"{name}_share": part.k / part.n for name, part in finding.shares.items()}
    words = IN_WORDS[claim["kind"]][finding.verdict]
    if finding.verdict == EXACT:
        words += f" ({100 * min(shares.values()):.0f} %)"
    return {
        **claim,
        "ours": shown(finding.ours),
        **shares,
        "note": finding.note,
        "verdict": finding.verdict,
        "verdict_text": words,
    }


def in_ensembles(
    tables: Tables,
    ours: Callable[[pd.DataFrame], Any],
    holds: Callable[[pd.DataFrame], Any],
) -> Finding:
    """Evaluate a claim in the run and in all members of both ensembles.

    `ours` computes the numbers of the claim, one row per member, from a table of runs
    with one row per member and (quantity, scene) as columns. `holds` says of each number
    whether it agrees. NaN (no global slip) does not agree.
    """
    shares = {}
    for name, members in ENSEMBLES.items():
        runs = tables[members].pivot_table(index="draw", columns="scene", dropna=False)
        numbers = ours(runs)
        agree = holds(numbers).all(axis=1)
        others = agree[agree.index > 0]
        shares[name] = Share(int(others.sum()), len(others))
    return Finding(numbers.loc[0], bool(agree.loc[0]), shares)


def shown(values: ArrayLike) -> str:
    """Write numbers with four digits; if all are equal, once."""
    texts = [f"{value:.4g}" for value in np.ravel(values)]
    return "; ".join(texts if len(set(texts)) > 1 else texts[:1])
