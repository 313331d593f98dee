"""Hostile physics: random chains far from the paper's, each run checked by the auditor."""

from __future__ import annotations

import math
import multiprocessing
import os
import re
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any

import numpy as np
from chains import first_transitions, positions_under
from numpy.random import Generator

from faults.outcome import Outcome
from precursors import Chain
from precursors.accuracy.audit import Tolerances, audit

SEED = 1961
CHAINS = 20_000
CHUNK = 50
# What the solver counts as zero, 8 eps, as roundings of 2^-53 that a step may add: deviations come to 12.
ROUNDINGS = 16.0
# Of the work of the drive, the friction heat and the energy at the start: rounding adds up to 3e-13.
ENERGY = 2e-12
TOLERANCES = Tolerances(energy=ENERGY, roundings=ROUNDINGS)
# A trial takes milliseconds, and up to a second of the auditor; one that takes longer [s] hangs.
PATIENCE = 60.0


@dataclass(frozen=True)
class Trial:
    """A chain, its start and how far it is run."""

    chain: Chain
    duration: float
    start: dict[str, np.ndarray]
    most: int


def decades(rng: Generator, low: float, high: float) -> float:
    return float(10.0 ** rng.uniform(low, high))


def any_chain(rng: Generator) -> Trial:
    """All parameters over many decades, in any units; weights with zeros; prestressed and moving starts."""
    n = int(rng.integers(1, 61))
    force, stiffness, mass = decades(rng, -9, 9), decades(rng, -6, 12), decades(rng, -12, 6)
    spread = rng.choice([0.0, 1.0, 3.0])
    weights = force * 10.0 ** rng.uniform(-spread, spread, n)
    if rng.random() < 0.4:
        weights[rng.random(n) < rng.choice([0.1, 0.5, 0.9])] = 0.0
    weights[rng.integers(n)] = force
    mu_s = float(rng.choice([0.7, 0.0, rng.uniform(0.05, 1.5), decades(rng, -6, 2)], p=[0.5, 0.1, 0.3, 0.1]))
    mu_k = mu_s * float(rng.choice([1.0, 0.0, rng.uniform()], p=[0.15, 0.15, 0.7]))
    ratio = decades(rng, -6, 6) if rng.random() < 0.7 else 1.0
    stiffest = stiffness * max(1.0, ratio)
    duration = decades(rng, 0.5, 3.0) / (2 * math.sqrt(stiffest / mass))
    loading = decades(rng, -3, 1) * max(mu_s, 0.1) * float(weights.sum()) / duration
    chain = Chain(weights, mass, stiffness, stiffness * ratio, loading / (stiffness * ratio), mu_s, mu_k)
    return Trial(chain, duration, any_start(rng, chain, stiffest), 60)


def any_start(rng: Generator, chain: Chain, stiffest: float) -> dict[str, np.ndarray]:
    """Now and then springs that push with up to 1.5 times the friction, or blocks that move."""
    start: dict[str, np.ndarray] = {}
    friction = max(chain.mu_s, 0.1)
    if rng.random() < 0.4:
        pushes = rng.integers(-24, 25, chain.n_blocks) / 16 * chain.weights * friction
        start["start_positions"] = positions_under(chain, pushes)
    if rng.random() < 0.4:
        impacts = rng.integers(-24, 25, chain.n_blocks) / 16 * chain.weights.max() * friction
        start["start_velocities"] = impacts / math.sqrt(stiffest * chain.mass)
    return start


def any_slider(rng: Generator) -> Trial:
    """The paper's slider with other loading, length and drive, until some hundred transitions are made."""
    chain = Chain.from_slider(
        n_blocks=int(rng.integers(1, 61)),
        theta=float(rng.choice([-1.0, -5 / 6, 0.0, 5 / 6, 1.0, rng.uniform(-1, 1)])),
        mu_k=float(rng.choice([0.45, 0.7, 0.0, rng.uniform(0, 0.7)])),
        drive_stiffness=decades(rng, 3, 9),
        drive_velocity=decades(rng, -8, 1),
    )
    return Trial(chain, 5 * chain.normal_load / chain.loading_rate, {}, 120)


