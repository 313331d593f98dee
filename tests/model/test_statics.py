"""A chain at rest carries at most mu_s F_Z for any weights (Eqs. 11-14)."""

import numpy as np
import pytest
from chains import SCENES

from precursors import Chain
from precursors.model.statics import (
    balance_matrix,
    compressions_as_printed,
    largest_load_at_rest,
    load_bound,
    maximal_compressions,
    maximal_strain_positions,
)

# Error of sums of up to 300 terms, each rounded to 1e-16 of the sum.
ROUNDING = 1e-12
# The tolerance of the linear program is 1e-10 of F_Z.
LP = 1e-9


def random_chain(n: int, rng: np.random.Generator) -> Chain:
    """Make a chain with random weights, mu_s and springs; K/k spans twelve decades."""
    stiffness, drive_stiffness = 1e6 * 10 ** rng.uniform(-3, 3, size=2)
    return Chain(
        weights=rng.exponential(40.0, n),
        mass=1e-3,
        stiffness=stiffness,
        drive_stiffness=drive_stiffness,
        drive_velocity=1e-4,
        mu_s=rng.uniform(0.1, 1.0),
        mu_k=0.0,
    )


RNG = np.random.default_rng(2010)
RANDOM = [random_chain(n, RNG) for n in (1, 2, 7, 300)]
PAPERS = [Chain.from_slider(theta=theta) for theta in SCENES.values()]
every_chain = pytest.mark.parametrize(
    "chain", [*PAPERS, *RANDOM], ids=lambda chain: f"N={chain.n_blocks}"
)


@every_chain
def test_every_block_is_at_its_limit_at_maximal_strain(chain):
    forces = balance_matrix(chain) @ maximal_compressions(chain)
    np.testing.assert_allclose(
        forces, chain.strength, rtol=0, atol=ROUNDING * load_bound(chain)
    )
    load = chain.drive_stiffness * (0 - maximal_strain_positions(chain)[0])
    assert load == pytest.approx(load_bound(chain), rel=ROUNDING)


@every_chain
def test_largest_load_at_rest_is_mu_s_F_Z_in_the_state_of_eq_12(chain):
    load, compressions = largest_load_at_rest(chain)
    assert load == pytest.approx(chain.mu_s * chain.weights.sum(), rel=LP)
    np.testing.assert_allclose(compressions, maximal_compressions(chain), rtol=LP)


@pytest.mark.parametrize(
    ("scene", "load"),
    [("trailing", 2527 / 6), ("uniform", 1127.0), ("leading", 10997 / 6)],
)
def test_eq_12_as_printed_gives_1127_n_instead_of_280_n(scene, load):
    chain = Chain.from_slider(theta=SCENES[scene])
    compressions = compressions_as_printed(chain)
    assert chain.drive_stiffness * compressions[0] == pytest.approx(load, rel=ROUNDING)
    # Its last block would not rest: 25/0.8 times its limit.
    force = (balance_matrix(chain) @ compressions)[-1]
    assert force == pytest.approx(25 / 0.8 * chain.strength[-1], rel=ROUNDING)
