"""Runs that are wrong on purpose, one mistake each, and what the auditor says of
them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from precursors import Chain, Run, simulate

SLIDER = Chain.from_slider
# The mistake that has to be found: 1e-9 s is a ten-thousandth of the shortest slip.
SHIFT = 1e-9
# Positions that overload some blocks either way [m]
STRAINED = 1e-5 * np.sin(np.arange(10.0))


def without(run: Run, *removed: int) -> Run:
    """The run with some of its transitions left out: their intervals join the next
    one."""
    kept = np.delete(np.arange(len(run.transitions)), removed)
    instant = np.cumsum(run.intervals)
    intervals = np.diff(instant[np.append(kept, -1)], prepend=0.0)
    is_alone = np.diff(np.append(kept, len(run.transitions)), prepend=-1) == 1
    intervals = np.where(is_alone, np.delete(run.intervals, removed), intervals)
    return replace(run, transitions=run.transitions[kept], intervals=intervals)


def changed(run: Run, k: int, **values) -> Run:
    transitions = run.transitions.copy()
    for name, value in values.items():
        transitions[name][k] = value
    return replace(run, transitions=transitions)


def shifted(run: Run, k: int, seconds: float) -> Run:
    """The run with one transition, and its recorded time, moved."""
    run = changed(run, k, time=run.transitions["time"][k] + seconds)
    intervals = run.intervals.copy()
    intervals[k : k + 2] += seconds, -seconds
    return replace(run, intervals=intervals)


def next_of_block(run: Run, k: int) -> int:
    """Number of the next transition of the block of transition k."""
    block = run.transitions["block"]
    return k + 1 + int(np.argmax(block[k + 1 :] == block[k]))


def first_backward(run: Run, old: int) -> int:
    """Number of the first transition, after time 0, from an old mode to -1."""
    mode = np.zeros(run.chain.n_blocks + 1, int)
    for k, (time, block, new, _) in enumerate(run.transitions.tolist()):
        if time > 0 and mode[block] == old and new == -1:
            return k
        mode[block] = new
    raise LookupError("no block goes backward")


def falsified() -> Iterator[tuple[str, Run]]:
    """What the auditor says first of each wrong run."""
    # With uniform loads no block slides backward; with falling ones some do, and from a
    # strained start too.
    uniform = simulate(SLIDER(), until="global slip")
    stop, *_, stick = np.flatnonzero(uniform.transitions["mode"] == 0)[:5].tolist()
    yield "block 1 is stuck, pushed forward beyond mu_s w", shifted(uniform, 0, SHIFT)
    yield "block 1 slides against its mode +1", shifted(uniform, stop, SHIFT)
    for early in (0, stop, 160):
        yield (
            "N recorded as tangential load, wrong by",
            shifted(uniform, early, -SHIFT),
        )
    yield "slides against its mode +1", without(uniform, stick)
    yield (
        "slides against its mode +1",
        without(uniform, stick, next_of_block(uniform, stick)),
    )
    yield "block 1 releases to -1 below the limit", changed(uniform, 0, mode=-1)
    yield "block 2 turns round without a force", changed(uniform, stick, mode=-1)
    yield "mode +1, which it already has", changed(uniform, stick, mode=1)
    yield "wrong by nan N", changed(uniform, 100, tangential_load=np.nan)
    resting = int(np.flatnonzero(uniform.intervals > 1e-3)[-1])
    last_event = range(resting, len(uniform.transitions))
    yield "pushed forward beyond mu_s w", without(uniform, *last_event)
    cut = replace(
        uniform, transitions=uniform.transitions[:50], intervals=uniform.intervals[:51]
    )
    yield "the duration is recorded", cut
    less = replace(uniform.chain, mu_k=(1 - 1e-9) * uniform.chain.mu_k)
    yield "N recorded as tangential load, wrong by", replace(uniform, chain=less)

    falling = simulate(SLIDER(theta="-5/6"), until="global slip")
    turn = first_backward(falling, 1)
    yield (
        "block 10 sticks with a force beyond mu_s w",
        without(changed(falling, turn, mode=0), next_of_block(falling, turn)),
    )
    yield "block 10 slides against its mode +1", shifted(falling, turn, SHIFT)

    strained = simulate(SLIDER(), 1.0, start_positions=STRAINED)
    release = first_backward(strained, 0)
    yield (
        "slides against its mode -1",
        without(strained, release, next_of_block(strained, release)),
    )
    moving = simulate(SLIDER(), 0.1, start_velocities=np.r_[np.zeros(9), 0.1])
    yield "block 10 starts with 0.1 m/s but is stuck", without(moving, 0)
    yield "block 10 starts with 0.1 m/s in mode -1", changed(moving, 0, mode=-1)
    overloaded = simulate(SLIDER(), 0.1, start_positions=np.r_[np.zeros(9), -2e-6])
    yield "block 9 starts stuck beyond mu_s w", without(overloaded, 0)
    yield "block 3 releases to -1 below the limit", changed(overloaded, 0, block=3)
    # Block 10 stops a millionth of its slip too late, and block 1 has nearly all the
    # weight of the chain.
    heavy = Chain(np.r_[4e6, np.full(9, 0.04)], 0.0012, 25e6, 0.8e6, 1e-4, 0.7, 0.45)
    light = simulate(heavy, 1e-3, start_velocities=np.r_[np.zeros(9), 1e-6])
    stop = next_of_block(light, 0)
    late = shifted(light, stop, 1e-6 * light.intervals[stop])
    yield "block 10 slides against its mode +1", late
    weightless = simulate(SLIDER(theta=-1), 1.0)
    yield "block 10 bears no load", changed(weightless, 0, block=10)
