"""Prove which event function has the first root, for every run within the enclosure.

An event function is positive while its block keeps its state: mode * velocity of a
sliding block, mu_s w -+ net force of a stuck one. The balls of its polynomials are wide
enough to enclose every run of the model, so that a proof holds for all of them.
"""

import math
from dataclasses import dataclass

from flint import arb, arb_poly, ctx

from precursors.model.chain import FREE
from precursors.proof.motion import Constants, EnclosedState, expand, force_rate

# Longest step, and time up to which polynomials hold, in the unit T of `motion`.
WINDOW = 1.0
VALID = 1.125


class Undecided(Exception):
    """A question about some blocks cannot be decided: more bits are needed, or there is
    a tie.

    The ball `time` encloses the time of the question: in T from the start of the step,
    or in s once the proof has stopped.
    """

    def __init__(self, question: str, blocks: tuple[int, ...], time: arb) -> None:
        super().__init__(question)
        self.question = question
        self.blocks = blocks
        self.time = time


@dataclass(frozen=True, eq=False)
class EventFunction:
    """A function of time [T] that is positive until its block 1..N changes its state.

    `direction` is 0 for the velocity of a sliding block, and +1 or -1 for a stuck
    block's margin in that direction. `value`, `slope` and `bend` enclose the function
    and its first two derivatives in every run. A `fresh` function is zero at the
    transition at the start, where its slope is not negative.
    """

    block: int
    direction: int
    fresh: bool
    value: arb_poly
    slope: arb_poly
    bend: arb_poly

    @property
    def what(self) -> str:
        """The change at the root, as part of a question."""
        change = {0: "stops", 1: "is released forward", -1: "is released backward"}
        return f"block {self.block} {change[self.direction]}"


def event_functions(
    constants: Constants, state: EnclosedState, fresh: set[int], bits: int
) -> list[EventFunction]:
    """Return the event functions, valid up to `VALID`: velocities of the sliding blocks,
    and margins of those stuck blocks whose net force changes.

    `fresh` are the blocks that have just begun to slide.
    """
    polynomials, rests = expand(constants, state, VALID, bits)
    # Twice the distance leaves room to move the centre onto the exact condition of a
    # transition.
    distance = 2 * state.distance
    functions = []
    for i in range(1, len(state.mode) - 1):
        reach = constants.force_reach[i] * distance
        rate_reach = constants.force_rate_reach[i] * distance
        mode = state.mode[i]
        if mode == FREE:
            continue
        if mode:
            function = mode * polynomials[i]
            curves = []
            for off, rest in zip((distance, reach, rate_reach), rests, strict=True):
                curves.append(function + arb(0, off + rest))
                function = function.derivative()
            functions.append(EventFunction(i, 0, i in fresh, *curves))
        elif i == 1 or state.mode[i - 1] or state.mode[i + 1]:
            around = arb(0, constants.frequency_squared * rests[0])
            rate = force_rate(constants, polynomials, i) + around
            force = rate.integral() + (state.net_force(i) + arb(0, reach))
            rate += arb(0, rate_reach)
            for way in (1, -1):
                margin = constants.strength[i] - way * force
                functions.append(
                    EventFunction(i, way, i in fresh, margin, -way * rate, arb_poly([]))
                )
    return functions


def first_crossing(
    functions: list[EventFunction], back: arb
) -> tuple[EventFunction, arb] | None:
    """Return the function that crosses zero first and an enclosure of its root, or None
    if none crosses zero in the window.

    A run may have made the transition at the start up to `back` [T] before zero.

    Raises
    ------
    Undecided
        If two roots overlap, or the sign of a function cannot be decided.
    """
    roots: list[tuple[arb, EventFunction]] = []
    end = WINDOW
    for function in functions:
        root = _crossing(function, end, back)
        if root is not None:
            roots.append((root, function))
            end = min(end, math.nextafter(float(root.upper()), math.inf))
    if not roots:
        return None
    root, first = min(
        roots, key=lambda pair: pair[0]
    )  # the earliest, unless two overlap
    for other, function in roots:
        if function is not first and other.overlaps(root):
            question = f"whether first {first.what} or {function.what}"
            raise Undecided(question, (first.block, function.block), root.union(other))
    return first, root


def _crossing(function: EventFunction, end: float, back: arb) -> arb | None:
    """Return the first root of a function up to `end`, or None if it is proved
    positive."""
    smallest = arb(2) ** -(ctx.prec // 2 + 8)
    pieces = [(arb(0), arb(end), True)]
    while pieces:
        a, b, at_start = pieces.pop()
        half = (b - a) / 2
        middle = a + half
        # The first piece must hold for runs that are ahead or behind by `back`.
        reach = (half + back).abs_upper() if at_start else half
        box = arb(middle, reach)
        slope = function.slope(box)
        if function.value(middle) - reach * slope.abs_upper() > 0:
            continue
        falling = slope < 0
        if falling and function.value(b) > 0:
            continue
        if not at_start and slope > 0 and function.value(a) > 0:
            continue
        if function.fresh and at_start and (slope > 0 or function.bend(box) > 0):
            continue
        if falling:
            root = _falling_root(function, a, b)
            if root is not None:
                if at_start and not root > back:
                    raise Undecided(f"whether {function.what}", (function.block,), root)
                return root
        if half < smallest:
            raise Undecided(f"whether {function.what}", (function.block,), box)
        pieces += [(middle, b, False), (a, middle, at_start)]
    return None


def _falling_root(function: EventFunction, a: arb, b: arb) -> arb | None:
    """Enclose the root of a function that falls on [a, b]; a root near b may lie a little
    beyond."""
    if not function.value(b) < 0:
        b = b + (b - a)
        if not (
            b <= VALID and function.slope(a.union(b)) < 0 and function.value(b) < 0
        ):
            return None
    root = a.union(b)
    while True:
        middle = root.mid()
        closer = middle - function.value(middle) / function.slope(root)
        if not closer.overlaps(root):
            return None
        closer = closer.intersection(root)
        if not closer.rad() < root.rad():
            return closer
        root = closer


def newton(function: arb_poly, root: arb) -> arb:
    """Return an exact number near the root, to about the working precision.

    The caller counts the remaining error as distance.
    """
    slope = function.derivative()
    x = root.mid()
    bits = ctx.prec
    good = 24
    while good < bits:
        good = min(2 * good, bits)
        with ctx.workprec(good + 16):
            x = (x - function(x) / slope(x)).mid()
    return x
