"""The rigid slider (N = 1): stick-slip of one block driven through K, in closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from precursors.chain import Chain, FloatArray, positive, require_plain
from precursors.reduced.quantities import Model, plain
from precursors.run import TRANSITION, Run, States
from precursors.scene_models import EVENTS_KEPT, FIRST_LOAD, FRONT_LOADS, MU_SAPP, SLIP_DURATION, WAVEFORM

# Corners of the half wave that draws a slip; straight lines between them are within 0.3 % of its height.
WAVE_POINTS = 33


def as_rigid(chain: Chain) -> Chain:
    """One block with the weight and the mass of the whole chain.

    Raises
    ------
    ValueError
        If the chain is more than the paper's.
    """
    require_plain(chain)
    return Chain(
        weights=np.array([chain.normal_load]),
        mass=chain.n_blocks * chain.mass,
        stiffness=chain.stiffness,
        drive_stiffness=chain.drive_stiffness,
        drive_velocity=chain.drive_velocity,
        mu_s=chain.mu_s,
        mu_k=chain.mu_k,
        length=chain.length,
    )


def onset_load(chain: Chain) -> float:
    """Tangential load mu_s F_Z at which the slider is released [N]: mu_sapp = mu_s (Sect. 6.2)."""
    return chain.mu_s * chain.normal_load


def load_drop(chain: Chain) -> float:
    """Fall of the tangential load in each slip, 2 (mu_s - mu_k) F_Z [N], at any drive velocity."""
    return 2.0 * (chain.mu_s - chain.mu_k) * chain.normal_load


def frequency(chain: Chain) -> float:
    """Angular frequency sqrt(K/M) of the slider on the drive's spring [rad/s]."""
    return math.sqrt(chain.drive_stiffness / (chain.n_blocks * chain.mass))


def rigid_slip_duration(chain: Chain) -> float:
    """Duration of each slip [s]: (pi + 2 atan(2 K V / (omega drop))) / omega.

    From the release on, x' = V (1 - cos(omega t)) + (drop / 2) (omega / K) sin(omega t), which is zero again
    where tan(omega t / 2) = -omega drop / (2 K V).
    """
    omega = frequency(chain)
    return (math.pi + 2.0 * math.atan2(2.0 * chain.loading_rate, omega * load_drop(chain))) / omega


def rigid_stick_duration(chain: Chain) -> float:
    """Time between two slips [s]: the load lost is made up at the rate K V."""
    return load_drop(chain) / chain.loading_rate


def slip_load(chain: Chain, since: FloatArray) -> FloatArray:
    """Tangential load F_X at times `since` the release [s] within a slip [N], shape (len(since),)."""
    omega = frequency(chain)
    kinetic = chain.mu_k * chain.normal_load
    swing = 0.5 * load_drop(chain) * np.cos(omega * since)
    drive = chain.loading_rate / omega * np.sin(omega * since)
    return kinetic + swing + drive


def rigid_run(chain: Chain, duration: float = 10.0) -> Run:
    """The transitions of the rigid slider up to `duration` [s]; the run has no stored states.

    Raises
    ------
    ValueError
        If the duration is not positive, or mu_s = mu_k, where a slip follows the other without rest.
    """
    duration = positive("duration", duration, "s")
    if chain.mu_s == chain.mu_k:
        raise ValueError(f"mu_k = {chain.mu_k!r} = mu_s: allowed for the rigid slider is mu_k < mu_s")
    first = onset_load(chain) / chain.loading_rate
    slip, stick = rigid_slip_duration(chain), rigid_stick_duration(chain)
    n_onsets = max(math.floor((duration - first) / (slip + stick)) + 1, 0)
    onsets = first + np.arange(n_onsets) * (slip + stick)
    times = np.column_stack([onsets, onsets + slip]).ravel()
    n = int(np.searchsorted(times, duration, side="right"))
    transitions = np.empty(n, TRANSITION)
    transitions["time"] = times[:n]
    transitions["block"] = 1
    transitions["mode"] = np.arange(1, n + 1) % 2
    transitions["tangential_load"] = onset_load(chain) - load_drop(chain) * (np.arange(n) % 2)
    intervals = np.where(np.arange(n + 1) % 2 == 1, slip, stick)
    intervals[0] = min(first, duration)
    if n:
        intervals[-1] = duration - times[n - 1]
    return Run(
        chain=as_rigid(chain),
        duration=duration,
        transitions=transitions,
        intervals=intervals,
        start_positions=np.zeros(1),
        start_velocities=np.zeros(1),
        states=_no_states(),
    )


def _no_states() -> States:
    none = np.empty((0, 0))
    return States(none, none, none.astype(np.int64), np.empty(0, np.int64), np.empty(0))


def _waveform(chain: Chain) -> FloatArray:
    """Time [s] and load [N] from the start to the end of the first slip, shape (WAVE_POINTS + 1, 2)."""
    since = np.linspace(0.0, rigid_slip_duration(chain), WAVE_POINTS)
    onset = onset_load(chain) / chain.loading_rate
    return np.concatenate([[[0.0, 0.0]], np.column_stack([onset + since, slip_load(chain, since)])])


_ANSWERS: dict[str, Any] = {
    FIRST_LOAD: onset_load,
    EVENTS_KEPT: lambda chain: 1.0,
    MU_SAPP: lambda chain: chain.mu_s,
    FRONT_LOADS: lambda chain: np.full(chain.n_blocks, onset_load(chain)),
    SLIP_DURATION: rigid_slip_duration,
    WAVEFORM: _waveform,
}
RIGID = Model("rigid", "rigid slider", _ANSWERS, plain)
