"""The curves of which failure modes consist."""

from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike


@dataclass(frozen=True)
class Curve:
    """A curve of a failure mode: name, points and role.

    The role says whether it is measured with the failing method, exact, predicted by
    theory (then it has the name of the failing curve), or a reference to compare with.
    """

    name: str
    x: ArrayLike
    y: ArrayLike
    role: Literal["failing", "exact", "theory", "reference"] = "failing"