def even_chain(rng: Generator) -> Trial:
    """Small whole numbers everywhere: blocks meet their limits at the same instant, or touch them."""
    n = int(rng.integers(1, 13))
    weights = rng.integers(0, 4, n).astype(float)
    weights[rng.integers(n)] = 2.0
    mu_s = float(rng.choice([1.0, 0.5, 0.0]))
    stiffness, drive_stiffness, mass = (float(x) for x in rng.choice([1.0, 2.0, 4.0], 3))
    velocity = float(rng.choice([1.0, 0.125, 1e-3, 1e-9]))
    chain = Chain(
        weights, mass, stiffness, drive_stiffness, velocity, mu_s, mu_s * float(rng.choice([0.0, 0.5, 1.0]))
    )
    start: dict[str, np.ndarray] = {}
    if rng.random() < 0.6:
        start["start_positions"] = positions_under(chain, rng.integers(-2, 3, n) * mu_s * weights / 2)
    if rng.random() < 0.6:
        start["start_velocities"] = rng.integers(-1, 2, n).astype(float)
    return Trial(chain, float(rng.choice([1.0, 30.0, 300.0])), start, 80)


def absurd_chain(rng: Generator) -> Trial:
    """Any doubles at all: nothing that exists, but nothing that may hang or lie either."""
    n = int(rng.integers(1, 9))
    size = float(rng.choice([15.0, 50.0, 300.0]))
    mass, stiffness, drive_stiffness, velocity = (decades(rng, -size, size) for _ in range(4))
    chain = Chain(10.0 ** rng.uniform(-size, size, n), mass, stiffness, drive_stiffness, velocity, 0.7, 0.45)
    longest = 300 * math.sqrt(mass / max(stiffness, drive_stiffness))
    return Trial(chain, min(decades(rng, -size, size), longest), {}, 80)


KINDS: dict[str, tuple[float, Callable[[Generator], Trial]]] = {
    "any chain": (0.7, any_chain),
    "slider": (0.1, any_slider),
    "whole numbers": (0.15, even_chain),
    "absurd": (0.05, absurd_chain),
}


def trial_kind(number: int) -> str:
    """The kind of the trial with a number."""
    return str(
        np.random.default_rng([SEED, number]).choice(list(KINDS), p=[share for share, _ in KINDS.values()])
    )


def trial(number: int) -> tuple[str, Trial]:
    """The trial with a number: always the same."""
    rng = np.random.default_rng([SEED, number])
    kind = str(rng.choice(list(KINDS), p=[share for share, _ in KINDS.values()]))
    return kind, KINDS[kind][1](rng)


def verdict(case: Trial) -> str:
    """Run a chain and audit it: "survived", "refused", or what is wrong."""
    try:
        run = first_transitions(case.chain, case.most, duration=case.duration, **case.start)
    except ValueError as error:
        return (
            "refused" if str(error) and "\n" not in str(error) else f"refused without a sentence: {error!r}"
        )
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    transitions = run.transitions
    if not (np.isfinite(transitions["time"]).all() and np.isfinite(transitions["tangential_load"]).all()):
        return "a transition is not finite"
    if not (run.duration == case.duration or len(transitions) >= case.most):
        return f"ended at {run.duration} s of {case.duration} s after {len(transitions)} transitions"
    positions, velocities = run.at([0.0, run.duration])
    if not (np.isfinite(positions).all() and np.isfinite(velocities).all()):
        return "the state at the end is not finite"
    try:
        report = audit(run, TOLERANCES)
    except ArithmeticError as error:
        return f"cannot be audited: {type(error).__name__}: {error}"
    if report.ok:
        return "survived"
    return f"{len(report.problems)} problems after {report.n_intervals} intervals: {report.problems[0]}"


def judged(number: int) -> tuple[str, str]:
    """Kind and verdict of the trial with a number; a chain may be refused before it is run."""
    kind = trial_kind(number)
    try:
        _, case = trial(number)
    except ValueError as error:
        return kind, "refused" if str(error) else "refused without a sentence"
    return kind, verdict(case)


