"""Continue a run from its end.

The drive is at 0 when a run begins, so the chain is shifted back by the distance that the drive has moved.
If a run is cut at rest, its parts have the same transitions as the whole run, apart from rounding errors.

Prints:
    832 transitions, times within 1e-11 s
"""

import numpy as np

from precursors import Chain, simulate

chain = Chain.from_slider()
whole, half = simulate(chain, 6.0), simulate(chain, 3.0)
positions, velocities = half.at([half.duration])
rest = simulate(
    chain,
    3.0,
    start_positions=positions[0] - chain.drive_velocity * half.duration,
    start_velocities=velocities[0],
)
times = np.append(half.transitions["time"], half.duration + rest.transitions["time"])
error = abs(times - whole.transitions["time"]).max()
print(len(times), "transitions, times within", "1e-11 s" if error < 1e-11 else error)
