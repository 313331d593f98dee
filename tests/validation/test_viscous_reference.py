"""The reference with viscosity is right, by closed forms and exponentials."""

from __future__ import annotations

import csv
from fractions import Fraction

import pytest
from mpmath import mp
from reference import VISCOUS, HeldOut, Transition, read_viscous, reference
from reference.goldens import GOLDEN, HELD_OUT_DIGITS, csv_rows

FORTY_DIGITS = mp.mpf(10) ** -40  # relative, what the reference promises
# A time of up to 10 s has 25 digits; accelerations are below 1e6 m/s^2 and rates of forces below 1e8 N/s.
LOAD_ROUNDING = mp.mpf(10) ** -15  # N
SPEED_ROUNDING = mp.mpf(10) ** -15  # m/s
CHECKED_TRANSITIONS = 9
SAMPLES = 5  # times between two transitions at which the rules are checked


@pytest.fixture(autouse=True)
def _sixty_digits():
    with mp.workdps(60):
        yield


def ratio(x: Fraction) -> mp.mpf:
    return mp.mpf(x.numerator) / x.denominator


def close(a: mp.mpf, b: mp.mpf) -> bool:
    return abs(a - b) <= FORTY_DIGITS * abs(b)


class MatrixMotion:
    """Motion by matrix exponentials of z = (x, v, t, 1) [m, m/s, s], with the modes as given."""

    def __init__(self, scene: HeldOut) -> None:
        chain = scene.chain
        self.n = n = len(chain.weights)
        self.strength = [ratio(chain.mu_s * w) for w in chain.weights]
        self.kinetic = [ratio(chain.mu_k * w) for w in chain.weights]
        self.mass = ratio(chain.mass)
        self.drive_stiffness = ratio(chain.drive_stiffness)
        self.drive_velocity = ratio(chain.drive_velocity)
        # Rows of G, the net force of springs and dashpots.
        self.net = mp.zeros(n, 2 * n + 2)
        self.net[0, 0] -= self.drive_stiffness
        self.net[0, 2 * n] += self.drive_stiffness * self.drive_velocity
        for i in range(1, n):
            for columns, size in ((0, ratio(chain.stiffness)), (n, ratio(chain.viscosity))):
                for row, sign in ((i, 1), (i - 1, -1)):
                    self.net[row, columns + i - 1] += sign * size
                    self.net[row, columns + i] -= sign * size
        self.state = mp.zeros(2 * n + 2, 1)
        self.state[2 * n + 1] = 1
        self.modes = [0] * n

    def rate(self) -> mp.matrix:
        """F of dz/dt = F z between transitions."""
        n = self.n
        rate = mp.zeros(2 * n + 2)
        rate[2 * n, 2 * n + 1] = 1
        for i, mode in enumerate(self.modes):
            if mode:
                rate[i, n + i] = 1
                rate[n + i, :] = self.net[i, :] / self.mass
                rate[n + i, 2 * n + 1] -= mode * self.kinetic[i] / self.mass
        return rate

    def net_force(self, i: int) -> mp.mpf:
        return (self.net[i, :] * self.state)[0]

    def load(self) -> mp.mpf:
        return self.drive_stiffness * (self.drive_velocity * self.state[2 * self.n] - self.state[0])

    def obey_the_rules(self) -> bool:
        """No block that slides has turned, none that sticks is beyond its strength."""
        return all(
            mode * self.state[self.n + i] > 0 if mode else abs(self.net_force(i)) < self.strength[i]
            for i, mode in enumerate(self.modes)
        )

    def follow(self, t: Transition) -> None:
        """Go to the next transition and demand that it is one, and the first."""
        i = t.block - 1
        wait = ratio(t.time) - self.state[2 * self.n]
        step = mp.expm(self.rate() * (wait / SAMPLES))
        for sample in range(SAMPLES):
            self.state = step * self.state
            assert sample == SAMPLES - 1 or self.obey_the_rules()
        speed = self.state[self.n + i]
        assert abs(self.load() - ratio(t.tangential_load)) < LOAD_ROUNDING
        if self.modes[i]:
            assert abs(speed) < SPEED_ROUNDING
            self.state[self.n + i] = 0
            force = self.net_force(i)
            assert t.mode == (0 if abs(force) <= self.strength[i] else mp.sign(force))
        else:
            force = self.net_force(i)
            assert abs(abs(force) - self.strength[i]) < LOAD_ROUNDING
            assert t.mode == mp.sign(force)
            assert speed * t.mode > -SPEED_ROUNDING
        self.modes[i] = t.mode


@pytest.mark.parametrize("name", ["stiff_viscosity", "backward"])
def test_each_transition_is_the_first_by_the_matrix_exponential(name: str) -> None:
    scene, transitions = read_viscous()[name]
    motion = MatrixMotion(scene)
    for t in transitions[:CHECKED_TRANSITIONS]:
        motion.follow(t)


def test_first_slip_with_viscosity_is_that_of_a_damped_oscillator() -> None:
    c = VISCOUS["stiff_viscosity"].chain
    eta = ratio(c.viscosity)
    release, stop = reference(c, 10, max_transitions=2)
    mass, stiffness = ratio(c.mass), ratio(c.stiffness + c.drive_stiffness)
    damping = eta / (2 * mass)
    omega = mp.sqrt(stiffness / mass - damping**2)
    creep = ratio(c.drive_stiffness * c.drive_velocity) / stiffness
    push = ratio((c.mu_s - c.mu_k) * c.weights[0]) / mass

    def speed(t: mp.mpf) -> mp.mpf:
        swing = creep * mp.cos(omega * t) + (creep * damping - push) / omega * mp.sin(omega * t)
        return creep - mp.exp(-damping * t) * swing

    duration = mp.findroot(speed, (0.9 * mp.pi / omega, 1.1 * mp.pi / omega))
    assert (release.block, release.mode, stop.block, stop.mode) == (1, 1, 1, 0)
    assert close(ratio(release.time), ratio(c.mu_s * c.weights[0] / (c.drive_stiffness * c.drive_velocity)))
    assert close(ratio(stop.time - release.time), duration)


def test_beyond_critical_damping_block_1_creeps_without_an_end() -> None:
    _, transitions = read_viscous()["creep"]
    assert [(t.block, t.mode) for t in transitions] == [(1, 1)]


def test_golden_digits_are_reproduced_with_64_places_less() -> None:
    with (GOLDEN / "reference_viscous.csv").open(newline="") as file:
        rows = [row for chain, *row in csv.reader(file) if chain == "stiff_viscosity"]
    assert csv_rows(VISCOUS["stiff_viscosity"].run(bits=192), HELD_OUT_DIGITS) == rows


def test_golden_scenes_are_complete_and_hold_backward_slip() -> None:
    scenes = read_viscous()
    assert all(transitions for _, transitions in scenes.values())
    assert any(t.mode == -1 for t in scenes["backward"][1])