def work(numbers: Connection) -> None:
    """Take numbers of trials until there are no more, and answer each with its verdict."""
    np.seterr(all="ignore")
    while True:
        number = numbers.recv()
        if number is None:
            return
        begin = time.perf_counter()
        numbers.send((number, *judged(number), time.perf_counter() - begin))


@dataclass
class Worker:
    """A process that answers, what it works on, and since when."""

    process: Any
    connection: Connection
    number: int
    since: float


def verdicts(numbers: Iterator[int], processes: int) -> Iterator[tuple[int, str, str, float]]:
    """Number, kind, verdict and time [s] of each trial; one that hangs, or ends its process, is lost."""
    # One thread each: the matrices are small, and both processes need their core.
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    context = multiprocessing.get_context("spawn")
    workers: list[Worker] = []

    def employ() -> None:
        number = next(numbers, None)
        if number is None:
            return
        mine, its = context.Pipe()
        process = context.Process(target=work, args=(its,), daemon=True)
        process.start()
        its.close()
        mine.send(number)
        workers.append(Worker(process, mine, number, time.monotonic()))

    for _ in range(processes):
        employ()
    while workers:
        ready = wait([worker.connection for worker in workers], timeout=1.0)
        for worker in list(workers):
            if worker.connection in ready:
                try:
                    answer = worker.connection.recv()
                except EOFError:
                    yield worker.number, "", "the interpreter crashed", 0.0
                    workers.remove(worker)
                    employ()
                    continue
                yield answer
                number = next(numbers, None)
                worker.connection.send(number)
                worker.number, worker.since = number if number is not None else -1, time.monotonic()
                if number is None:
                    worker.process.join()
                    workers.remove(worker)
            elif time.monotonic() - worker.since > PATIENCE:
                worker.process.kill()
                yield worker.number, "", f"hangs: no end after {PATIENCE:g} s", PATIENCE
                workers.remove(worker)
                employ()


def try_all(share: float = 1.0, processes: int = 2, first: int = 0) -> list[Outcome]:
    """Try a share of the chains; one row for each kind of them."""
    outcomes = {kind: Outcome(f"chain: {kind}") for kind in KINDS}
    judged(0)  # compiled here, once
    for number, kind, answer, _ in verdicts(iter(range(first, first + round(CHAINS * share))), processes):
        kind = kind or trial_kind(number)
        lost = answer not in ("survived", "refused")
        outcomes[kind].count(f"physics.trial({number}), {kind}: {answer}" if lost else answer)
    return list(outcomes.values())


def reason(number: int) -> str:
    """Why the trial with a number is refused, without the numbers in it."""
    try:
        _, case = trial(number)
        first_transitions(case.chain, case.most, duration=case.duration, **case.start)
    except ValueError as error:
        return re.sub(r"-?\d[\d.]*(e[+-]?\d+)?", "#", str(error))
    return ""


def main(first: int, last: int, processes: int = 2) -> None:
    """Print every chain that is lost, as it is found, then counts, refusals, times and the slowest."""
    counts: Counter[tuple[str, str]] = Counter()
    refusals: Counter[str] = Counter()
    seconds_of = dict.fromkeys(KINDS, 0.0)
    slowest: list[tuple[float, int]] = []
    begin = time.monotonic()
    for number, kind, answer, seconds in verdicts(iter(range(first, last)), processes):
        kind = kind or trial_kind(number)
        good = answer in ("survived", "refused")
        counts[kind, answer if good else "lost"] += 1
        seconds_of[kind] += seconds
        slowest = sorted([*slowest, (seconds, number)])[-10:]
        if answer == "refused":
            refusals[reason(number)] += 1
        if not good:
            print(f"trial({number}) {kind}: {answer[:300]}", flush=True)
    print(f"{last - first} trials in {time.monotonic() - begin:.0f} s on {processes} processes")
    for kind in KINDS:
        ends = ", ".join(f"{counts[kind, end]} {end}" for end in ("survived", "refused", "lost"))
        print(f"{kind}: {ends}, {seconds_of[kind]:.0f} s")
    for why, times in refusals.most_common():
        print(f"refused {times} times: {why}")
    print("slowest:", ", ".join(f"trial({number}) {seconds:.2f} s" for seconds, number in reversed(slowest)))
