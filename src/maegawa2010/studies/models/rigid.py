"""The rigid slider (N = 1): stick-slip of one block driven through K, in closed form.

It is released at the largest load of a state of rest, so that mu_sapp = mu_s (Sect.
6.2).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import load_bound

# Corners of the half wave that draws a slip; straight lines between them are within 0.3
# % of its height.
WAVE_POINTS = 33


def load_drop(chain: Chain) -> float:
    """Fall of the tangential load in each slip, 2 (mu_s - mu_k) F_Z [N], at any drive
    velocity."""
    return 2.0 * (chain.mu_s - chain.mu_k) * chain.normal_load


def frequency(chain: Chain) -> float:
    """Angular frequency sqrt(K/M) of the slider on the drive's spring [rad/s]."""
    return math.sqrt(chain.drive_stiffness / (chain.n_blocks * chain.mass))


def rigid_slip_duration(chain: Chain) -> float:
    """Duration of each slip [s]: (pi + 2 atan(2 K V / (omega drop))) / omega.

    From the release on, x' = V (1 - cos(omega t)) + (drop / 2) (omega / K) sin(omega
    t), which is zero again where tan(omega t / 2) = -omega drop / (2 K V).
    """
    omega = frequency(chain)
    return (
        math.pi + 2.0 * math.atan2(2.0 * chain.loading_rate, omega * load_drop(chain))
    ) / omega


def slip_load(chain: Chain, since: FloatArray) -> FloatArray:
    """Tangential load F_X at times `since` the release [s] within a slip [N], shape
    (len(since),)."""
    omega = frequency(chain)
    kinetic = chain.mu_k * chain.normal_load
    swing = 0.5 * load_drop(chain) * np.cos(omega * since)
    drive = chain.loading_rate / omega * np.sin(omega * since)
    return kinetic + swing + drive


def waveform(chain: Chain) -> FloatArray:
    """Time [s] and load [N] from the start to the end of the first slip, shape
    (WAVE_POINTS + 1, 2)."""
    since = np.linspace(0.0, rigid_slip_duration(chain), WAVE_POINTS)
    onset = load_bound(chain) / chain.loading_rate
    return np.concatenate(
        [[[0.0, 0.0]], np.column_stack([onset + since, slip_load(chain, since)])]
    )


def answers(chain: Chain) -> dict[str, Any]:
    """All answers of the model."""
    return {
        "first_load": load_bound(chain),
        "events_counted": 1,
        "mu_sapp": chain.mu_s,
        "front_loads": np.full(chain.n_blocks, load_bound(chain)),
        "slip_duration": rigid_slip_duration(chain),
        "waveform": waveform(chain),
    }
