"""The chain of blocks, with the parameters of the equations of motion (Eqs. 2-10)."""

from __future__ import annotations

import inspect
import math
from contextlib import suppress
from dataclasses import dataclass, field, fields
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.model.checks import (
    LARGEST,
    MOST_BLOCKS,
    SMALLEST,
    block_array,
    not_negative,
    number,
    positive,
    whole,
)
from precursors.model.profile import shares_of_profile

FloatArray = NDArray[np.float64]
# Limits of k/K and of sqrt(k/m) [rad/s]. Beyond them, a slip needs more steps than a
# run may have, or its duration is lost in rounding.
STIFFEST = 1e12
FASTEST = 1e20
# Defaults, as in the paper.
N_BLOCKS = 10
THETA = 0.0
NORMAL_LOAD = 400.0
CELL_SPACING = 0.06  # between the paper's load cells [m]
# Mode of a block without normal load: it moves without friction, so it neither
# sticks nor slips, and it has no transitions.
FREE = 2
# Share of the mean normal load below which a block does not count in slip events. Such
# a light block vibrates from one slip into the next, and would join them into one
# event. In 60 random chains with the paper's drive, light blocks changed mu_sapp in no
# chain if their share was 6e-5 or more, in 62 % at 1e-5, and in 88 % at 1e-6 and below.
LEAST_SHARE = 1e-4
_POSITIVE = {
    "mass": "kg",
    "stiffness": "N/m",
    "drive_stiffness": "N/m",
    "drive_velocity": "m/s",
    "length": "m",
}


