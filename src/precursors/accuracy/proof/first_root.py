"""The first root among gauges: which of them crosses zero first, proved for every run within reach.

A gauge is positive while its block keeps its state: mode * velocity of a sliding block, mu_s w -+ net force
of a stuck one. Its polynomials are balls wide enough for every run of the model: a proof holds for all.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, arb_poly

GRID = 40


class Undecided(Exception):
    """A question about some blocks that cannot be decided, between two times [T] as a ball."""

    def __init__(self, question: str, between: arb, blocks: tuple[int, ...]) -> None:
        super().__init__(question)
        self.question, self.between, self.blocks = question, between, blocks


@dataclass(frozen=True, eq=False)
class Gauge:
    """A function of time [T] that is positive until its block changes its state.

    Attributes
    ----------
    block : int
        Block 1..N.
    direction : int
        0 for the velocity of a sliding block; +1 or -1 for a stuck block's margin in that direction.
    value, slope, bend : arb_poly
        The function and its first two derivatives, enclosing those of every run.
    fresh : bool
        Zero at the transition at the start, with a slope that is not negative.
    """

    block: int
    direction: int
    value: arb_poly
    slope: arb_poly
    bend: arb_poly
    fresh: bool

    @property
    def event(self) -> str:
        """What happens at the root."""
        what = {0: "stops", 1: "is released forward", -1: "is released backward"}
        return f"block {self.block} {what[self.direction]}"


def first_root(
    gauges: list[Gauge], horizon: float, valid: float, back: arb, bits: int
) -> tuple[Gauge, arb] | None:
    """Return the gauge that crosses zero first and an enclosure of its root; None if none does by `horizon`.

    Parameters
    ----------
    gauges : list of Gauge
        All gauges.
    horizon, valid : float
        Times [T] to search, and up to which the polynomials hold.
    back : arb
        Time [T] before zero at which a run may have had the transition at the start.
    bits : int
        Working precision.

    Raises
    ------
    Undecided
        If two roots overlap, or the sign of a gauge cannot be decided.
    """
    found: list[tuple[arb, Gauge]] = []
    for gauge in gauges:
        root = _crossing(gauge, horizon, valid, back, bits)
        if root is not None:
            found.append((root, gauge))
            # rounded up to a short binary number, so that halving stays exact
            horizon = min(horizon, (int(float(root.upper()) * 2**GRID) + 2) / 2**GRID)
    if not found:
        return None
    root, first = found[0]
    for other, gauge in found:
        if other < root:
            root, first = other, gauge
    for other, gauge in found:
        if gauge is not first and not other > root:
            question = f"whether first {first.event} or {gauge.event}"
            raise Undecided(question, root.union(other), (first.block, gauge.block))
    return first, root


def _crossing(gauge: Gauge, horizon: float, valid: float, back: arb, bits: int) -> arb | None:
    """First root of a gauge up to `horizon`, or None once it is proved positive."""
    smallest = arb(2) ** -(bits // 2 + 8)
    pieces = [(arb(0), arb(horizon), True)]
    while pieces:
        a, b, at_start = pieces.pop()
        half = (b - a) / 2
        middle = a + half
        # At the start a run may be ahead or behind by `back`.
        reach = (half + back).abs_upper() if at_start else half
        box = arb(middle, reach)
        slope = gauge.slope(box)
        if gauge.value(middle) - reach * slope.abs_upper() > 0:
            continue
        falling = slope < 0
        if falling and gauge.value(b) > 0:
            continue
        if not at_start and slope > 0 and gauge.value(a) > 0:
            continue
        if gauge.fresh and at_start and (slope > 0 or gauge.bend(box) > 0):
            continue
        if falling:
            root = _falling_root(gauge, a, b, valid)
            if root is not None:
                if at_start and not root > back:
                    raise Undecided(f"whether {gauge.event}", root, (gauge.block,))
                return root
        if half < smallest:
            raise Undecided(f"whether {gauge.event}", box, (gauge.block,))
        pieces += [(middle, b, False), (a, middle, at_start)]
    return None


def _falling_root(gauge: Gauge, a: arb, b: arb, valid: float) -> arb | None:
    """Enclose the root of a gauge that falls on [a, b], where a root next to b may lie a little beyond."""
    if not gauge.value(b) < 0:
        b = b + (b - a)
        if not (b <= valid and gauge.slope(a.union(b)) < 0 and gauge.value(b) < 0):
            return None
    root = a.union(b)
    while True:
        middle = root.mid()
        closer = middle - gauge.value(middle) / gauge.slope(root)
        if not closer.overlaps(root):
            return None
        closer = closer.intersection(root)
        if not closer.rad() * 2 < root.rad():
            return closer
        root = closer
