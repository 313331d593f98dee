"""What the ledger asks of a scene and no other table holds: its parameters, and how its slips come about."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd

from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import find_precursors, find_slips
from precursors.model.chain import Chain
from precursors.model.statics import maximal_compressions
from precursors.solver.run import Run

# Where the growth of the propagation length in the experiment changes (Sect. 6.1).
KINK = 0.7


@dataclass(frozen=True)
class Measure:
    """A number of a scene; `block` (1..N) if it is one block's."""

    quantity: str
    unit: str
    value: float
    block: int | None = None


def measures(run: Run) -> Iterator[Measure]:
    """Parameters of the run's chain in the paper's symbols, then what happens up to its first global slip."""
    yield from parameters(run.chain)
    yield from up_to_global_slip(run)


def parameters(chain: Chain) -> Iterator[Measure]:
    """What the equations hold (Eqs. 2-10), block by block where blocks differ."""
    yield Measure("N", "1", chain.n_blocks)
    yield Measure("mu_s", "1", chain.mu_s)
    yield Measure("mu_k", "1", chain.mu_k)
    yield Measure("F_Z", "N", chain.normal_load)
    yield Measure("m", "kg", chain.mass)
    yield Measure("k", "N/m", chain.stiffness)
    yield Measure("K", "N/m", chain.drive_stiffness)
    yield Measure("V", "m/s", chain.drive_velocity)
    yield Measure("K V", "N/s", chain.loading_rate)
    for block, (weight, strength) in enumerate(zip(chain.weights, chain.strength, strict=True), start=1):
        yield Measure("w_i", "N", float(weight), block)
        yield Measure("mu_s w_i", "N", float(strength), block)


def up_to_global_slip(run: Run) -> Iterator[Measure]:
    """Where events begin, whether blocks slide backward, and the strain left; NaN without a global slip.

    The residual strain is the compression of the springs between the blocks, of which the largest is that of
    Eq. 12 (corrected).
    """
    slips = find_slips(run)
    begins_at = run.transitions["block"][np.searchsorted(run.transitions["time"], slips["onset"])]
    share = float(np.mean(begins_at == 1)) if len(slips) else np.nan
    yield Measure("events that begin at block 1, of all", "1", share)
    backward = strain = below = beyond = np.nan
    first = first_global(slips)
    if first is not None:
        onset = float(slips["onset"].iloc[first])
        earlier = run.transitions[run.transitions["time"] < onset]
        backward = float(np.count_nonzero(earlier["mode"] == -1))
        strain = residual_strain(run, onset)
        below, beyond = growth(find_precursors(slips), run.chain.n_blocks)
    yield Measure("times that a block begins to slide backward before the first global slip", "1", backward)
    yield Measure("residual strain at the first global slip, of the largest", "1", strain)
    yield Measure(f"growth of L_p/L with the load up to {KINK:g}", "1/N", below)
    yield Measure(f"growth of L_p/L with the load beyond {KINK:g}", "1/N", beyond)


def growth(kept: pd.DataFrame, n_blocks: int) -> tuple[float, float]:
    """Growth of L_p/L with the load [1/N] before and after the last event kept that has L_p/L <= KINK.

    NaN where no two events lie on that side.
    """
    length, load = kept["front"].to_numpy() / n_blocks, kept["load_before"].to_numpy()
    kink = np.flatnonzero(length <= KINK)
    if len(kink) == 0:
        return np.nan, np.nan
    rise, span = np.diff(length[[0, kink[-1], -1]]), np.diff(load[[0, kink[-1], -1]])
    below, beyond = np.divide(rise, span, out=np.full(2, np.nan), where=span > 0)
    return float(below), float(beyond)


def residual_strain(run: Run, time: float) -> float:
    """Compression of the slider at a time [s] over the largest at rest (Eqs. 11, 12); NaN for one block."""
    if run.chain.n_blocks == 1:
        return np.nan
    compressions = run.spring_forces([time])[0] / run.chain.springs
    return float(compressions[1:].sum() / maximal_compressions(run.chain)[1:].sum())