@dataclass(frozen=True, eq=False)
class Chain:
    """N blocks in a row on a rigid plane, pushed at block 1 through a spring (Eqs.
    2-6).

    Parameters
    ----------
    weights : array_like, shape (N,)
        Normal load w_i of each block [N], not negative, not all zero.
    mass : float
        Mass m of one block [kg], positive.
    stiffness : float
        Stiffness k of the spring between neighbours [N/m], positive.
    drive_stiffness : float
        Stiffness K of the spring between the drive and block 1 [N/m], positive.
    drive_velocity : float
        Speed V of the drive [m/s], positive.
    mu_s, mu_k : float
        Coefficients of static and kinetic friction, 0 <= mu_k <= mu_s.
    length : float
        Length L of the contact [m], positive.

    The attribute `theta` is the value given to `from_slider`, and NaN for a chain made
    in another way.
    """

    weights: FloatArray
    mass: float
    stiffness: float
    drive_stiffness: float
    drive_velocity: float
    mu_s: float
    mu_k: float
    length: float = 0.1
    theta: float = field(default=math.nan, init=False)

    def __post_init__(self) -> None:
        if number("drive_velocity", self.drive_velocity, "m/s") < 0:
            raise ValueError(
                "drive_velocity must be above 0 m/s, as the drive never turns back, "
                f"but is {self.drive_velocity!r}"
            )
        checked: dict[str, Any] = {
            name: positive(name, getattr(self, name), unit)
            for name, unit in _POSITIVE.items()
        }
        checked["weights"] = _weights(self.weights)
        checked["mu_s"] = not_negative("mu_s", self.mu_s, "1")
        checked["mu_k"] = number("mu_k", self.mu_k, "1")
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        if not 1 / STIFFEST <= self.stiffness / self.drive_stiffness <= STIFFEST:
            raise ValueError(
                f"stiffness and drive_stiffness must be within a factor of {STIFFEST:g}, but are "
                f"{self.stiffness!r} and {self.drive_stiffness!r} N/m"
            )
        if not 1 / FASTEST <= self.fastest_frequency_bound <= FASTEST:
            raise ValueError(
                f"sqrt(stiffness/mass) must be between {1 / FASTEST:g} and {FASTEST:g} rad/s, but is "
                f"{self.fastest_frequency_bound:g}"
            )
        if not 0 <= self.mu_k <= self.mu_s:
            raise ValueError(
                f"mu_k must be between 0 and mu_s = {self.mu_s!r}, but is {self.mu_k!r}"
            )

    @classmethod
    def from_slider(
        cls,
        n_blocks: int = N_BLOCKS,
        theta: float | str = THETA,
        normal_load: float = NORMAL_LOAD,
        mu_s: float = 0.70,
        mu_k: float = 0.45,
        drive_stiffness: float = 0.8e6,
        drive_velocity: float = 1e-4,
        slider_mass: float = 0.012,
        youngs_modulus: float = 2.5e9,
        cross_section: float = 1e-4,
        length: float = 0.1,
        weights: ArrayLike | None = None,
    ) -> Chain:
        """Cut a slider into N equal blocks (Eqs. 7, 9 and 10); the defaults are the
        paper's.

        Parameters
        ----------
        n_blocks : int
            Number N of blocks, at least 1.
        theta : float or str
            Degree of non-uniformity of the normal load, -1 <= theta <= 1, as a number
            or a fraction such as "5/6".
        normal_load : float
            Total normal load F_Z [N].
        mu_s, mu_k : float
            Coefficients of static and kinetic friction.
        drive_stiffness, drive_velocity : float
            K [N/m] and V [m/s] of the drive.
        slider_mass, youngs_modulus, cross_section, length : float
            M [kg], E [Pa], S [m^2] and L [m] of the slider.
        weights : array_like, shape (N,), optional
            Measured normal load of each block [N], starting at the trailing edge. The
            weights replace n_blocks, theta and normal_load.

        Raises
        ------
        ValueError
            If a parameter is out of range; the message names it and its limits.
        """
        if weights is None:
            loads = linear_weights(n_blocks, normal_load, theta)
        else:
            loads = _weights(weights)
            _must_agree("n_blocks", n_blocks, N_BLOCKS, len(loads))
            _must_agree("theta", theta, THETA)
            _must_agree("normal_load", normal_load, NORMAL_LOAD, math.fsum(loads))
        n = len(loads)
        youngs_modulus = positive("youngs_modulus", youngs_modulus, "Pa")
        cross_section = positive("cross_section", cross_section, "m^2")
        length = positive("length", length, "m")
        chain = cls(
            weights=loads,
            mass=positive("slider_mass", slider_mass, "kg") / n,
            stiffness=n * youngs_modulus * cross_section / length,
            drive_stiffness=drive_stiffness,
            drive_velocity=drive_velocity,
            mu_s=mu_s,
            mu_k=mu_k,
            length=length,
        )
        return chain if weights is not None else remember_theta(chain, theta)

    @classmethod
    def from_profile(
        cls,
        profile: ArrayLike,
        n_blocks: int = N_BLOCKS,
        normal_load: float = NORMAL_LOAD,
        positions: ArrayLike | None = None,
        **slider: Any,
    ) -> Chain:
        """Cut a slider into N blocks whose loads have the shape of a measured profile.

        Without positions, the M values belong to M equal cells of the slider. With
        positions, the profile is interpolated linearly, and is constant beyond the
        first and the last. The load of a block is the integral of the profile over the
        block, scaled to the total load.

        Parameters
        ----------
        profile : array_like, shape (M,) or (M, width)
            Pressure or load, in any unit, not negative, starting at the trailing edge;
            a matrix is summed over the width.
        n_blocks : int
            Number N of blocks.
        normal_load : float
            Total normal load F_Z [N].
        positions : array_like, shape (M,), optional
            Distances from the trailing edge [m] at which the profile was measured,
            rising.
        **slider
            Other arguments of `from_slider`.
        """
        n = whole("n_blocks", n_blocks, MOST_BLOCKS)
        length = positive("length", slider.get("length", SLIDER["length"]), "m")
        loads = shares_of_profile(profile, n, positions, length)
        return cls.from_slider(
            weights=positive("normal_load", normal_load, "N") * loads, **slider
        )

    @property
    def n_blocks(self) -> int:
        """Number N of blocks."""
        return len(self.weights)

    @property
    def normal_load(self) -> float:
        """Total normal load F_Z [N] (Eq. 8)."""
        return math.fsum(self.weights)

    @property
    def bears_load(self) -> NDArray[np.bool_]:
        """Which blocks count in slip events, shape (N,): those that bear at least
        `LEAST_SHARE` of the mean load."""
        return self.weights >= LEAST_SHARE * self.weights.mean()

    @property
    def strength(self) -> FloatArray:
        """Largest static friction mu_s w_i of each block [N], shape (N,) (Eq. 5)."""
        return self.mu_s * self.weights

    @property
    def kinetic_friction(self) -> FloatArray:
        """Kinetic friction mu_k w_i of each block [N], shape (N,) (Eq. 6)."""
        return self.mu_k * self.weights

    @property
    def springs(self) -> FloatArray:
        """Stiffness of the spring behind each block [N/m], shape (N,): K, k, k, ..."""
        between = np.full(self.n_blocks - 1, self.stiffness)
        return np.append(self.drive_stiffness, between)

    @property
    def fastest_frequency_bound(self) -> float:
        """Upper bound of the chain's angular frequencies [rad/s] (Gershgorin)."""
        return math.sqrt((4 * self.stiffness + self.drive_stiffness) / self.mass)

    @property
    def loading_rate(self) -> float:
        """Rate K V at which the tangential load grows while block 1 sticks [N/s]."""
        return self.drive_stiffness * self.drive_velocity

    def __repr__(self) -> str:
        return (
            f"Chain of {self.n_blocks} blocks\n"
            f"  w_1 = {self.weights[0]:g} N, w_N = {self.weights[-1]:g} N, F_Z = {self.normal_load:g} N, "
            f"mu_s = {self.mu_s:g}, mu_k = {self.mu_k:g}\n"
            f"  m = {self.mass:g} kg, k = {self.stiffness:g} N/m, K = {self.drive_stiffness:g} N/m, "
            f"V = {self.drive_velocity:g} m/s, L = {self.length:g} m"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # A copy is made by the constructor, so it is checked and read-only, too.
        arguments = tuple(getattr(self, name) for name in ARGUMENTS)
        return type(self), arguments, {"theta": self.theta}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Chain):
            return NotImplemented
        return all(
            np.array_equal(getattr(self, name), getattr(other, name))
            for name in ARGUMENTS
        )

    def __hash__(self) -> int:
        return hash(self.weights.tobytes())


