"""A law of friction of one's own: the coefficient falls exponentially with velocity.

Prints:
    ExponentialWeakening: mu_sapp = 0.560
    half the step changes loads by 0.01 N
"""

from typing import NamedTuple

import numpy as np

from precursors import Chain, LargerChain, apparent_friction


class ExponentialWeakening(NamedTuple):
    """mu = mu_k + (mu_s - mu_k) exp(-v/v_c)."""

    weakening_velocity: float  # v_c [m/s]

    def speeds(self):
        """Speeds [m/s] between which straight lines draw the law; mu_k beyond."""
        return self.weakening_velocity * np.linspace(0.0, 20.0, 401)

    def fallen(self, speeds):
        """Share of mu_s - mu_k by which friction has fallen."""
        return 1.0 - np.exp(-speeds / self.weakening_velocity)


law = ExponentialWeakening(0.02)
run = LargerChain(Chain.from_slider(), relaxation_time=1e-4, friction=law).simulate()
print(f"{run.numbers['friction']}: mu_sapp = {apparent_friction(run):.3f}")
print(f"half the step changes loads by {run.numbers['halved_load_N']:.2f} N")
