"""Runs that are wrong on purpose: what the auditor sees of them, kind by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
import random_chains
from accuracy.falsified import changed, with_chain, without
from chains import first_transitions
from numpy.random import Generator

from precursors import Run
from precursors.accuracy.audit import audit

# Of an interval, and of mu_k.
WRONG = 1e-6


def shifted(run: Run, rng: Generator) -> Run | None:
    """One transition later by a millionth of the interval before it."""
    late = np.flatnonzero(run.intervals[:-1] > 0)
    if not late.size:
        return None
    k = int(rng.choice(late))
    intervals, transitions = run.intervals.copy(), run.transitions.copy()
    shift = WRONG * intervals[k]
    intervals[k] += shift
    moved = 0.0
    if intervals[k + 1] > shift:
        intervals[k + 1] -= shift
        transitions["time"][k] += shift
    else:
        transitions["time"][k:] += shift
        moved = shift
    return replace(run, intervals=intervals, transitions=transitions, duration=run.duration + moved)


def dropped(run: Run, rng: Generator) -> Run | None:
    """One transition left out: its interval joins the next."""
    if not len(run.transitions):
        return None
    return without(run, int(rng.integers(len(run.transitions))))


def swapped(run: Run, rng: Generator) -> Run | None:
    """Two successive transitions in the other order, at the instants and loads that were there."""
    block, chain = run.transitions["block"], run.chain
    # Two that come nearly together may come in either order.
    soon = WRONG * np.sqrt(chain.mass / max(chain.stiffness, chain.drive_stiffness))
    apart = np.flatnonzero((run.intervals[1:-1] > soon) & (block[1:] != block[:-1]))
    if not apart.size:
        return None
    k, transitions = int(rng.choice(apart)), run.transitions.copy()
    for name in ("block", "mode"):
        transitions[name][[k, k + 1]] = run.transitions[name][[k + 1, k]]
    return replace(run, transitions=transitions)


def turned(run: Run, rng: Generator) -> Run | None:
    """One transition to another mode."""
    if not len(run.transitions):
        return None
    k = int(rng.integers(len(run.transitions)))
    others = [mode for mode in (-1, 0, 1) if mode != run.transitions["mode"][k]]
    return changed(run, k, mode=rng.choice(others))


def lighter(run: Run, rng: Generator) -> Run | None:
    """The run of a chain with more kinetic friction, taken for one with a millionth less.

    Where no block that has weight moves and stops, friction leaves no trace in the transitions.
    """
    blocks = run.transitions["block"].tolist()
    stopped = {block for k, block in enumerate(blocks) if block in blocks[:k]}
    if not (run.chain.mu_k > 0 and any(run.chain.weights[block - 1] > 0 for block in stopped)):
        return None
    return with_chain(run, "mu_k", 1 - WRONG)


WAYS: dict[str, Callable[[Run, Generator], Run | None]] = {
    "shifted": shifted,
    "dropped": dropped,
    "swapped": swapped,
    "turned": turned,
    "mu_k": lighter,
}


def seen(number: int, way: str) -> bool | None:
    """Whether the auditor sees that the run of a trial was spoiled; None where there is nothing to spoil."""
    _, case = random_chains.trial(number)
    run = first_transitions(case.chain, case.most, duration=case.duration, **case.start)
    wrong = WAYS[way](run, np.random.default_rng([random_chains.SEED, number, list(WAYS).index(way)]))
    return None if wrong is None else not audit(wrong).ok


def shares(numbers: Iterable[int]) -> dict[tuple[str, str], tuple[int, int]]:
    """Runs that were seen to be wrong, and runs that were spoiled, by kind and way."""
    counts: Counter[tuple[str, str, bool]] = Counter()
    for number in numbers:
        for way in WAYS:
            try:
                answer = seen(number, way)
            except ValueError:
                break
            if answer is not None:
                counts[random_chains.trial_kind(number), way, answer] += 1
    pairs = sorted({(kind, way) for kind, way, _ in counts})
    return {pair: (counts[*pair, True], counts[*pair, True] + counts[*pair, False]) for pair in pairs}