ARGUMENTS = [field.name for field in fields(Chain) if field.init]
# Arguments of `Chain.from_slider` and their defaults, which are the paper's.
SLIDER = {
    name: p.default
    for name, p in inspect.signature(Chain.from_slider).parameters.items()
}


def remember_theta(chain: Chain, theta: float | str) -> Chain:
    """Set the theta of a new chain, and return the chain."""
    object.__setattr__(chain, "theta", parse_theta(theta))
    return chain


def linear_weights(n_blocks: int, normal_load: float, theta: float | str) -> FloatArray:
    """Return normal loads w_i [N], shape (N,), that change linearly along the slider
    (Eq. 7; w_1 = F_Z for N = 1)."""
    n = whole("n_blocks", n_blocks, MOST_BLOCKS)
    load = positive("normal_load", normal_load, "N")
    degree = parse_theta(theta)
    i = np.arange(1, n + 1)
    return load / n * (1 + (2 * i - n - 1) / max(n - 1, 1) * degree)


def parse_theta(theta: float | str) -> float:
    """Read theta from a number between -1 and 1, or from a fraction such as "5/6"."""
    with suppress(ArithmeticError, ValueError):
        if isinstance(theta, str):
            plain = theta.replace("_", "?")  # Python reads 0_1 as 1
            value = float(Fraction(plain) if "/" in plain else plain)
        else:
            value = number("theta", theta, "1")
        if abs(value) <= 1:
            return value
    raise ValueError(
        f'theta must be a number between -1 and 1, or a fraction such as "5/6", but is {theta!r}'
    )


def theta_from_load_cells(
    load_a: float, load_b: float, spacing: float, length: float
) -> Fraction:
    """Return theta from two load cells: (F_ZB - F_ZA)/F_Z * L/d (Sect. 5.2).

    The loads [N] are measured at two cells a distance d = `spacing` [m] apart, and are
    extrapolated linearly over the contact length L [m]. For example, 100 N and 300 N,
    measured 60 mm apart on a slider of 100 mm, give exactly 5/6.
    """
    a = Fraction(repr(not_negative("load_a", load_a, "N")))
    b = Fraction(repr(not_negative("load_b", load_b, "N")))
    span = Fraction(repr(length)) / Fraction(repr(positive("spacing", spacing, "m")))
    if a + b == 0:
        raise ValueError("load_a or load_b must be above 0 N, but both are 0 N")
    theta = (b - a) / (a + b) * span
    if abs(theta) > 1:
        raise ValueError(
            f"theta must be between -1 and 1, but load_a = {load_a!r} N and load_b = {load_b!r} N give "
            f"{float(theta):.4g}: the slider would be lifted at one end"
        )
    return theta


def _must_agree(name: str, given: object, *allowed: object) -> None:
    """Refuse an argument that `weights` replace, unless it is omitted, agrees with them
    or is NaN."""
    if given == given and given not in allowed:
        raise ValueError(f"{name} must not be given beside weights, but is {given!r}")


def _weights(values: ArrayLike) -> FloatArray:
    weights = block_array("weights", values, "N")
    if weights.ndim != 1 or not 1 <= weights.size <= MOST_BLOCKS:
        raise ValueError(
            f"weights must be one number [N] per block, at most {MOST_BLOCKS}, but have shape {weights.shape}"
        )
    for i in np.flatnonzero(
        ~((weights == 0) | ((weights >= SMALLEST) & (weights <= LARGEST)))
    )[:1]:
        raise ValueError(
            f"weights must be 0 N, or between {SMALLEST:g} and {LARGEST:g} N, but that of block {i + 1} is "
            f"{float(weights[i])!r} N"
        )
    if not weights.any():
        raise ValueError("one of the weights must be above 0 N, but all are 0 N")
    weights.flags.writeable = False
    return weights
