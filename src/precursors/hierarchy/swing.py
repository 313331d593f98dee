"""Rests on springs to the plane: all blocks stick, and swing about a slow motion with the drive.

The displacements y from the slow motion obey M y'' + C y' + A y = 0. Its eigenmodes give the state at any
time. They also bound it: no block is released before its slow force and the amplitudes of all modes together
reach its strength. The search leaps to that time, and samples from there on. Nothing is neglected, however
small the swing has become.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from precursors.model.chain import FloatArray

SAMPLES = 1000  # in one window, a step apart
WORST_CONDITION = 1e8  # of the eigenvectors; two modes at critical damping have none

compiled = njit(cache=True, error_model="numpy")


class System(NamedTuple):
    """What the compiled functions need of a chain."""

    springs: FloatArray
    masses: FloatArray
    strength: FloatArray
    friction: FloatArray
    dashpots: FloatArray  # viscosity of the one behind each block [N s/m], none at the drive
    holding_stiffness: float  # K_t/N of one block's spring to the plane [N/m]
    drive_velocity: float
    step: float  # [s]


class Swing:
    """Eigenmodes of a chain whose blocks all stick on springs.

    Raises
    ------
    ValueError
        If two modes are so close to critical damping that their eigenvectors are nearly the same.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        n = len(system.masses)
        ahead = np.append(system.springs[1:], 0.0)
        stiffness = np.diag(system.springs + ahead + system.holding_stiffness)
        stiffness -= np.diag(ahead[:-1], 1) + np.diag(ahead[:-1], -1)
        links = np.diff(np.eye(n), axis=0)
        damping = links.T @ (system.dashpots[1:, None] * links)
        # Velocities are in units of a displacement in one step: all numbers are then of one size.
        step, mass = system.step, system.masses[:, None]
        motion = np.block(
            [[np.zeros((n, n)), np.eye(n)], [-(step**2) * stiffness / mass, -step * damping / mass]]
        )
        rates, modes = np.linalg.eig(motion)
        if np.linalg.cond(modes) > WORST_CONDITION:
            raise ValueError(
                "two eigenmodes of the chain are critically damped: change the viscosity a little"
            )
        # Of two conjugate modes one counts double.
        kept = rates.imag >= 0.0
        self.rates = rates[kept] / step
        self.modes = modes[:n, kept] * np.where(rates[kept].imag > 0.0, 2.0, 1.0)
        self.amplitudes = np.linalg.inv(modes)[kept]
        drive = np.append(system.springs[0], np.zeros(n - 1))
        self.inverse = np.linalg.inv(stiffness)
        self.velocity = self.inverse @ drive * system.drive_velocity
        self.drag = damping @ self.velocity

    def wait(self, state: FloatArray, longest: float) -> tuple[float, float]:
        """Move `state` to a time up to which no block is released.

        Returns that time [s] and the largest F_X [N] that was seen.
        """
        system = self.system
        force, velocity, held = state
        unbalanced = force - np.append(force[1:], 0.0) - held - self.drag
        start = np.append(-self.inverse @ unbalanced, (velocity - self.velocity) * system.step)
        swing = self.modes * (self.amplitudes @ start)
        # Rows of what is followed: the forces on the plane, and F_X in the last row.
        drift = np.append(
            system.holding_stiffness * self.velocity,
            system.springs[0] * (system.drive_velocity - self.velocity[0]),
        )
        followed = np.vstack([system.holding_stiffness * swing, -system.springs[:1, None] * swing[:1]])
        now = np.append(held, force[0])
        offset = now - followed.sum(axis=1).real
        strength = np.append(system.strength, np.inf)
        waited, highest = still_for(self.rates, followed, offset, drift, strength, system.step, longest)
        turned = np.exp(self.rates * waited)
        moved = self.velocity * waited + (swing @ (turned - 1.0)).real
        behind = np.append(system.drive_velocity * waited, moved[:-1])
        state[0] += system.springs * (behind - moved)
        state[1] = self.velocity + (swing @ (self.rates * turned)).real
        state[2] += system.holding_stiffness * moved
        return waited, highest


@compiled
def still_for(rates, swing, offset, drift, strength, step, longest):
    """Time [s] up to which no force reaches its strength, and the largest sample of the last row.

    Row i is offset_i + drift_i t + Re sum_m swing_im exp(rates_m t). A window of SAMPLES steps is sampled.
    Between two samples a row sags by less than its second derivative allows. From the end of a window the
    search leaps as far as all modes together cannot release a block.
    """
    rows, modes = swing.shape
    real, imaginary = np.empty(modes), np.empty(modes)
    value, size, sag = np.empty(rows), np.empty(rows), np.empty(rows)
    window = SAMPLES * step
    time, highest = 0.0, 0.0
    while time < longest:
        leap = longest - time
        size[:] = 0.0
        sag[:] = 0.0
        for m in range(modes):
            decay = math.exp(rates[m].real * time)
            for i in range(rows):
                size[i] += abs(swing[i, m]) * decay
                sag[i] += abs(swing[i, m]) * decay * abs(rates[m]) ** 2 * step**2 / 8.0
        watched = np.empty(rows, np.int64)
        n_watched = 0
        for i in range(rows):
            slow = offset[i] + drift[i] * time
            gap = strength[i] - size[i] - max(slow, -slow)
            if gap < abs(drift[i]) * leap:
                leap = max(gap, 0.0) / abs(drift[i])
            if gap < abs(drift[i]) * window or i == rows - 1:
                watched[n_watched] = i
                n_watched += 1
        if leap > window and time > 0.0:
            time += leap
            continue
        for m in range(modes):
            turned = np.exp(rates[m] * time)
            real[m], imaginary[m] = turned.real, turned.imag
        turn = np.exp(rates * step)
        part = np.ascontiguousarray(swing[watched[:n_watched]].T)
        a, b = part.real.copy(), part.imag.copy()
        for j in range(SAMPLES + 1):
            now = time + j * step
            for w in range(n_watched):
                value[w] = offset[watched[w]] + drift[watched[w]] * now
            for m in range(modes):
                for w in range(n_watched):
                    value[w] += a[m, w] * real[m] - b[m, w] * imaginary[m]
                x = real[m] * turn[m].real - imaginary[m] * turn[m].imag
                imaginary[m] = real[m] * turn[m].imag + imaginary[m] * turn[m].real
                real[m] = x
            for w in range(n_watched):
                i = watched[w]
                if strength[i] - abs(value[w]) < sag[i] or now > longest:
                    return time + max(j - 1, 0) * step, highest
            highest = max(highest, value[n_watched - 1])
        time += window
    return longest, highest
