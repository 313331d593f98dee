"""A claim: a statement of the paper, and the function that finds whether the model
agrees."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from maegawa2010.paper.tables import Tables
from maegawa2010.support.run_statistics import share_interval

# Verdicts: EXACT is a claim that holds in the run, but in too few draws around it.
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
# Kinds: the six printed numbers by which the readings of the paper's words were chosen;
# what was found after; and statements on PMMA, which say nothing of the model.
READINGS = "readings"
RESULT = "result"
EXPERIMENT = "experiment"
# The verdicts on claims of each kind, in words.
IN_WORDS = {
    READINGS: WORDS,
    RESULT: WORDS,
    EXPERIMENT: WORDS | {HOLDS: "agrees", FAILS: "differs"},
}
# A claim that holds in the run must hold in this share of an ensemble, too.
ENOUGH = 0.95
# Ensembles around the run: noise of 0.1 % in the normal loads, and sliders with the same
# printed inputs. Draw 0 is the run itself.
ENSEMBLES = {"noise": "noise_members", "digits": "digits_members"}


class Share(NamedTuple):
    """In how many of n draws of an ensemble a claim holds."""

    k: int
    n: int


@dataclass(frozen=True)
class Finding:
    """Our numbers; whether the claim holds for them (None: an interval crosses the
    tolerance).

    `shares` has the share of each ensemble whose draws have these numbers, and `note`
    is a sentence that belongs to them.
    """

    ours: ArrayLike
    holds: bool | None
    shares: Mapping[str, Share] = field(default_factory=dict)
    note: str = ""

    @property
    def verdict(self) -> str:
        """The run decides whether a claim holds, the ensembles whether it does so for
        these inputs only."""
        if self.holds is None:
            return UNDECIDED
        if not self.holds:
            return FAILS
        intervals = [share_interval(*share) for share in self.shares.values()]
        if any(high < ENOUGH for _, high in intervals):
            return EXACT
        return UNDECIDED if any(low < ENOUGH for low, _ in intervals) else HOLDS


Find = Callable[[Tables], Finding]


def judged(said: Mapping[Any, str], find: Find, tables: Tables) -> dict[str, Any]:
    """A claim's row of claims.csv; a run without an event that a claim is about
    contradicts it.

    `said` is what is stated of it: the claim's name; the section in which the paper
    has it; its kind, one of those above; the statement; the rule, which says when it
    holds; the unit of its numbers; and `of`, what each of them is, if there are
    several.

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
            f"claim {said['claim']}: the tables do not have its numbers: {error}"
        ) from error
    shares = {f"{name}_share": part.k / part.n for name, part in finding.shares.items()}
    words = IN_WORDS[said["kind"]][finding.verdict]
    if finding.verdict == EXACT:
        words += f" ({100 * min(shares.values()):.0f} %)"
    return {
        **said,
        "ours": shown(finding.ours),
        **shares,
        "note": finding.note,
        "verdict": finding.verdict,
        "verdict_text": words,
    }


def in_draws(
    tables: Tables,
    ours: Callable[[pd.DataFrame], Any],
    holds: Callable[[pd.DataFrame], Any],
) -> Finding:
    """A claim on numbers of the members: found in the run, and counted over the draws
    of both ensembles.

    `ours` takes runs, one row per draw and (quantity, scene) as columns, to the numbers
    of the claim, one row per draw; `holds` says of each number whether it agrees, which
    NaN, no global slip, does not.
    """
    shares = {}
    for name, members in ENSEMBLES.items():
        runs = tables[members].pivot_table(index="draw", columns="scene", dropna=False)
        numbers = ours(runs)
        agree = holds(numbers).all(axis=1)
        drawn = agree[agree.index > 0]
        shares[name] = Share(int(drawn.sum()), len(drawn))
    return Finding(numbers.loc[0], bool(agree.loc[0]), shares)


def shown(values: ArrayLike) -> str:
    """Numbers with four digits, equal ones once."""
    texts = [f"{value:.4g}" for value in np.ravel(values)]
    return "; ".join(texts if len(set(texts)) > 1 else texts[:1])
