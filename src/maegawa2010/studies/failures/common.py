"""The curves that show a failure mode."""

from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike


@dataclass(frozen=True)
class Curve:
    """A curve of a failure mode: name, points and role.

    The role says whether the curve is measured with the failing method, exact, predicted
    by theory, or a reference. A predicted curve has the name of the failing one.
    """

    name: str
    x: ArrayLike
    y: ArrayLike
    role: Literal["failing", "exact", "theory", "reference"] = "failing"
