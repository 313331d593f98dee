"""Choose a duration that includes the first global slip.

F_X is at most mu_s F_Z, and the drive compresses its own spring and the N - 1 springs of the slider. With
a soft drive (K < k/10) the global slip therefore begins after (1/K + (N - 1)/k) mu_s F_Z / V at the latest.
With a stiffer drive there may be none. `until` stops the run at the end of the slip.

Prints:
    latest: 0.400 s, simulated: 0.247 s
"""

from precursors import Chain, simulate

chain = Chain.from_slider(drive_velocity=2e-3, drive_stiffness=4e5)
springs = 1 / chain.drive_stiffness + (chain.n_blocks - 1) / chain.stiffness
latest = springs * chain.mu_s * chain.normal_load / chain.drive_velocity
first = simulate(chain, latest, until="global slip")
print(f"latest: {latest:.3f} s, simulated: {first.duration:.3f} s")
