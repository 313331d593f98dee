"""The proof: a tube of balls that encloses every run of the model, transition by
transition.

The state is an exact centre and a distance (see `motion`). Let e be the difference of
two runs, and f the friction. Then d|e|^2/dt = -2 sum e_{u_i} e_{f_i}. The distance is
therefore constant while both runs have the same modes. They make a transition at
different instants, which changes the distance as follows.

- A block stops: in one run it is at u = 0, with friction equal to its net force F. In
  the other it still slides with mode * u > 0 against mu_k w. It was slowing down, so
  that mode * F < mu_k w, and the distance does not grow.
- A block turns round: friction opposes the difference of the velocities, and the
  distance does not grow.
- A block is released: during the time `gap` between the two releases, one run slides
  against mu_k w and the other is held by at most mu_s w. |e|^2 grows by at most ((mu_s -
  mu_k) w gap)^2. Only releases drive runs apart.
- While all blocks rest, the next release depends on the forces alone. Each run is then
  compared at its own onset, where T_1 = T_2 + mu_s w_1, and the distance grows at most
  by the factor sqrt(1 + c_2 / c_1).

At a transition the centre is moved onto the exact condition (u = 0, or F = +-mu_s w).
The other runs fulfil it within +-gap of that instant. A late run is continued backward
in its new modes to the instant of the centre; an early run has its new modes before
that instant. Event functions are therefore proved from -gap on.
"""

from fractions import Fraction
from itertools import compress, pairwise
from operator import mul
from typing import NamedTuple

from flint import arb, ctx

from precursors.model.chain import FREE
from precursors.proof.certificate import Certificate
from precursors.proof.event_roots import (
    WINDOW,
    EventFunction,
    Undecided,
    event_functions,
    first_crossing,
    newton,
)
from precursors.proof.motion import (
    BOUND_BITS,
    Constants,
    EnclosedState,
    advance,
    ball,
    bordered,
    expand,
    force_rate,
    log2,
    time_unit,
)
from precursors.support.waiting import bar

# Rounding stays this many bits below the distance of the runs.
GUARD_BITS = 40
# Precisions are multiples of this, so that constants can be reused.
PRECISION_STEP = 32


class Proved(NamedTuple):
    """A proved transition in balls, with the units and the `slope` of
    `CertifiedTransition`."""

    time: arb
    block: int
    mode: int
    tangential_load: arb
    slope: arb


