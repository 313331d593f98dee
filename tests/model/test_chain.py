"""A chain fulfils Eqs. 7-10 of the paper and refuses values out of range."""

import copy
import math
import pickle
import re
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pandas as pd
import pytest

from maegawa2010 import printed
from precursors import Chain
from precursors.model.chain import linear_weights, theta_from_load_cells

ROUNDING = 4e-16  # a few roundings of doubles, relative


def test_the_default_slider_is_the_papers():
    chain = Chain.from_slider()
    assert chain.n_blocks == 10
    assert chain.mass == pytest.approx(0.0012, rel=ROUNDING)  # Eq. 9
    assert chain.stiffness == pytest.approx(25e6, rel=ROUNDING)  # Eq. 10
    assert chain.loading_rate == pytest.approx(80.0, rel=ROUNDING)
    assert chain.normal_load == pytest.approx(400.0, rel=ROUNDING)


@pytest.mark.parametrize("n_blocks", [1, 2, 10])
@pytest.mark.parametrize("theta", [-0.3, 1.0])
def test_weights_add_up_to_the_total_load_and_are_linear(n_blocks, theta):
    weights = linear_weights(n_blocks, 400.0, theta)
    assert math.fsum(weights) == pytest.approx(400.0, rel=1e-14)
    if n_blocks > 2:
        assert np.ptp(np.diff(weights)) < 1e-12
    if n_blocks > 1:
        assert weights[-1] - weights[0] == pytest.approx(
            2 * theta * 400.0 / n_blocks, abs=1e-12
        )


def test_load_cells_of_1_to_3_give_five_sixths_exactly():
    a, b = printed.CELL_LOADS_N
    assert theta_from_load_cells(a, b, spacing=0.06, length=0.1) == Fraction(5, 6)
    assert theta_from_load_cells(b, a, spacing=0.06, length=0.1) == -Fraction(5, 6)


def test_chains_with_equal_parameters_are_equal_and_hash_alike():
    assert Chain.from_slider(theta="5/6") == Chain.from_slider(theta=5 / 6)
    assert hash(Chain.from_slider()) == hash(Chain.from_slider())
    assert Chain.from_slider() != Chain.from_slider(mu_k=0.44)


def test_a_chain_cannot_be_changed():
    chain = Chain.from_slider()
    with pytest.raises(ValueError, match="read-only"):
        chain.weights[0] = 1.0
    with pytest.raises(AttributeError):
        chain.mu_s = 0.1
    for twin in (pickle.loads(pickle.dumps(chain)), copy.deepcopy(chain)):
        assert twin == chain
        assert not twin.weights.flags.writeable


class Quantity(np.ndarray):
    """An array with a unit, which NumPy discards."""

    units = "kN"

    def __new__(cls, values):
        return np.asarray(values).view(cls)

    def __repr__(self) -> str:
        return "<20 mN>"


@pytest.mark.parametrize(
    "weights",
    [
        (20, 30.0),
        np.array([20, 30], dtype=">i2"),
        [Fraction(20), np.float32(30.0)],
        pd.Series([20.0, 30.0], index=["a", "b"]),
        pd.Series([20, 30], index=[1, 2], dtype="Int64"),
        pd.Series([30.0, 20.0], index=[1, 0]).sort_index(),
    ],
)
def test_loads_are_read_from_numbers_of_any_type(weights):
    assert Chain.from_slider(weights=weights).weights.tolist() == [20.0, 30.0]


