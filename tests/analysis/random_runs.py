"""Runs at random, for tests of what is made of a run."""

from dataclasses import replace

import numpy as np

from precursors import Chain, Record


def random_chain(rng: np.random.Generator) -> Chain:
    chain = Chain.from_slider(
        n_blocks=int(rng.integers(1, 13)),
        theta=rng.uniform(-1, 1),
        mu_k=rng.uniform(0.2, 0.65),
        drive_stiffness=10 ** rng.uniform(4.5, 7.5),
    )
    return replace(chain, weights=chain.weights * rng.uniform(0.5, 1.5, chain.n_blocks))


def random_transitions(rng: np.random.Generator) -> Record:
    """A list of transitions that obeys no mechanics: rests without duration, turns, an
    unfinished event."""
    n_blocks = int(rng.integers(1, 5))
    n = int(rng.integers(1, 40))
    intervals = rng.uniform(0.1, 1.0, n + 1) * (rng.random(n + 1) < 0.7)
    mode = np.zeros(n_blocks + 1, int)
    rows = []
    for time in np.cumsum(intervals[:-1]):
        block = int(rng.integers(1, n_blocks + 1))
        mode[block] = rng.choice([m for m in (-1, 0, 1) if m != mode[block]])
        rows.append((time, block, mode[block], rng.uniform(0, 300)))
    chain = Chain.from_slider(n_blocks)
    return Record.from_columns(
        chain, intervals.sum(), *zip(*rows, strict=True), intervals
    )
