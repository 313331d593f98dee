"""Runs that are wrong on purpose, one mistake each, and what the auditor says of
them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pandas as pd

from precursors import Chain, Run, simulate
from precursors.audit import ROUNDINGS, audit

# The mistake that has to be found: 1e-9 s is a ten-thousandth of the shortest slip.
SHIFT = 1e-9
# Positions that overload some blocks either way [m]
STRAINED = 1e-5 * np.sin(np.arange(10.0))
# An energy that is off by less, relative to what is turned over, is off by rounding.
ENERGY_ROUNDING = 1e-13
# A number with a unit, in a sentence of the auditor.
NUMBER = r"-?[\d.]+(?:e[-+]\d+)?(?= (?:N|m/s|s)\b)"


def without(run: Run, *removed: int) -> Run:
    """The run with some of its transitions left out: their intervals join the next
    one."""
    instant = np.concatenate([[0.0], np.cumsum(run.intervals)])
    intervals = np.delete(run.intervals, removed)
    kept = np.delete(np.arange(len(run.transitions)), removed)
    for k, number in enumerate([*kept, len(run.transitions)]):
        before = kept[k - 1] if k else -1
        if number != before + 1:
            intervals[k] = instant[number + 1] - instant[before + 1]
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


def with_chain(run: Run, name: str, factor: float) -> Run:
    """The run taken for one of a chain with another parameter."""
    return replace(
        run, chain=replace(run.chain, **{name: factor * getattr(run.chain, name)})
    )


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


def with_extra_release(run: Run) -> Run:
    """Block 10 is let go in the first stick phase and caught again at once."""
    half = run.intervals[0] / 2
    load = run.chain.loading_rate * half
    extra = np.array(
        [(half, 10, 1, load), (half, 10, 0, load)], dtype=run.transitions.dtype
    )
    return replace(
        run,
        transitions=np.concatenate([extra, run.transitions]),
        intervals=np.concatenate(
            [[half, 0.0, run.intervals[0] - half], run.intervals[1:]]
        ),
    )


def falsified() -> Iterator[tuple[str, Run]]:
    """Each wrong run, and what was done to it."""
    slider = Chain.from_slider
    # With uniform loads no block slides backward; with falling ones some do, and from a
    # strained start too.
    uniform = simulate(slider(), until="global slip")
    sticks = np.flatnonzero(uniform.transitions["mode"] == 0)
    stop = int(sticks[0])
    stick = int(sticks[4])
    n = len(uniform.transitions)
    for seconds in (SHIFT, -SHIFT):
        yield f"first release {seconds:+g} s", shifted(uniform, 0, seconds)
        yield f"first stop {seconds:+g} s", shifted(uniform, stop, seconds)
        yield f"last release {seconds:+g} s", shifted(uniform, 160, seconds)
    yield "a stick is missed", without(uniform, stick)
    yield (
        "a stick and the next release are missed",
        without(uniform, stick, next_of_block(uniform, stick)),
    )
    yield "the first release is backward", changed(uniform, 0, mode=-1)
    yield "a stick is a turn", changed(uniform, stick, mode=-1)
    yield "a stick is no change", changed(uniform, stick, mode=1)
    yield "another load", changed(uniform, 100, tangential_load=100.0)
    yield "no load", changed(uniform, 100, tangential_load=np.nan)
    yield (
        "another time",
        changed(uniform, 100, time=uniform.transitions["time"][100] + SHIFT),
    )
    yield "an extra release", with_extra_release(uniform)
    resting = int(np.flatnonzero(uniform.intervals > 1e-3)[-1])
    yield "the last event is missed", without(uniform, *range(resting, n))
    cut = replace(
        uniform, transitions=uniform.transitions[:50], intervals=uniform.intervals[:51]
    )
    yield "another duration", cut
    for name in (
        "mass",
        "stiffness",
        "drive_stiffness",
        "drive_velocity",
        "mu_s",
        "mu_k",
    ):
        yield f"more {name}", with_chain(uniform, name, 1 + 1e-8)
    yield "a little less mu_k", with_chain(uniform, "mu_k", 1 - 1e-9)

    falling = simulate(slider(theta="-5/6"), until="global slip")
    turn = first_backward(falling, 1)
    yield (
        "a turn is a stick",
        without(changed(falling, turn, mode=0), next_of_block(falling, turn)),
    )
    yield "a turn is late", shifted(falling, turn, SHIFT)

    strained = simulate(slider(), 1.0, start_positions=STRAINED)
    release = first_backward(strained, 0)
    yield (
        "a backward slip is missed",
        without(strained, release, next_of_block(strained, release)),
    )
    yield "a backward release is early", shifted(strained, release, -SHIFT)
    moving = simulate(slider(), 0.1, start_velocities=np.r_[np.zeros(9), 0.1])
    yield "a block that moves is stuck", without(moving, 0)
    yield "a block that moves has another mode", changed(moving, 0, mode=-1)
    overloaded = simulate(slider(), 0.1, start_positions=np.r_[np.zeros(9), -2e-6])
    yield "an overloaded block is stuck", without(overloaded, 0)
    yield "a block at rest is let go at the start", changed(overloaded, 0, block=3)
    other_way = -overloaded.transitions["mode"][0]
    yield (
        "an overloaded block goes the other way",
        changed(overloaded, 0, mode=other_way),
    )
    # Block 10 stops a millionth of its slip too late, and block 1 has nearly all the
    # weight of the chain.
    heavy = Chain(np.r_[4e6, np.full(9, 0.04)], 0.0012, 25e6, 0.8e6, 1e-4, 0.7, 0.45)
    light = simulate(heavy, 1e-3, start_velocities=np.r_[np.zeros(9), 1e-6])
    stop = next_of_block(light, 0)
    yield (
        "a light block beside a heavy one is late",
        shifted(light, stop, 1e-6 * light.intervals[stop]),
    )


def audits() -> pd.DataFrame:
    """What the auditor says of each: the first problem with its first and last number,
    and how far it is off.

    Energy is that of a run that is audited to its end, whatever is wrong.
    """
    rows = []
    for name, run in falsified():
        report, whole = audit(run), audit(run, roundings=1e20)
        first, *_ = report.problems
        numbers = [float(number) for number in re.findall(NUMBER, first)]
        rows.append(
            {
                "mistake": name,
                "intervals": report.n_intervals,
                "problems": len(report.problems),
                "first": re.sub(NUMBER, "#", first),
                "time_s": numbers[0],
                "wrong_by": numbers[-1],
                "roundings": report.roundings if report.roundings > ROUNDINGS else 0.0,
                "energy": whole.energy_residual
                if whole.energy_residual > ENERGY_ROUNDING
                else 0.0,
            }
        )
    return pd.DataFrame(rows)