class Proof:
    """The motion of a certificate's chain from its start, in balls, and the transitions
    proved so far."""

    def __init__(self, certificate: Certificate) -> None:
        self.chain = certificate.chain
        self.bears_load = self.chain.to_chain().bears_load
        self.bits = certificate.bits
        self.until = certificate.until
        self.unit_seconds = time_unit(self.chain)
        self.transitions: list[Proved] = []
        self._constants: dict[int, Constants] = {}
        with ctx.workprec(self.bits + GUARD_BITS):
            self.unit = ball(self.unit_seconds)
            self.duration = ball(certificate.duration)
            self.width = ball(certificate.width)
            self.clock = arb(0)
            self.state = self.at_start(
                certificate.start_positions, certificate.start_velocities
            )
        with ctx.workprec(BOUND_BITS):
            self.bounds = self.constants()
        # Largest time by which a run is ahead or behind at the last transition [T], and
        # the blocks that have just begun to slide.
        self.gap = arb(0)
        self.fresh = {
            i
            for i, v in enumerate(certificate.start_velocities, 1)
            if self.state.mode[i] in (1, -1) and not v
        }
        self.all_slid = False

    def at_start(
        self, positions: tuple[Fraction, ...], velocities: tuple[Fraction, ...]
    ) -> EnclosedState:
        """Return the state for given positions and velocities.

        A block slides if it moves or if its net force exceeds its strength.
        """
        chain = self.chain
        compressions = (a - b for a, b in pairwise((Fraction(0), *positions)))
        exact = bordered(map(mul, chain.springs, compressions))
        rate = bordered(v * chain.mass / self.unit_seconds for v in velocities)
        constants = self.constants()
        least_distance = arb(2) ** (
            log2(max(constants.strength, key=float)) - self.bits
        )
        state = EnclosedState([], [], [0] * len(rate), least_distance)
        state.absorb(constants, [ball(f) for f in exact], [ball(u) for u in rate])
        for i, weight in enumerate(chain.weights, 1):
            force = exact[i] - exact[i + 1]
            push = rate[i] or (force if abs(force) > chain.mu_s * weight else 0)
            if weight == 0:
                state.mode[i] = FREE if push or i == 1 else 0
            elif push:
                state.mode[i] = 1 if push > 0 else -1
                self.transitions.append(
                    Proved(arb(0), i, state.mode[i], ball(exact[1]), arb(0))
                )
        self.free_neighbours(state)
        return state

    def free_neighbours(self, state: EnclosedState) -> None:
        """Let a block without load move once a neighbour moves."""
        blocks = range(1, self.chain.n_blocks + 1)
        for i in (*blocks, *reversed(blocks)):
            if self.chain.weights[i - 1] == 0 and any(state.mode[i - 1 : i + 2]):
                state.mode[i] = FREE

    def constants(self) -> Constants:
        """Return the chain in balls of the working precision."""
        if ctx.prec not in self._constants:
            self._constants[ctx.prec] = Constants.of(self.chain, self.unit_seconds)
        return self._constants[ctx.prec]

    def run(self) -> list[Proved]:
        """Prove all transitions up to the duration.

        Raises
        ------
        Undecided
            If the precision is too low or there is a tie. Its time is in s, and
            `transitions` has what is proved.
        """
        with bar("proving", float(self.duration.mid())) as progress:
            while self.step():
                progress.update(float(self.clock.mid()) - progress.n)
        return self.transitions

    def step(self) -> bool:
        """Prove the next step; return False at the end of the run."""
        slides = [*compress(self.state.mode[1:-1], self.bears_load)]
        self.all_slid = self.all_slid or all(slides)
        if not any(slides):
            if self.until and self.all_slid:
                return False
            self.all_slid = False
        try:
            return self.slide() if any(self.state.mode) else self.load()
        except Undecided as undecided:
            with ctx.workprec(self.bits + GUARD_BITS):
                undecided.time = self.clock + self.unit * undecided.time
            raise

    def load(self) -> bool:
        """Load the resting chain until block 1, the only one that the drive pushes, is
        released."""
        state = self.state
        with ctx.workprec(self.precision()):
            constants = self.constants()
            loading_rate = constants.coupling[1] * constants.drive
            lacking = constants.strength[1] - state.net_force(1)
            step = (
                lacking + arb(0, state.distance * self.bounds.force_reach[1])
            ) / loading_rate
            if self.transitions and not step > self.gap:
                raise Undecided("whether block 1 is released at once", (1,), step)
            force = list(state.force)
            force[1] = constants.strength[1] + force[2]
            growth = 1 + self.bounds.coupling[2] / self.bounds.coupling[1]
            with ctx.workprec(BOUND_BITS):
                state.distance = (state.distance * growth.sqrt()).abs_upper()
            state.absorb(constants, force, state.rate)
            self.clock += self.unit * step
            self.gap = arb(0)
            slope = loading_rate / self.unit
        state.mode[1] = 1
        self.free_neighbours(state)
        self.fresh = {1}
        return self.record(1, slope)

    def slide(self) -> bool:
        """Advance to the next transition, but at most by one window."""
        first = self.first_transition()
        if first is None:
            return self.advance_window(WINDOW)
        event, root = first
        if root.upper() > WINDOW:
            # The other functions are only proved up to the end of the window, where
            # this root is: stop before it.
            return self.advance_window(WINDOW / 2)
        steepness = self.change(event, root)
        # u = m v / T, so that the rate of a velocity is that of u [N/T] over the mass.
        unit = self.unit if event.direction else ball(self.chain.mass)
        return self.record(event.block, steepness / unit)

    def first_transition(self) -> tuple[EventFunction, arb] | None:
        """Return the first root of all event functions, with a precision that is raised
        until it suffices."""
        bits = BOUND_BITS
        while True:
            with ctx.workprec(bits):
                try:
                    constants = self.constants()
                    functions = event_functions(constants, self.state, self.fresh, bits)
                    return first_crossing(functions, self.gap)
                except Undecided:
                    if bits >= self.precision():
                        raise
            bits *= 2

    def advance_window(self, step: float) -> bool:
        """Advance without a transition."""
        with ctx.workprec(self.precision()):
            constants = self.constants()
            polynomials, rests = expand(constants, self.state, step, ctx.prec)
            advance(constants, self.state, polynomials, rests[0], arb(step))
            self.clock += self.unit * step
            self.gap = arb(0)
            self.fresh = set()
            return not self.clock > self.duration

    def change(self, event: EventFunction, root: arb) -> arb:
        """Advance to the root of an event function and change the state of its block.

        Return the least downward slope of the function [N/T] in any run.
        """
        state = self.state
        i = event.block
        before = state.distance
        with ctx.workprec(self.precision()):
            constants = self.constants()
            polynomials, rests = expand(constants, state, root.upper(), ctx.prec)
            if event.direction:
                force = force_rate(
                    constants, polynomials, i
                ).integral() + state.net_force(i)
                function = constants.strength[i] - event.direction * force
            else:
                function = state.mode[i] * polynomials[i]
            step = newton(function, root)
            advance(constants, state, polynomials, rests[0], step)
            forces = list(state.force)
            rates = list(state.rate)
            if event.direction:
                # F = +-mu_s w: adjust the spring behind the block.
                required = event.direction * constants.strength[i] + forces[i + 1]
                state.distance += (
                    required - forces[i]
                ).abs_upper() / self.bounds.coupling[i].sqrt()
                forces[i] = required
            else:
                state.distance += rates[i].abs_upper()
                rates[i] = arb(0)
            state.absorb(constants, forces, rates)
            self.clock += self.unit * step
        with ctx.workprec(BOUND_BITS):
            undecided = Undecided(f"whether {event.what}", (i,), root - step)
            if not state.distance < 2 * before or not root.contains(step):
                raise undecided
            steepness = event.slope(root).abs_lower()
            reach = self.bounds.force_reach[i] if event.direction else arb(1)
            self.gap = (state.distance * reach / steepness).abs_upper()
            if not self.gap < 1:
                raise undecided
            if event.direction:
                self.release(i, event.direction)
            else:
                self.stop(i)
        return steepness

    def release(self, i: int, way: int) -> None:
        """Let the stuck block i slide in direction `way`; only this drives runs apart."""
        state = self.state
        bounds = self.bounds
        excess = (
            bounds.strength[i]
            - bounds.friction[i]
            + state.largest_force_change(bounds, self.gap)
        )
        state.distance = (
            (state.distance**2 + (excess * self.gap) ** 2).sqrt().abs_upper()
        )
        state.mode[i] = way
        self.free_neighbours(state)
        self.fresh = {i}

    def stop(self, i: int) -> None:
        """Let block i, whose velocity is zero, stick if friction can hold it, or else turn
        round."""
        state = self.state
        bounds = self.bounds
        spread = state.distance * bounds.force_reach[i] + state.largest_force_change(
            bounds, self.gap
        )
        force = state.net_force(i) + arb(0, spread)
        slows_down = state.mode[i] * force < bounds.friction[i]
        if slows_down and abs(force) < bounds.strength[i]:
            state.mode[i] = 0
            self.fresh = set()
        elif -state.mode[i] * force > bounds.strength[i]:
            state.mode[i] = -state.mode[i]
            self.fresh = {i}
        else:
            question = f"whether block {i} sticks or turns round"
            raise Undecided(question, (i,), arb(0, self.gap))

    def record(self, i: int, slope: arb) -> bool:
        """Record the transition that block i has just made; return False if it is after
        the duration."""
        state = self.state
        with ctx.workprec(self.bits + GUARD_BITS):
            time = self.clock + self.unit * arb(0, self.gap)
            if time > self.duration:
                return False
            if not time <= self.duration:
                question = f"whether block {i} changes its state before the run ends"
                raise Undecided(question, (i,), arb(0, self.gap))
            if not time.rad() < self.width:
                raise Undecided(
                    "enclosures have become wider than asked for",
                    (i,),
                    arb(0, self.gap),
                )
            change = state.largest_force_change(self.bounds, self.gap)
            reach = state.distance * self.bounds.coupling[1].sqrt() + change
            load = state.force[1] + arb(0, reach)
            self.transitions.append(Proved(time, i, state.mode[i], load, slope))
        return True

    def precision(self) -> int:
        """Return the bits that keep rounding well below the distance, which grows during
        the run."""
        largest = max(
            log2(x)
            for x in (
                *self.bounds.strength,
                *self.state.force,
                *self.state.rate,
                arb(1),
            )
            if x != 0
        )
        bits = max(
            BOUND_BITS, min(largest - log2(self.state.distance), self.bits) + GUARD_BITS
        )
        return bits + -bits % PRECISION_STEP
