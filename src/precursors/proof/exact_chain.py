"""The chain of blocks with exact rational parameters, so that 5/6 is not rounded."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from numbers import Rational, Real

import numpy as np

from precursors.model.chain import ARGUMENTS, SLIDER, Chain

Number = Fraction | int | float | str

_PAPERS_SLIDER = {
    name: value for name, value in SLIDER.items() if isinstance(value, float)
}
_NUMBERS = ARGUMENTS[1:]  # all but the weights


@dataclass(frozen=True)
class ExactChain:
    """The parameters of the equations of motion (Eqs. 2-6) as fractions; fields and
    units as in `Chain`.

    Raises
    ------
    ValueError
        As for `Chain`; the message names the parameter.
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
        object.__setattr__(
            self, "weights", tuple(exact("weights", w) for w in self.weights)
        )
        for name in _NUMBERS:
            object.__setattr__(self, name, exact(name, getattr(self, name)))
        self.to_chain()

    @classmethod
    def from_slider(cls, n_blocks: int = 10, **changes: Number) -> ExactChain:
        """Cut a slider into N equal blocks (Eqs. 7, 9, 10) as `Chain.from_slider` does,
        without rounding.

        Numbers are read as written: 0.7 and Fraction(7, 10) are the same, and theta may
        be "5/6".
        """
        slider = {
            name: exact(name, x) for name, x in (_PAPERS_SLIDER | changes).items()
        }
        Chain.from_slider(n_blocks, **{name: float(x) for name, x in slider.items()})
        n = n_blocks
        load = slider["normal_load"]
        extent = slider["length"]
        # For N = 1, Eq. 7 is 0/0; the block carries the whole load.
        offsets = (Fraction(2 * i - n - 1, max(n - 1, 1)) for i in range(1, n + 1))
        return cls(
            weights=tuple(load / n * (1 + x * slider["theta"]) for x in offsets),
            mass=slider["slider_mass"] / n,
            stiffness=n * slider["youngs_modulus"] * slider["cross_section"] / extent,
            drive_stiffness=slider["drive_stiffness"],
            drive_velocity=slider["drive_velocity"],
            mu_s=slider["mu_s"],
            mu_k=slider["mu_k"],
            length=extent,
        )

    @classmethod
    def from_chain(cls, chain: Chain) -> ExactChain:
        """Make an exact chain from the exact values of the doubles of a chain."""
        numbers = {name: Fraction(getattr(chain, name)) for name in _NUMBERS}
        return cls(weights=tuple(Fraction(float(w)) for w in chain.weights), **numbers)

    def to_chain(self) -> Chain:
        """Round every number once, for the solver in double precision."""
        return Chain(
            weights=np.array([float(w) for w in self.weights]),
            **{name: float(getattr(self, name)) for name in _NUMBERS},
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
        """Return every number as a fraction in a string, so that
        `ExactChain(**chain.as_text())` equals the chain."""
        text: dict[str, str | list[str]] = {
            name: str(getattr(self, name)) for name in _NUMBERS
        }
        return {"weights": [str(w) for w in self.weights], **text}


def written_fraction(text: str) -> Fraction:
    """Read a decimal or a fraction exactly.

    Raises
    ------
    ValueError, ZeroDivisionError
        If the text is not such a number.
    """
    if re.search(r"[eE][-+]?[\d_]{4}", text):
        raise ValueError(
            f"{text!r} has an exponent of four digits"
        )  # 10**exponent would be written out
    return Fraction(text)


def exact(name: str, value: object) -> Fraction:
    """Return a number exactly as written: a fraction, a decimal in a string, or a float
    as Python prints it.

    Raises
    ------
    ValueError
        If it is none of these, or not finite.
    """
    try:
        if isinstance(value, str):
            return written_fraction(value)
        if isinstance(value, Rational):
            return Fraction(value)
        if isinstance(value, Real):
            return Fraction(repr(float(value)))
    except (ValueError, ZeroDivisionError):
        pass
    raise ValueError(
        f'{name} must be a finite number, or one in quotes such as "5/6", but is {value!r}'
    )


def as_decimal(x: Fraction, context: Context) -> Decimal:
    """Return a fraction as a decimal number, rounded in the given context."""
    return context.divide(Decimal(x.numerator), Decimal(x.denominator))


def exact_start(
    name: str, chain: ExactChain, values: Sequence[Number] | None, unit: str
) -> tuple[Fraction, ...]:
    """Return N start positions or velocities; zero if none are given."""
    if values is None:
        return (Fraction(0),) * chain.n_blocks
    if len(values) != chain.n_blocks:
        raise ValueError(
            f"{name} must have one value [{unit}] for each of the {chain.n_blocks} blocks, "
            f"but has {len(values)}"
        )
    return tuple(exact(name, x) for x in values)
