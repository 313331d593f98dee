"""The law for the number of events: by hand, and from the state that it assumes."""

import numpy as np
import pytest

from maegawa2010.studies.event_law.tables import (
    added_load,
    predicted_events,
)
from maegawa2010.studies.members import loaded
from precursors import Chain


def test_the_law_by_hand_of_two_blocks():
    chain = Chain(
        [3.0, 5.0],
        1.0,
        stiffness=4.0,
        drive_stiffness=2.0,
        drive_velocity=1e-4,
        mu_s=0.8,
        mu_k=0.4,
    )
    assert added_load(chain) == pytest.approx(0.4 * (8.0 + 2.0 / 4.0 * 5.0))
    assert predicted_events(chain) == pytest.approx(
        0.4 * (8.0 - 3.0 + 2.5) / (0.4 * 3.0)
    )


def test_the_compression_is_that_of_a_chain_with_kinetic_friction_everywhere():
    chain = loaded(Chain.from_slider(n_blocks=6, theta="1/3"), "middle")
    friction = chain.mu_k * chain.weights
    matrix = chain.stiffness * (2 * np.eye(6) - np.eye(6, k=1) - np.eye(6, k=-1))
    matrix[0, 0] = matrix[-1, -1] = chain.stiffness
    matrix[0, 0] += chain.drive_stiffness
    # F_X = mu_k F_Z = K (V t - x_1); choose V t and solve for the positions.
    drive = added_load(chain) / chain.drive_stiffness
    positions = np.linalg.solve(
        matrix, np.eye(6)[0] * chain.drive_stiffness * drive - friction
    )
    assert positions[-1] == pytest.approx(0.0, abs=1e-12 * positions[0])
