"""The time mean of F_X under many loadings and drives."""

import numpy as np
from places import committed
from settings import CONFIG

from maegawa2010.studies.mean_load.tables import mean_load_table

MU_K = CONFIG["chain"]["mu_k"]
# Runs of tens of seconds are beyond predictability: roundings change their slips.
CHAOS = 2e-3


def test_every_mean_is_that_of_kinetic_friction_with_what_the_balance_adds():
    few = CONFIG["mean_load"] | {"n_blocks": [10, 20], "seconds": [10, 5]}
    table = mean_load_table(CONFIG["chain"], few)
    there = committed("mean_load")
    for rows in (table, there):
        explained = MU_K + rows["stored"] + rows["backward"]
        np.testing.assert_allclose(rows["mean"], explained, atol=1e-8)
        assert (rows["largest"] > rows["mean"]).all()
    random, known = (rows.query("varied == 'weights'") for rows in (table, there))
    np.testing.assert_allclose(random["mean"], known["mean"], atol=CHAOS)
    assert abs(there["mean"] - MU_K).max() < 1e-3
    assert set(there["n_blocks"]) == set(CONFIG["mean_load"]["n_blocks"])
