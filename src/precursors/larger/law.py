"""The law of the settled coefficient: F_X/F_Z at which global slips begin, once
stick-slip repeats.

Lengths are in L, times in L/c with c = sqrt(E S L/M), and forces, without the kinetic
friction that they overcome, in (mu_s - mu_k) F_Z: P is the peak of F_X, and Y(x) the
force in the bar, less the kinetic friction ahead of x. l is l_c (`critical_length`),
W(x) the share of F_Z on 0..x, kappa = K L/(E S), and x = omega t_v below.

*What the next slip needs.* Creep runs away at l: the stretch that creeps carries mu_s w,
the rest what the last slip left. So P = W(l) + Y(l), and Y = P - W(x) up to l.

*What a global slip leaves.* It is half a swing of the bar on its drive in the slowest
mode, q tan q = kappa. The bar has the part b of the elastic energy, and only the bar is
damped and stiffened by its dashpots:

    b = (2q - sin 2q)/(2q + sin 2q),  omega^2 = q^2/[1 - b x^2/(1 + x^2)],
    D = exp[-(pi b/2) x/(1 + x^2)]

D is what is left of the amplitude. The amplitude a at the drive is the part of the mode
in the state at the runaway, and elastic stress follows the total one by t_v Y' + Y:

    a = (1 - b) [P + kappa int sin q(1 - x)/sin q Y dx],    e = exp(-pi/x)
    Y after = -a r sin q(1 - x)/sin q + e Y,                r = (D + e)/(1 + x^2)

*Closed form.* With Y = -d (1 - x) beyond l the next d is linear in d: its fixed point
and its slope follow (`fixed_point`). n precursors refill the deficit up to their fronts,
taken halfway between l and the end, and carry n phi W(l) forward: phi = 1 - exp(-1/t_v),
as stress relaxes for the time L/c in which a front runs half of the bar and the news of
its arrest comes back.

*Fronts.* A steady front needs a force of w/q, where t_v q^2 + 2 q is the fall of
friction with velocity (`need`). One that brings less, P - Y, stops there, and behind it
Y relaxes towards P until the news of that comes back (`event`). So the stress that a
slip leaves decides about the next one: iterated, it gives n, peaks and fronts, and
nothing is counted (`cycle`).

Nothing is fitted. Known errors: at n = 0 the coefficient is too high by 0.0005, as creep
that trembles carries less than mu_s w; errors are larger where load rises towards the
far end, and with K above 2 MN/m at the paper's bar.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from precursors.larger.chain import LargerChain, critical_length
from precursors.model.chain import FloatArray

PAST = 1.1  # of l_c: an event whose front stops before is creep that trembles
PLACES = 200  # along the row
EVENTS = 300  # of a cycle, which has settled by then
SLIPS = 12  # whose mean is that of the cycle: whole periods of 1, 2, 3 and 4
PASTS = np.linspace(0.0, 0.7, 8)  # d from which cycles are sought


class FixedPoint(NamedTuple):
    """Peak of F_X/F_Z that comes again, and the change of a peak over that of the one
    before."""

    coefficient: float
    slope: float


class Cycle(NamedTuple):
    """Mean peak of F_X/F_Z, mean number of precursors between two global slips, and the
    places x/L at which the last ones stopped."""

    coefficient: float
    precursors: float
    fronts: FloatArray


class Law:
    """The law for one chain; its height of the push is left out.

    nucleus is l, drive kappa, lag t_v, memory e, rebound (1 - b) r; at `places` x there
    are load W, shape sin q(1 - x)/sin q, tip 1/q of a front, its need, and the Y at rest
    without strain.

    Raises
    ------
    ValueError
        If the chain is outside the limits within which the law was compared with runs.
    """

    def __init__(self, larger: LargerChain) -> None:
        chain = larger.chain
        self.mu_k = chain.mu_k
        self.drop = chain.mu_s - chain.mu_k
        impedance = math.sqrt(chain.mass * chain.stiffness)
        t_v = larger.relaxation_time + larger.viscosity / chain.stiffness
        self.lag = t_v * chain.stiffness / impedance / chain.n_blocks
        self.drive = chain.drive_stiffness * chain.n_blocks / chain.stiffness
        self.nucleus = critical_length(larger) / chain.length
        if self.nucleus == math.inf:
            raise ValueError(
                "the law of the settled coefficient does not apply: the chain is too "
                "weakly weakening, it has no l_c"
            )
        q = brentq(lambda q: q * math.tan(q) - self.drive, 0.0, 0.5 * math.pi - 1e-12)
        x = q * self.lag
        for name, value, least, most in (
            (
                "linear v_c/V",
                larger.weakening_velocity / chain.drive_velocity,
                3.3,
                math.inf,
            ),
            ("l_c/L", self.nucleus, 3.0 / chain.n_blocks, 0.7),
            ("omega t_v", x, 0.05, 4.0),
            ("K L/(E S)", self.drive, 0.0, 1.3),
        ):
            if not least <= value <= most:
                raise ValueError(
                    f"the law of the settled coefficient does not apply: {name} must be "
                    f"between {least:.2g} and {most:.2g}, but is {value:.2g}"
                )
        double = math.sin(2.0 * q) / (2.0 * q)
        bar = (1.0 - double) / (1.0 + double)
        x /= math.sqrt(1.0 - bar * x**2 / (1.0 + x**2))
        self.memory = math.exp(-math.pi / x)
        decay = math.exp(-0.5 * math.pi * bar * x / (1.0 + x**2))
        self.rebound = (1.0 - bar) * (decay + self.memory) / (1.0 + x**2)
        self.places = (np.arange(PLACES) + 0.5) / PLACES
        ends = np.linspace(0.0, 1.0, chain.n_blocks + 1)
        shares = np.append(0.0, np.cumsum(chain.weights)) / chain.normal_load
        self.load = np.interp(self.places, ends, shares)
        self.nucleus_load = np.interp(self.nucleus, ends, shares)
        self.shape = np.sin(q * (1.0 - self.places)) / math.sin(q)
        weights = np.gradient(self.load, self.places)
        fall = larger.fall * chain.normal_load / impedance * weights
        self.tip = (1.0 + np.sqrt(1.0 + self.lag * fall)) / fall
        self.need = weights * self.tip
        self.rest = (self.load - 1.0) * self.mu_k / self.drop

    def fixed_point(self, precursors: float = 0) -> FixedPoint:
        """Where a cycle with so many precursors between two global slips settles; its
        mean if peaks alternate."""
        ahead = 1.0 - self.nucleus
        refill = -math.expm1(-1.0 / self.lag) / (1.0 - self.memory)
        carried = precursors * refill * self.nucleus_load
        front = self.nucleus + 0.5 * ahead
        left = np.interp(self.nucleus, self.places, self.shape) / ahead

        def swung(d: float) -> float:
            stress = carried * (self.places < front) + d * (self.places - 1.0)
            return float(left * self.swing(*self.runaway(stress)))

        slope = self.memory + swung(1.0) - swung(0.0)
        peak = self.nucleus_load + carried - ahead * swung(0.0) / (1.0 - slope)
        return FixedPoint(self.mu_k + self.drop * peak, slope)

    def runaway(self, stress: FloatArray) -> tuple[float, FloatArray]:
        """P and Y at the runaway that comes next."""
        peak = self.nucleus_load + np.interp(self.nucleus, self.places, stress)
        crept = self.places < self.nucleus
        return float(peak), np.where(crept, peak - self.load, stress)

    def swing(self, peak: float, stress: FloatArray) -> float:
        """a r, which half a swing leaves at the drive."""
        carried = peak + self.drive * (self.shape * stress).mean()
        return float(self.rebound * carried)

    def event(self, stress: FloatArray) -> tuple[float, float, FloatArray]:
        """P of the next event, place x at which its front stops (1: it is a global
        slip), and the Y that it leaves."""
        peak, stress = self.runaway(stress)
        push = peak - stress
        lacks = (push < self.need) & (self.places > PAST * self.nucleus)
        if not lacks.any():
            left = self.memory * stress - self.swing(peak, stress) * self.shape
            return peak, 1.0, left
        front = float(self.places[lacks.argmax()])
        behind = self.places < front
        # Over c: of a steady front by what it brings, and the least that one has.
        speed = np.sqrt(1.0 - self.need / push.clip(self.need))
        speed = speed.clip(np.cbrt(0.5 * self.tip / self.lag))
        passes = behind & (self.places > self.nucleus)
        until_news = np.where(passes, 1.0 + 1.0 / speed, 0.0)[::-1].cumsum()[::-1]
        refill = behind * -np.expm1(-until_news / PLACES / self.lag)
        unloaded = (push * refill).mean() / (1.0 / self.drive + refill.mean())
        return peak, front, stress + (push - unloaded) * refill

    def cycle(self, stress: FloatArray) -> Cycle:
        """Cycle that is reached from a Y."""
        peaks, fronts = np.empty((2, EVENTS))
        for i in range(EVENTS):
            peaks[i], fronts[i], stress = self.event(stress)
        slips = np.flatnonzero(fronts == 1.0)[-SLIPS - 1 :]
        return Cycle(
            coefficient=self.mu_k + self.drop * float(peaks[slips[1:]].mean()),
            precursors=float(np.diff(slips).mean()) - 1.0,
            fronts=fronts[slips[-2] + 1 : slips[-1]],
        )

    @property
    def possible(self) -> list[float]:
        """Numbers of precursors in the cycles that are reached from `rest` and `PASTS`."""
        pasts = [self.rest, *(d * (self.places - 1.0) for d in PASTS)]
        return sorted({round(self.cycle(past).precursors, 2) for past in pasts})