@pytest.mark.parametrize(
    ("argument", "value", "words"),
    [
        ("n_blocks", 0, "n_blocks must be a whole number from 1 to 100000, but is 0"),
        (
            "slider_mass",
            1e-50,
            "sqrt(stiffness/mass) must be between 1e-20 and 1e+20 rad/s",
        ),
        (
            "theta",
            1.01,
            'theta must be a number between -1 and 1, or a fraction such as "5/6", but is 1.01',
        ),
        ("normal_load", 0.0, "normal_load must be above 0 N, but is 0.0"),
        ("mu_s", -0.1, "mu_s must be between 0 and 1e+60 [1], but is -0.1"),
        ("mu_k", 0.71, "mu_k must be between 0 and mu_s = 0.7, but is 0.71"),
        ("drive_stiffness", math.inf, "must be a finite number [N/m], but is inf"),
        ("mu_s", [0.7, 0.6], "mu_s must be one number for all blocks and times [1]"),
        ("slider_mass", np.ones(10), "slider_mass must be one number for all blocks"),
        (
            "drive_velocity",
            math.sin,
            "drive_velocity must be one number for all blocks",
        ),
        ("drive_velocity", -1e-4, "as the drive never turns back, but is -0.0001"),
        ("weights", [], "weights must be one number [N] per block"),
        ("weights", [1.0, -1.0], "but that of block 2 is -1.0 N"),
        ("weights", [0.0, 0.0], "above 0 N, but all are 0 N"),
        ("weights", np.ma.masked_less([1, 2], 2), "[N] without a mask, but are masked"),
        (
            "weights",
            ["20", 30.0],
            "weights[0] must be a finite number [N], but is '20'",
        ),
        (
            "weights",
            [20.0, True],
            "weights[1] must be a finite number [N], but is True",
        ),
        (
            "weights",
            np.array(["20"]),
            "weights must be numbers [N], but are array(['20'",
        ),
        (
            "weights",
            np.array([True]),
            "weights must be numbers [N], but are array([ Tr",
        ),
        (
            "weights",
            np.array([1.0], object),
            "numbers [N], but are array([1.0], dtype=o",
        ),
        (
            "weights",
            Quantity([0.02]),
            "without a unit of their own, but are <20 mN>: con",
        ),
        (
            "weights",
            pd.Series([20.0, 30.0], index=[1, 0]),
            "in the order of the blocks, but their index is [1, 0]: sort_index() sorts",
        ),
        (
            "weights",
            pd.Series([20.0, None], dtype="Float64"),
            "but that of block 2 is nan N",
        ),
    ],
)
def test_a_bad_value_is_named_with_its_unit_and_range(argument, value, words):
    with pytest.raises(ValueError, match=re.escape(words)) as error:
        Chain.from_slider(**{argument: value})
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("a", "b", "words"),
    [
        (-1.0, 2.0, "load_a must"),
        (0.0, 0.0, "both are 0 N"),
        (400.0, 1.0, "theta must"),
    ],
)
def test_load_cells_that_imply_an_impossible_theta_are_refused(a, b, words):
    with pytest.raises(ValueError, match=words):
        theta_from_load_cells(a, b, spacing=0.06, length=0.1)


