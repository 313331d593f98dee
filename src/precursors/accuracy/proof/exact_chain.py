"""The chain of blocks in exact rational numbers: 5/6 is 5/6."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from fractions import Fraction
from numbers import Real
from typing import Any

import numpy as np

from precursors.model.chain import Chain, require_plain, whole, written_fraction
from precursors.model.scene_models import PAPERS_MODEL
from precursors.model.scenes import scene_as_written, scene_model

Number = Fraction | int | float | str


@dataclass(frozen=True)
class ExactChain:
    """What the equations of motion hold (Eqs. 2-6), each a fraction; fields and units as in `Chain`.

    Raises
    ------
    ValueError
        Naming the parameter, its value, its unit and the allowed range.
    """

    weights: tuple[Fraction, ...]
    mass: Fraction
    stiffness: Fraction
    drive_stiffness: Fraction
    drive_velocity: Fraction
    mu_s: Fraction
    mu_k: Fraction
    length: Fraction

    def __post_init__(self) -> None:
        object.__setattr__(self, "weights", tuple(exact("weights", w, "N") for w in self.weights))
        for i, w in enumerate(self.weights):
            if w < 0:
                raise ValueError(f"weights: block {i + 1} has {w} N: allowed is w >= 0 N")
        if not any(self.weights):
            raise ValueError("weights are all zero: allowed is a total normal load above 0 N")
        for name, unit in _UNITS.items():
            value = exact(name, getattr(self, name), unit)
            object.__setattr__(self, name, value)
            if value < 0 or (value == 0 and unit != "1"):
                allowed = f"{name} >= 0" if unit == "1" else f"{name} > 0"
                raise ValueError(f"{name} = {value} [{unit}] is out of range: allowed is {allowed}")
        if self.mu_k > self.mu_s:
            raise ValueError(f"mu_k = {self.mu_k} is larger than mu_s = {self.mu_s}: allowed is mu_k <= mu_s")

    @classmethod
    def from_slider(
        cls,
        n_blocks: int = 10,
        theta: Number = 0,
        normal_load: Number = 400,
        mu_s: Number = "0.70",
        mu_k: Number = "0.45",
        drive_stiffness: Number = "0.8e6",
        drive_velocity: Number = "1e-4",
        slider_mass: Number = "0.012",
        youngs_modulus: Number = "2.5e9",
        cross_section: Number = "1e-4",
        length: Number = "0.1",
    ) -> ExactChain:
        """Cut a slider into N equal blocks (Eqs. 7, 9, 10) as `Chain.from_slider` does, without rounding.

        Numbers are taken as they are written: 0.7 and Fraction(7, 10) are the same, theta may be "5/6".
        """
        n = whole("n_blocks", n_blocks, at_least=1)
        slope, load = exact("theta", theta, "1"), exact("normal_load", normal_load, "N")
        if abs(slope) > 1:
            raise ValueError(f"theta = {theta!r} [1] is out of range: allowed is -1 <= theta <= 1")
        extent = exact("length", length, "m")
        if extent <= 0:
            raise ValueError(f"length = {length!r} [m] is out of range: allowed is length > 0")
        # At N = 1 Eq. 7 is 0/0; the one block carries the whole load.
        offsets = [Fraction(2 * i - n - 1, n - 1) if n > 1 else Fraction(0) for i in range(1, n + 1)]
        modulus, area = (
            exact("youngs_modulus", youngs_modulus, "Pa"),
            exact("cross_section", cross_section, "m^2"),
        )
        return cls(
            weights=tuple(load / n * (1 + offset * slope) for offset in offsets),
            mass=exact("slider_mass", slider_mass, "kg") / n,
            stiffness=n * modulus * area / extent,
            drive_stiffness=exact("drive_stiffness", drive_stiffness, "N/m"),
            drive_velocity=exact("drive_velocity", drive_velocity, "m/s"),
            mu_s=exact("mu_s", mu_s, "1"),
            mu_k=exact("mu_k", mu_k, "1"),
            length=extent,
        )

    @classmethod
    def from_chain(cls, chain: Chain) -> ExactChain:
        """Take the doubles of a chain for exactly what they are.

        Raises
        ------
        ValueError
            If the chain has viscosity, interface springs or a head.
        """
        require_plain(chain)
        numbers = {name: Fraction(getattr(chain, name)) for name in _UNITS}
        return cls(weights=tuple(Fraction(float(w)) for w in chain.weights), **numbers)

    def to_chain(self) -> Chain:
        """Round every number once, to the chain that the solver in double precision is given."""
        return Chain(
            weights=np.array([float(w) for w in self.weights]),
            **{name: float(getattr(self, name)) for name in _UNITS},
        )

    @property
    def n_blocks(self) -> int:
        """Number N of blocks."""
        return len(self.weights)

    @property
    def springs(self) -> tuple[Fraction, ...]:
        """Stiffness of the spring behind each block [N/m]: K, k, k, ..."""
        return (self.drive_stiffness, *[self.stiffness] * (self.n_blocks - 1))

    def as_text(self) -> dict[str, str | list[str]]:
        """Every number as a fraction in a string."""
        text: dict[str, str | list[str]] = {name: str(getattr(self, name)) for name in _UNITS}
        return {"weights": [str(w) for w in self.weights], **text}

    @classmethod
    def from_text(cls, text: Mapping[str, Any]) -> ExactChain:
        """Read what `as_text` wrote."""
        if set(text) != {f.name for f in fields(cls)}:
            raise ValueError(
                f"chain has {', '.join(text)}: needed are {', '.join(f.name for f in fields(cls))}"
            )
        return cls(tuple(text["weights"]), **{name: text[name] for name in _UNITS})


_UNITS = {
    "mass": "kg",
    "stiffness": "N/m",
    "drive_stiffness": "N/m",
    "drive_velocity": "m/s",
    "mu_s": "1",
    "mu_k": "1",
    "length": "m",
}


def exact(name: str, value: object, unit: str) -> Fraction:
    """Return a number as it is written: a fraction, a decimal in a string, or a float as Python prints it.

    Raises
    ------
    ValueError
        If it is none of these, or not finite.
    """
    try:
        if isinstance(value, bool):
            raise ValueError
        if isinstance(value, str):
            return written_fraction(value)
        if isinstance(value, Fraction | int):
            return Fraction(value)
        if isinstance(value, Real):
            return Fraction(repr(float(value)))
    except (ValueError, ZeroDivisionError, OverflowError):
        pass
    raise ValueError(f'{name} = {value!r} [{unit}] is not a number: allowed is a finite one, or one as "5/6"')


def scene_exact_chain(config: Mapping[str, Any], name: str) -> ExactChain:
    """Return the chain of a scene of the configuration; theta from load cells is not rounded (Sect. 5.2).

    Raises
    ------
    ValueError
        If the scene's model is another than the paper's chain.
    """
    model = scene_model(config, name)
    if model != PAPERS_MODEL:
        raise ValueError(f"scenes.{name}.model = {model!r}: proofs are of the model {PAPERS_MODEL!r} alone")
    return ExactChain.from_slider(**scene_as_written(config, name))


def exact_positions(chain: ExactChain, positions: Sequence[Number] | None) -> tuple[Fraction, ...]:
    """Return N start positions [m]; zero, springs at natural length, if none are given."""
    if positions is None:
        return (Fraction(0),) * chain.n_blocks
    if len(positions) != chain.n_blocks:
        raise ValueError(
            f"start_positions hold {len(positions)} values: allowed is one [m] a block, N = {chain.n_blocks}"
        )
    return tuple(exact("start_positions", x, "m") for x in positions)
