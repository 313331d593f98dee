"""Regularised friction: blocks creep by the closed form, which delays the first slip."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from precursors import Chain
from precursors.accuracy.failures.regularised_friction import measured_creep
from precursors.methods.regularised import (
    STRIBECK,
    creep_velocity,
    friction_coefficient,
    peak_velocity,
    solve_regularised,
)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("width", [1e-6, 1e-8])
def test_a_block_held_by_regularised_friction_creeps_at_the_closed_form(ratio, width):
    chain = Chain.from_slider(n_blocks=1)
    load, weight = ratio * float(chain.strength[0]), float(chain.weights[0])
    creep = creep_velocity(load, weight, width, chain.mu_s)
    z = math.atanh(ratio)
    drop = (1 - chain.mu_k / chain.mu_s) * (z / STRIBECK) ** 2 * ratio / ((1 - ratio**2) * z)
    assert measured_creep(ratio, width) == pytest.approx(creep * (1 + drop), rel=1e-5)


def test_creep_delays_the_first_slip_as_the_closed_form_says():
    # Rigid block, loaded at K V - K v(F) up to the load at which it lets go.
    chain, width = Chain.from_slider(n_blocks=1), 3e-6
    strength = float(chain.strength[0])
    peak = peak_velocity(width, chain.mu_s, chain.mu_k)
    largest = float(friction_coefficient(np.array(peak), width, chain.mu_s, chain.mu_k)) * chain.weights[0]
    rate = chain.drive_stiffness
    onset, _ = quad(
        lambda load: (
            1 / (rate * (chain.drive_velocity - creep_velocity(load, chain.weights[0], width, chain.mu_s)))
        ),
        0.0,
        largest,
        limit=200,
    )
    without_creep = strength / chain.loading_rate
    run = solve_regularised(chain, 1.2 * without_creep, width).run
    delay = run.transitions["time"][0] - without_creep
    # The Stribeck drop near the peak, left out above, is some percent of the delay.
    assert delay == pytest.approx(onset - without_creep, rel=0.1)
    assert delay > 0.02 * without_creep
