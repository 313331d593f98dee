"""The worst of many random chains, with their transitions proved: `python -m
reference.worst_cases`.

Run in tests/ it writes golden/worst_cases.jsonl again, in about a minute of processor
time. Every case is drawn as `random_chains.mild_chain`, and then altered as its kind
says. Of each kind those chains are kept in which two transitions of different blocks
come closest to each other, in units of 1/omega, the bound of the largest frequency.
Chains in which a velocity grazes zero come in pairs: the drive of one is faster by
1e-9, and the block stops in one of them only.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import asdict, replace
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.random import Generator
from random_chains import Trial, mild_chain

from precursors import Run, certify
from precursors.proof import CertificateError

from .chain_reference import ReferenceChain, reference

FILE = Path(__file__).parent.parent / "golden/worst_cases.jsonl"
PAIRS, GRAZES = 10, 1e-9
# A run is cut off in the last interval that is longer than this [1/omega].
CLEAR = 0.01
# Transitions that every run has; of two chains the orders differ at any one of them.
SHORTEST, SHORTEST_OF_PAIRS = 12, 30
# More bits do not tell instants apart that are equal.
MAX_BITS = 1024


def at_the_limit(rng: Generator) -> Trial:
    """Numbers without rounding; half of the blocks start exactly at their static
    limit."""
    case = mild_chain(rng)
    n = case.chain.n_blocks
    weights = rng.integers(1, 64, n).astype(float)
    chain = replace(
        case.chain,
        weights=weights,
        mass=2.0**-10,
        stiffness=2.0**24,
        drive_stiffness=2.0 ** rng.integers(16, 27),
        mu_s=0.5,
        mu_k=0.25,
    )
    pushes = chain.strength * np.where(
        rng.random(n) < 0.5, rng.choice([-1, 1], n), rng.integers(-7, 8, n) / 8
    )
    forces = np.cumsum(pushes[::-1])[::-1]
    return replace(
        case, chain=chain, start={"start_positions": -np.cumsum(forces / chain.springs)}
    )


def equal_frictions(rng: Generator) -> Trial:
    case = mild_chain(rng)
    return replace(case, chain=replace(case.chain, mu_k=case.chain.mu_s))


def zero_loads(rng: Generator) -> Trial:
    case = mild_chain(rng)
    keep = rng.random(case.chain.n_blocks) < 0.6
    keep[rng.integers(keep.size)] = True
    return replace(case, chain=replace(case.chain, weights=case.chain.weights * keep))


def equal_loads(rng: Generator) -> Trial:
    case = mild_chain(rng)
    return replace(
        case, chain=replace(case.chain, weights=np.full(case.chain.n_blocks, 40.0))
    )


# How each kind is drawn, how many are drawn and how many are kept.
KINDS: dict[str, tuple[Callable[[Generator], Trial], int, int]] = {
    "any loads": (mild_chain, 100_000, 100),
    "at the limit": (at_the_limit, 5_000, 20),
    "mu_k = mu_s": (equal_frictions, 5_000, 20),
    "zero loads": (zero_loads, 5_000, 20),
    "equal loads": (equal_loads, 5_000, 20),
}


def gaps_of(run: Run) -> np.ndarray:
    """Times from transition to transition [1/omega]; infinite in a tie, and where a
    block changes twice."""
    gaps = run.intervals[1 : len(run.transitions)] * run.chain.fastest_frequency_bound
    return np.where((gaps > 0) & (np.diff(run.transitions["block"]) != 0), gaps, np.inf)


def closest(kind: str) -> list[Trial]:
    """The chains of a kind with the smallest gaps."""
    draw, n_drawn, n_kept = KINDS[kind]
    runs = (draw(np.random.default_rng(number)).run() for number in range(n_drawn))
    gaps = [gaps_of(run).min(initial=np.inf) for run in runs]
    return [
        draw(np.random.default_rng(int(number))) for number in np.argsort(gaps)[:n_kept]
    ]


def grazing() -> Iterator[Trial]:
    """Pairs of chains whose drives differ by `GRAZES`, and in one of which a block does
    not stop."""
    pairs = number = 0
    while pairs < PAIRS:
        case = mild_chain(np.random.default_rng(number))
        number += 1
        slower, faster = 1.0, 1.01
        if order(case, slower) == order(case, faster):
            continue
        while faster - slower > GRAZES:
            middle = (slower + faster) / 2
            if order(case, middle) == order(case, slower):
                slower = middle
            else:
                faster = middle
        if grazes(order(case, slower), order(case, faster)):
            pairs += 1
            yield driven(case, slower)
            yield driven(case, faster)


def driven(case: Trial, times: float) -> Trial:
    return replace(
        case,
        chain=replace(case.chain, drive_velocity=times * case.chain.drive_velocity),
    )


def order(case: Trial, times: float) -> list[tuple[int, int]]:
    return driven(case, times).run().transitions[["block", "mode"]].tolist()


def grazes(one: list[tuple[int, int]], other: list[tuple[int, int]]) -> bool:
    """Whether the orders first differ in a stop that one lacks, and not in two
    transitions swapped."""
    k = next(k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b)
    return (one[k][1] == 0 or other[k][1] == 0) and sorted(one[k : k + 2]) != sorted(
        other[k : k + 2]
    )


def cut(case: Trial, at_least: int) -> Trial:
    """End the run after so many transitions and the closest two, where no transition is
    near."""
    run = replace(case, most=2 * case.most).run()
    gaps = gaps_of(run)[: case.most - 1]
    last = max(at_least, int(np.argmin(gaps)) + 3 if gaps.size else 0)
    long = np.flatnonzero(
        run.intervals[:-1] * run.chain.fastest_frequency_bound > CLEAR
    )
    if not (long >= last).any():
        return replace(case, duration=run.duration)
    end = long[long >= last][0]
    return replace(
        case, duration=float(run.transitions["time"][end] - run.intervals[end] / 2)
    )


def truth(case: Trial) -> tuple[str, list[tuple[float, int, int]]]:
    """Time [s], block and mode of each transition: proved or, where there is a tie,
    from the reference."""
    start = {
        name: list(map(Fraction, values.tolist()))
        for name, values in case.start.items()
    }
    with suppress(CertificateError):
        proof = certify(case.chain, case.duration, max_bits=MAX_BITS, **start)
        if proof.tie is None:
            return "proof", [
                (float(t.time.midpoint), t.block, t.mode) for t in proof.transitions
            ]
    numbers = {
        name: value
        for name, value in asdict(case.chain).items()
        if name not in ("weights", "length")
    }
    exact = ReferenceChain(
        weights=tuple(map(Fraction, case.chain.weights.tolist())),
        **{name: Fraction(value) for name, value in numbers.items()},
    )
    return "reference", [
        (float(t.time), t.block, t.mode)
        for t in reference(exact, case.duration, **start)
    ]


def write() -> None:
    """Write the cases, a line each."""
    kinds = [(kind, case) for kind in KINDS for case in closest(kind)]
    kinds += [("grazing", case) for case in grazing()]
    with FILE.open("w") as file:
        for kind, case in kinds:
            case = cut(case, SHORTEST_OF_PAIRS if kind == "grazing" else SHORTEST)
            source, transitions = truth(case)
            row = {
                "kind": kind,
                "gap": float(f"{gaps_of(case.run()).min(initial=np.inf):.3g}"),
                "source": source,
                "chain": asdict(case.chain) | {"weights": case.chain.weights.tolist()},
                "duration": case.duration,
                "start": {name: values.tolist() for name, values in case.start.items()},
                "transitions": transitions,
            }
            print(json.dumps(row), file=file)


def read() -> list[dict]:
    """The cases, as they were written."""
    return [json.loads(line) for line in FILE.read_text().splitlines()]


if __name__ == "__main__":
    write()
