"""Long leaps of a chain that sticks on interface springs, and rings about its quasi-static motion."""

from __future__ import annotations

import math

from precursors.solver.kernel.compiled import seldom
from precursors.solver.kernel.layout import BEYOND, LEAPS, LEAST_LEAP, SAFETY, SHORT_WINDOW
from precursors.solver.kernel.series import order_for


@seldom
def prepare_leaps(drive_velocity, chain, additions, ringing):
    """Fill what `leap` needs: pivots and diagonal of A^-1, quasi-static velocities, the leaps themselves.

    On springs, a chain that sticks rings about the quasi-static motion, in which blocks move at the constant
    velocities A^-1 (c_1 V, 0, ...), A the stiffness of springs and interface (tridiagonal). leaps[k] carries
    displacements and velocities of the ringing over 2^k windows.
    """
    coupling, lightness = chain.coupling, chain.lightness
    pivot, softness, creep, leaps = ringing.pivot, ringing.softness, ringing.creep, ringing.leaps
    n_blocks = softness.shape[0] - 1 - BEYOND
    for i in range(1, n_blocks + 1):
        pivot[i] = coupling[i] + coupling[i + 1] + additions.anchor[i]
        if i > 1:
            pivot[i] -= coupling[i] * coupling[i] / pivot[i - 1]
    ahead = 0.0
    for j in range(n_blocks):
        i = n_blocks - j
        softness[i] = 1.0 / (pivot[i] - ahead)
        back = coupling[i] + coupling[i + 1] + additions.anchor[i] - ahead
        ahead = coupling[i] * coupling[i] / back
        creep[i] = 0.0
    creep[1] = coupling[1] * drive_velocity
    relax(n_blocks, coupling, pivot, creep)
    order = order_for(SHORT_WINDOW)
    for column in range(2 * n_blocks):
        # leaps[1] and leaps[2] have room for a term of the series of this column, and for the next one.
        for j in range(2 * n_blocks):
            leaps[0, j, column] = leaps[1, 0, j] = 1.0 if j == column else 0.0
        for n in range(1, order + 1):
            length = SHORT_WINDOW / n
            for j in range(n_blocks):
                i = j + 1
                x, v = leaps[1, 0, j], leaps[1, 0, n_blocks + j]
                x_behind = v_behind = x_ahead = v_ahead = 0.0
                if j > 0:
                    x_behind, v_behind = leaps[1, 0, j - 1], leaps[1, 0, n_blocks + j - 1]
                if i < n_blocks:
                    x_ahead, v_ahead = leaps[1, 0, j + 1], leaps[1, 0, n_blocks + j + 1]
                force = (
                    coupling[i] * (x_behind - x) - coupling[i + 1] * (x - x_ahead) - additions.anchor[i] * x
                )
                force += additions.dashpot[i] * (v_behind - v) - additions.dashpot[i + 1] * (v - v_ahead)
                leaps[2, 0, j] = length * v
                leaps[2, 0, n_blocks + j] = length * lightness[i] * force
            for j in range(2 * n_blocks):
                leaps[1, 0, j] = leaps[2, 0, j]
                leaps[0, j, column] += leaps[2, 0, j]
    for k in range(1, LEAPS + 1):
        for i in range(2 * n_blocks):
            for j in range(2 * n_blocks):
                leaps[k, i, j] = 0.0
            for m in range(2 * n_blocks):
                factor = leaps[k - 1, i, m]
                for j in range(2 * n_blocks):
                    leaps[k, i, j] += factor * leaps[k - 1, m, j]


@seldom
def relax(n_blocks, coupling, pivot, force):
    """Solve A x = force in place, by the pivots of A."""
    for i in range(2, n_blocks + 1):
        force[i] += coupling[i] / pivot[i - 1] * force[i - 1]
    force[n_blocks] /= pivot[n_blocks]
    for j in range(1, n_blocks):
        i = n_blocks - j
        force[i] = (force[i] + coupling[i + 1] * force[i + 1]) / pivot[i]


@seldom
def leap(remaining, chain, additions, ringing, tension, motion):
    """Let a chain that sticks move on by 2^k windows: velocities in row 0, slips; returns k, or -1 for none.

    The energy E of the ringing does not grow: p_i stays within chi_i sqrt(2 E (A^-1)_ii) of what it is in
    quasi-static motion, which grows linearly; the leap ends before one of them can reach its strength.
    """
    coupling, strength, _, lightness = chain
    rate, slip = motion.rate, motion.slip
    pivot, softness, creep, leaps = ringing.pivot, ringing.softness, ringing.creep, ringing.leaps
    n_blocks = softness.shape[0] - 1 - BEYOND
    for i in range(1, n_blocks + 1):
        damped = additions.dashpot[i] * (creep[i - 1] - creep[i])
        damped -= additions.dashpot[i + 1] * (creep[i] - creep[i + 1])
        slip[i] = tension[i] - tension[i + 1] - additions.grip[i] + damped
    energy = 0.0
    for i in range(1, n_blocks + 1):
        pivot[n_blocks + i] = slip[i]
    relax(n_blocks, coupling, pivot, slip)
    for i in range(1, n_blocks + 1):
        swinging = rate[0, i] - creep[i]
        energy += abs(pivot[n_blocks + i] * slip[i]) + swinging * swinging / lightness[i]
    longest = remaining
    for i in range(1, n_blocks + 1):
        chi = additions.anchor[i]
        held = additions.grip[i] + chi * slip[i]
        swing = SAFETY * chi * math.sqrt(energy * softness[i])
        if strength[i] - swing <= abs(held):
            return -1
        longest = min(longest, (strength[i] - swing - held) / (chi * creep[i]))
    k, span = -1, SHORT_WINDOW
    while k < LEAPS and span <= longest:
        k += 1
        span *= 2.0
    if k < LEAST_LEAP:
        return -1
    span = SHORT_WINDOW * 2.0**k
    for i in range(1, n_blocks + 1):
        leaps[LEAPS + 1, 0, i - 1] = -slip[i]
        leaps[LEAPS + 1, 0, n_blocks + i - 1] = rate[0, i] - creep[i]
    for i in range(1, n_blocks + 1):
        x = v = 0.0
        for j in range(2 * n_blocks):
            x += leaps[k, i - 1, j] * leaps[LEAPS + 1, 0, j]
            v += leaps[k, n_blocks + i - 1, j] * leaps[LEAPS + 1, 0, j]
        slip[i] += creep[i] * span + x
        rate[0, i] = creep[i] + v
    return k
