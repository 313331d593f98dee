"""Go on from the end of a run.

A run begins with the drive at 0, so the chain is moved back by what the drive has gone. Half a run and
its continuation have the transitions of the whole run, to rounding, where the run is cut at rest.

Prints:
    832 transitions, times within 1e-11 s
"""

import numpy as np

from precursors import Chain, simulate

chain = Chain.from_slider()
whole, half = simulate(chain, 6.0), simulate(chain, 3.0)
positions, velocities = half.at([half.duration])
more = simulate(
    chain,
    3.0,
    start_positions=positions[0] - chain.drive_velocity * half.duration,
    start_velocities=velocities[0],
)
times = np.append(half.transitions["time"], half.duration + more.transitions["time"])
error = abs(times - whole.transitions["time"]).max()
print(len(times), "transitions, times within", "1e-11 s" if error < 1e-11 else error)
