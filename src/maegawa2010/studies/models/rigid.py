"""The rigid slider (N = 1): stick-slip of one block driven through K, in closed form.

It slips at the largest load of a state of rest, so mu_sapp = mu_s (Sect. 6.2).
"""

import math
from typing import Any

import numpy as np

from precursors.model.chain import Chain
from precursors.model.statics import load_bound


def load_drop(chain: Chain) -> float:
    """Drop of the tangential load in each slip, 2 (mu_s - mu_k) F_Z [N], at any drive
    velocity."""
    return 2.0 * (chain.mu_s - chain.mu_k) * chain.normal_load


def frequency(chain: Chain) -> float:
    """Angular frequency sqrt(K/M) of the slider on the drive's spring [rad/s]."""
    return math.sqrt(chain.drive_stiffness / (chain.n_blocks * chain.mass))


def rigid_slip_duration(chain: Chain) -> float:
    """Duration of each slip [s]: (pi + 2 atan(2 K V / (omega drop))) / omega.

    After the release x' = V (1 - cos(omega t)) + (drop / 2) (omega / K) sin(omega t),
    which is zero again when tan(omega t / 2) = -omega drop / (2 K V).
    """
    omega = frequency(chain)
    return (
        math.pi + 2.0 * math.atan2(2.0 * chain.loading_rate, omega * load_drop(chain))
    ) / omega


def answers(chain: Chain) -> dict[str, Any]:
    """All answers of the model, by quantity."""
    return {
        "first_load": load_bound(chain),
        "events_counted": 1,
        "mu_sapp": chain.mu_s,
        "front_loads": np.full(chain.n_blocks, load_bound(chain)),
        "slip_duration": rigid_slip_duration(chain),
    }