@pytest.mark.parametrize("ratio", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("n_blocks", [1, 2, 40])
def test_frequency_bound_holds_and_is_close(n_blocks, ratio):
    chain = Chain(np.ones(n_blocks), 2e-3, 1e6, ratio * 1e6, 1e-4, 0.7, 0.45)
    bonds = np.eye(n_blocks) - np.eye(n_blocks, k=-1)
    stiffness = bonds.T @ np.diag(chain.springs) @ bonds
    highest = math.sqrt(np.linalg.eigvalsh(stiffness)[-1] / chain.mass)
    assert highest <= chain.fastest_frequency_bound
    if n_blocks > 2:
        assert chain.fastest_frequency_bound < 1.6 * highest


@pytest.mark.parametrize(
    ("name", "at_the_limit", "beyond"),
    [
        ("weights", [1e-60], [0.99e-60]),
        ("weights", [1e60], [1.01e60]),
        ("weights", np.ones(100_000), np.ones(100_001)),
        ("drive_velocity", 1e-60, 0.99e-60),
        ("stiffness", 1e12, 1.01e12),
        ("drive_stiffness", 1e12, 1.01e12),
        # sqrt((4 k + K)/m) is between 1e-20 and 1e20.
        ("mass", 4.99e40, 5.01e40),
        ("mass", 5.01e-40, 4.99e-40),
        ("mu_k", 0.5, 0.501),
    ],
)
def test_every_number_may_be_at_its_limit_but_not_beyond(name, at_the_limit, beyond):
    numbers = dict.fromkeys(("mass", "stiffness", "drive_stiffness"), 1.0)
    numbers |= {"weights": [1.0, 2.0], "drive_velocity": 1.0, "mu_s": 0.5, "mu_k": 0.25}
    chain = Chain(**numbers | {name: at_the_limit})
    np.testing.assert_array_equal(getattr(chain, name), at_the_limit)
    with pytest.raises(ValueError, match=r"\A[^\n]+\Z"):
        Chain(**numbers | {name: beyond})


@pytest.mark.parametrize(
    ("name", "wrong", "right"),
    [("n_blocks", 5, 4), ("theta", 0.5, math.nan), ("normal_load", 11.0, 10.0)],
)
def test_arguments_that_contradict_weights_are_refused(name, wrong, right):
    weights = [1.0, 2.0, 3.0, 4.0]
    assert Chain.from_slider(weights=weights, **{name: right}).n_blocks == 4
    with pytest.raises(ValueError, match=f"^{name} must not be given beside weights"):
        Chain.from_slider(weights=weights, **{name: wrong})


def test_chain_keeps_theta_only_while_weights_are_unchanged():
    chain = Chain.from_slider(theta="5/6")
    assert chain.theta == pickle.loads(pickle.dumps(chain)).theta == 5 / 6
    assert math.isnan(replace(chain, weights=chain.weights[::-1]).theta)
    assert math.isnan(Chain.from_slider(weights=chain.weights).theta)


def test_a_profile_is_integrated_over_each_block():
    chain = Chain.from_profile([0.0, 0.0, 3.0, 1.0, 2.0], n_blocks=2, normal_load=60.0)
    assert chain.weights.tolist() == [15.0, 45.0]
    film = Chain.from_profile(np.eye(5)[:, 1:], n_blocks=20, mu_k=0.4)
    assert film.weights.tolist() == [0.0] * 4 + [25.0] * 16
    for wrong in ([0.0, 0.0], [1.0, -1.0], [1.0, np.nan], [[[1.0]]]):
        with pytest.raises(ValueError, match="profile must be"):
            Chain.from_profile(wrong)


# Areas below the lines between points, computed by hand [MPa mm].
PRESSURES = {0: 1, 5: 3, 10: 2, 20: 2, 35: 5, 50: 4, 65: 3, 80: 3, 90: 2, 100: 0}
AREAS = [22.5, 20.0, 30.0, 140 / 3, 130 / 3, 110 / 3, 185 / 6, 30.0, 25.0, 10.0]


@pytest.mark.parametrize(
    ("points", "areas"),
    [
        ({0: 1, 10: 2, 40: 5, 70: 3, 100: 0}, [40.0, 80.0, 260 / 3, 175 / 3, 20.0]),
        (PRESSURES, AREAS),
        ({25: 1, 75: 3}, [25.0, 37.5, 62.5, 75.0]),
    ],
)
def test_profile_is_linear_between_its_positions(points, areas):
    x, p = np.array([*points.items()], float).T
    chain = Chain.from_profile(p, len(areas), positions=x / 1000)
    expected = 400 * np.array(areas) / sum(areas)
    np.testing.assert_allclose(chain.weights, expected, rtol=1e-13)


@pytest.mark.parametrize(
    ("positions", "about"),
    [([0.0, 0.0], "rise"), ([0.1], "one for each"), ([0.0, 0.2], "from 0 to 0.1 m")],
)
def test_positions_of_a_profile_must_be_on_the_slider(positions, about):
    with pytest.raises(ValueError, match=about):
        Chain.from_profile([1.0, 2.0], positions=positions)
