"""The law of the settled coefficient: F_X/F_Z at which global slips begin, once
stick-slip repeats.

Lengths are in L, l is l_c (`critical_length`), W(l) the share of F_Z on 0..l, and n the
number of precursors between two global slips:

    peak_n = mu_k + (1 + n phi) (mu_s - mu_k) W(l) / [1 + r (1 - l)]

*What a slip leaves (r, derived).* A global slip is half a swing of the slider on its
drive, at the bar's slowest frequency omega: q tan q = K L/(E S), omega = q c/L, c =
sqrt(E S L/M). The slider then moves nearly as one body, so the force per length that
decelerates it is even along the row, and it swings from (peak - mu_k) F_Z to minus as
much. The elastic stress follows the total one with the lag t_v:

    t_v s' + s = cos(omega t),    0 < t < pi/omega

It begins with what the last slip left, s = -r, and a periodic motion leaves -r again:

    r = (1 + e)/(1 - e)/(1 + (omega t_v)^2),    e = exp(-pi/(omega t_v))

So the stress left is mu_k w(x) - d/L, d = r (peak - mu_k) F_Z, even where w is not.

*What the next slip needs (W, derived).* Creep runs away at l: the stretch that creeps
carries mu_s w, the rest what the last slip left. Their sum is the peak with n = 0.

*What precursors add (phi, an estimate).* A front that stops on the way refills the
deficit behind it and carries one more (mu_s - mu_k) W(l) forward, as far as elastic
stress follows while it runs: phi = 1 - exp(-L/(c t_v)).

*Where fronts stop (no constant).* A steady front with weakening friction and viscosity
needs a force of w/q, and k precursors push with `push`; a front stops where the push is
less. n is possible if it carries to the end, and n - 1 does not.

The article compares all three with some 1,500 runs. The law is weak with more load at
the far end, where precursors come and omega t_v is above 1 (peaks are higher by up to
0.015, and n is lower than it says), and with a drive that is stiffer than the slider.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from precursors.larger.chain import LargerChain, critical_length
from precursors.model.chain import FloatArray

# Limits within which the law was compared with runs.
FEWEST_BLOCKS = 3  # in l_c
LONGEST = 0.7  # l_c/L
SLOW_DRIVE = 0.3  # V/v_c
STIFF_DRIVE = 1.3  # K L/(E S)
LAGS = (0.05, 4.0)  # omega t_v
MOST_PRECURSORS = 12
PLACES = 200  # along the row, at which the push is compared with the need


@dataclass(frozen=True)
class Law:
    """Terms of the law for one chain: l_c/L, W(l), r, phi, and the need of a front.

    `need` is that at `places` x/L from l_c to the end; forces are in (mu_s - mu_k) F_Z.
    """

    mu_s: float
    mu_k: float
    nucleus: float
    load: float
    rebound: float
    refill: float
    places: FloatArray
    need: FloatArray

    def coefficient(self, precursors: float = 0) -> float:
        """Peak of F_X/F_Z with so many precursors between two global slips; a mean if
        cycles alternate."""
        excess = (1.0 + precursors * self.refill) * self.load
        excess /= 1.0 + self.rebound * (1.0 - self.nucleus)
        return self.mu_k + (self.mu_s - self.mu_k) * excess

    def push(self, events: int, precursors: int) -> FloatArray:
        """Force that a front brings to each place after so many events of a cycle that
        has `precursors`."""
        excess = self.coefficient(precursors) - self.mu_k
        deficit = self.rebound * excess / (self.mu_s - self.mu_k)
        ahead = self.places - self.nucleus
        return (1.0 + events * self.refill) * self.load - deficit * ahead

    def front(self, events: int, precursors: int) -> float:
        """Place x/L at which the front stops after so many events of a cycle; 1: it is
        a global slip."""
        lacks = self.push(events, precursors) < self.need
        return float(self.places[lacks.argmax()]) if lacks.any() else 1.0

    @property
    def possible(self) -> list[int]:
        """Numbers of precursors that a cycle can have."""
        return [
            n
            for n in range(MOST_PRECURSORS + 1)
            if self.front(n, n) == 1.0 and (n == 0 or self.front(n - 1, n) < 1.0)
        ]

    @property
    def bound(self) -> float:
        """Least settled coefficient: a front must reach the end."""
        return self.mu_k + (self.mu_s - self.mu_k) * float(self.need[-1])


def law_of(larger: LargerChain) -> Law:
    """Terms of the law for a chain; the height of the push is left out.

    Raises
    ------
    ValueError
        If the chain is outside the limits within which the law was compared with runs.
    """
    chain, v_c = larger.chain, larger.weakening_velocity
    if larger.friction:
        name = type(larger.friction).__name__
        raise ValueError(f"the law of the settled coefficient is not known with {name}")
    t_v = larger.relaxation_time + larger.viscosity / chain.stiffness
    block = chain.length / chain.n_blocks
    rigidity = chain.stiffness * block  # E S
    inertia = chain.mass / block  # M/L
    speed = math.sqrt(rigidity / inertia)
    nucleus = critical_length(larger) / chain.length
    drive = chain.drive_stiffness * chain.length / rigidity
    q = brentq(lambda q: q * math.tan(q) - drive, 0.0, 0.5 * math.pi - 1e-12)
    lag = q * speed / chain.length * t_v
    for fails, reason in (
        (v_c == 0.0 or chain.mu_k == chain.mu_s, "friction does not weaken"),
        (lag < LAGS[0], f"omega t_v = {lag:.2g} is below {LAGS[0]:g}"),
        (lag > LAGS[1], f"omega t_v = {lag:.2g} is above {LAGS[1]:g}"),
        (drive > STIFF_DRIVE, f"K = {drive:.2g} E S/L is above {STIFF_DRIVE:g} E S/L"),
        (
            chain.drive_velocity > SLOW_DRIVE * v_c,
            f"V = {chain.drive_velocity:g} m/s is above {SLOW_DRIVE:g} v_c",
        ),
        (nucleus > LONGEST, f"l_c = {nucleus:.2g} L is above {LONGEST:g} L"),
        (
            nucleus * chain.n_blocks < FEWEST_BLOCKS,
            f"l_c is shorter than {FEWEST_BLOCKS} blocks",
        ),
    ):
        if fails:
            raise ValueError(f"the law of the settled coefficient fails: {reason}")
    shares = np.append(0.0, np.cumsum(chain.weights)) / chain.normal_load
    ends = np.linspace(0.0, 1.0, chain.n_blocks + 1)
    places = np.linspace(nucleus, 1.0, PLACES)
    load = np.interp(places, 0.5 * (ends[1:] + ends[:-1]), chain.weights)
    resistance = math.sqrt(inertia * rigidity)  # rho c
    fall = larger.fall * load / block
    viscous = np.sqrt(resistance**2 + t_v * rigidity * fall)
    inverse = (resistance + viscous) / (fall * chain.length)  # 1/(q L)
    swing = math.exp(-math.pi / lag)
    return Law(
        mu_s=chain.mu_s,
        mu_k=chain.mu_k,
        nucleus=nucleus,
        load=float(np.interp(nucleus, ends, shares)),
        rebound=(1.0 + swing) / (1.0 - swing) / (1.0 + lag**2),
        refill=1.0 - math.exp(-chain.length / (speed * t_v)),
        places=places,
        need=load * chain.n_blocks / chain.normal_load * inverse,
    )
