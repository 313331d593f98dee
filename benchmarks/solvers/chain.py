"""The chain of docs/benchmark.md: equations, switching rules and the file to hand in.

A script beside this module brings the numerical method:

    python scipy_dop853.py uniform/problem.json uniform.csv

A state is the forces in the springs [N], then the velocities [m/s]. Time is in
microseconds and starts anew with every slip: near zero it has more digits.
"""

import json
import sys
import time
from fractions import Fraction
from pathlib import Path

import numpy as np

MICROSECOND = 1e-6
# Velocity of a block that is released [m/s]: exactly zero would be an event.
PUSH = 1e-150
HEADER = "time_s,block,mode,tangential_load_N,evaluations,seconds"


class Chain:
    """Parameters of a problem, and the present mode of each block."""

    def __init__(self, problem):
        def number(name):
            return float(Fraction(problem[name]))

        self.weights = np.array([float(Fraction(w)) for w in problem["weights"]])
        self.n = len(self.weights)
        self.mode = np.zeros(self.n)
        self.duration = number("duration")
        self.mass = number("mass")
        self.speed = number("drive_velocity")
        self.springs = np.full(self.n, number("stiffness"))
        self.springs[0] = number("drive_stiffness")
        self.strength = number("mu_s") * self.weights
        self.friction = number("mu_k") * self.weights

    def net_forces(self, state):
        return state[: self.n] - np.append(state[1 : self.n], 0.0)

    def rates(self, state):
        """Derivative of the state, per microsecond."""
        velocity = state[self.n :]
        behind = np.append(self.speed, velocity[:-1])
        forces = self.net_forces(state) - self.mode * self.friction
        acceleration = forces / self.mass * (self.mode != 0.0)
        slopes = np.append(self.springs * (behind - velocity), acceleration)
        return MICROSECOND * slopes

    def events(self, state):
        """One number for each block, which falls to zero at its next transition."""
        margin = self.strength - abs(self.net_forces(state))
        return np.where(self.mode, self.mode * state[self.n :], margin)

    def switch(self, block, state):
        """Apply the two rules to a block whose event function is zero."""
        force = self.net_forces(state)[block]
        slides_on = self.mode[block] == 0 or abs(force) > self.strength[block]
        self.mode[block] = np.sign(force) if slides_on else 0.0
        state[self.n + block] = self.mode[block] * PUSH


def solve(method):
    """Solve the problem of the command line.

    `method(chain)` returns a function of the state, the time, and the end. It goes on
    to the next event, and returns the state, the time, the block, if there is one, and
    how often it evaluated the equations.
    """
    problem, output = map(Path, sys.argv[1:])
    chain = Chain(json.loads(problem.read_text()))
    advance = method(chain)
    state, onset, elapsed, evaluations = np.zeros(2 * chain.n), 0.0, 0.0, 0
    rows, began = [HEADER], time.perf_counter()
    while True:
        if chain.mode.any():
            end = (chain.duration - onset) / MICROSECOND
            state, elapsed, block, count = advance(state, elapsed, end)
            evaluations += count
        else:  # all blocks stick: only the force on the first one grows
            loading = chain.springs[0] * chain.speed
            wait = (chain.strength[0] - chain.net_forces(state)[0]) / loading
            state[0] += loading * wait
            onset += elapsed * MICROSECOND + wait
            elapsed, block = 0.0, 0
        now = float(onset + elapsed * MICROSECOND)
        if block is None or now > chain.duration:
            break
        chain.switch(block, state)
        seconds = time.perf_counter() - began
        row = f"{now!r},{block + 1},{chain.mode[block]:.0f},{float(state[0])!r}"
        rows.append(f"{row},{evaluations},{seconds:.3f}")
    output.write_text("\n".join([*rows, ""]))
