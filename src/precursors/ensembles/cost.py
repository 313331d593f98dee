"""What a run is expected to take, by its parameters alone: an absurd one is refused before it starts.

Near the paper's slider it is what runs took when they were measured. Far from it windows are counted: pieces
of motion as long as a third of the fastest period, of which a slip takes as many as fit into it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from precursors.model.chain import FloatArray
from precursors.model.slider import Slider, loading_time, spring_stiffness

# Computing time [s] above which a scene is refused, unless the configuration has a `longest_run` of its own.
LONGEST_RUN = 3600.0
# Measured times [s], for N = 2..200 at three theta. Single runs are off by a factor 2 either way, which the
# many runs of a chunk average out. This is what a run takes beside its motion:
SECONDS_PER_RUN = 3.5e-4
# Of the exact solver for one window at N = 0; it grows by as much for every ten blocks.
SECONDS_PER_WINDOW = 1e-6
# The proof of a run takes so many times as long.
PROOF_PER_RUN = 5e3
# Its load curve (`load_curve`) took 0.5 to 34 times what the run is expected to, most often about
TRACE_PER_RUN = 10.0
# Windows are dearer by so much where dashpots or interface springs link the blocks' equations.
LINKED = 5.0
# Of a slip of block 1 alone; of a slider overdamped by dashpots, in times eta/k, until it has crept to rest.
WINDOWS_OF_ONE_BLOCK, CREEP = 10.0, 80.0
# The paper's slider: windows of a slip and of one loading to mu_s F_Z, both per block; slips in the latter.
PAPERS_WINDOWS, PAPERS_LOADING, PAPERS_SLIPS = 11.0, 1e5, 14.0
# Smallest mu_s - mu_k that counts, relative to mu_s; block 1 bears at least this part of the mean load.
LEAST_DROP, LEAST_LOAD = 1e-3, 0.1


def seconds_to_first_slip(
    n_blocks: ArrayLike, interface_stiffness: ArrayLike = 0.0, viscosity: ArrayLike = 0.0
) -> FloatArray:
    """Time that a run to its first global slip takes on one core [s]: 0.7 ms at N = 10, 1 s at N = 200.

    On interface springs the chain rings all the time, and longer where no viscosity damps it: with it 0.02 s
    at N = 10 and 4 s at N = 100, without it 0.1 s at N = 10 and 2 s at N = 40.
    """
    n_blocks = np.asarray(n_blocks, float)
    of_blocks = SECONDS_PER_RUN + 1.0e-6 * n_blocks**2.6
    return of_blocks + seconds_of_ringing(n_blocks, interface_stiffness, viscosity)


def seconds_of_ringing(
    n_blocks: ArrayLike, interface_stiffness: ArrayLike, viscosity: ArrayLike
) -> FloatArray:
    """Time that the ringing of a chain on interface springs takes for one loading to mu_s F_Z [s]."""
    damped = np.where(np.asarray(viscosity) > 0.0, 1.0e-4, 5.0e-4)
    return np.where(np.asarray(interface_stiffness) > 0.0, damped * np.asarray(n_blocks, float) ** 2.3, 0.0)


def seconds_of_long_run(n_blocks: ArrayLike, loadings: ArrayLike, friction_ratio: ArrayLike) -> FloatArray:
    """Time that a run beyond its first global slip takes on one core [s].

    It is in proportion to the load that the drive brings in, in units of the chain's strength mu_s F_Z, and
    to the number of slips, which grows where mu_k/mu_s comes close to 1.
    """
    slips = np.asarray(loadings, float) * np.maximum(
        1.0, 0.36 / np.maximum(1e-3, 1.0 - np.asarray(friction_ratio))
    )
    return SECONDS_PER_RUN + 1.4e-6 * np.asarray(n_blocks, float) ** 2.9 * slips


def seconds_of_run(slider: Slider, duration: float) -> float:
    """Time that a run is expected to take on one core [s]; infinite beyond all numbers.

    Measured times were up to ten times as long, for parameters over eight decades each, and often far shorter
    (docs/reliability.md): what is refused may be allowed, but what is accepted ends.

    Parameters
    ----------
    slider : mapping
        Arguments of `Chain.from_slider`, theta as a number.
    duration : float
        Time that is simulated [s].
    """
    with np.errstate(all="ignore"):
        seconds = float(
            _seconds({key: np.float64(value) for key, value in slider.items()}, np.float64(duration))
        )
    return math.inf if math.isnan(seconds) else seconds


def too_long(config: Mapping[str, Any], where: str, seconds: float) -> Iterator[str]:
    """Refuse what is expected to take longer than `longest_run`."""
    longest = float(config.get("longest_run", LONGEST_RUN))
    if seconds > longest:
        yield (
            f"{where} would take about {seconds:.1g} s: allowed is longest_run = {longest:g} s "
            "(fewer blocks, a shorter duration, or a larger longest_run)"
        )


def _seconds(slider: Slider, duration: Any) -> Any:
    n_blocks, drive_stiffness = slider["n_blocks"], slider["drive_stiffness"]
    springs, viscosity = slider.get("interface_stiffness", 0.0), slider.get("viscosity", 0.0)
    mass = slider["slider_mass"] / n_blocks
    stiffness = spring_stiffness(slider) if n_blocks > 1 else np.float64(0.0)
    drop = np.maximum(LEAST_DROP, 1.0 - slider["mu_k"] / slider["mu_s"])
    mean_load = slider["normal_load"] / n_blocks
    first_load = mean_load * np.maximum(LEAST_LOAD, 1.0 - slider["theta"] if n_blocks > 1 else 1.0)

    brought = drive_stiffness * slider["drive_velocity"] * duration
    is_linked = bool(springs or viscosity)
    if not is_linked and brought < slider["mu_s"] * first_load:
        return SECONDS_PER_RUN  # block 1 does not come to slip, or bears next to nothing

    stiffest = np.maximum(4 * stiffness, drive_stiffness + 2 * stiffness) + springs / n_blocks
    rate = np.sqrt(stiffest / mass) + 4 * viscosity / mass * (n_blocks > 1)
    windows_per_second = SECONDS_PER_WINDOW * (1 + n_blocks / 10) * (LINKED if is_linked else 1.0)
    sliding = duration * rate * windows_per_second

    loadings = duration / loading_time(slider)
    own_slips = brought / (2 * slider["mu_s"] * drop * first_load)
    # The whole slider slips for half a period on the spring of the drive, while its blocks ring.
    slip = np.pi * np.sqrt((slider["slider_mass"] + slider.get("head_mass", 0.0)) / drive_stiffness)
    slipping = seconds_of_long_run(n_blocks, loadings, slider["mu_k"] / slider["mu_s"])
    # Kinetic friction ends it, after more half periods the less there is.
    swings = np.maximum(1.0, slider["mu_s"] / (2 * slider["mu_k"]))
    slipping += loadings / drop * swings * slip * rate * windows_per_second
    slipping += own_slips * WINDOWS_OF_ONE_BLOCK * windows_per_second
    if viscosity and n_blocks > 1:
        creeps = np.maximum(loadings / drop, own_slips / PAPERS_SLIPS)
        slipping += creeps * CREEP * viscosity / stiffness * rate * windows_per_second
    ringing = seconds_of_ringing(n_blocks, springs, viscosity)
    # From slip to slip, and through each of them.
    between = loading_time(slider) * rate / (PAPERS_LOADING * n_blocks)
    ringing *= np.maximum(np.maximum(1.0, between), slip * rate / (PAPERS_WINDOWS * n_blocks))
    slipping += ringing * np.maximum(loadings, own_slips * drop / (0.36 * PAPERS_SLIPS))
    # Never more than blocks that slide all the time.
    return np.fmin(slipping, sliding) + SECONDS_PER_RUN
