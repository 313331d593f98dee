"""Friction of a block that slides: laws by which the coefficient falls with velocity.

A law is a named tuple of its parameters, with what it says in two methods. The solver
takes the chords between its speeds, so that a law is plain NumPy; beyond the last speed
the coefficient is mu_k.
"""

from typing import Any, NamedTuple, Protocol

import numpy as np

from precursors.model.chain import FloatArray


class FrictionLaw(Protocol):
    """What a law of friction has."""

    @property
    def weakening_velocity(self) -> float:
        """Velocity over which friction falls [m/s]."""

    def speeds(self) -> FloatArray:
        """Speeds [m/s] between which straight lines draw it, from 0 on."""

    def fallen(self, speeds: FloatArray) -> FloatArray:
        """Share of mu_s - mu_k by which friction has fallen at each speed."""

    def _asdict(self) -> dict[str, Any]:
        """Parameters of the law by name, as of any named tuple."""


class LinearWeakening(NamedTuple):
    """mu = mu_s - (mu_s - mu_k) min(v/v_c, 1); it jumps to mu_k if v_c = 0."""

    weakening_velocity: float = 0.0

    def speeds(self) -> FloatArray:
        """From 0 to v_c, without a corner between."""
        return np.array([0.0, self.weakening_velocity])

    def fallen(self, speeds: FloatArray) -> FloatArray:
        """In proportion to the speed."""
        return speeds / self.weakening_velocity


class Chords(NamedTuple):
    """Straight pieces mu = at_rest - fall v of a law; with the
    speed at which each ends [m/s], inf of the last, where mu is mu_k; `fall` is in s/m."""

    ends: FloatArray
    at_rest: FloatArray
    fall: FloatArray


def chords(law: FrictionLaw, mu_s: float, mu_k: float) -> Chords:
    """The law as the solver takes it; one piece where friction jumps."""
    drop = mu_s - mu_k
    if drop == 0.0 or law.weakening_velocity == 0.0:
        return Chords(np.array([np.inf]), np.array([mu_k]), np.zeros(1))
    speeds = law.speeds()
    fallen = drop * law.fallen(speeds)
    fall = np.diff(fallen) / np.diff(speeds)
    at_rest = mu_s - fallen[:-1] + fall * speeds[:-1]
    return Chords(
        np.append(speeds[1:], np.inf), np.append(at_rest, mu_k), np.append(fall, 0.0)
    )
