"""How long must a run be to reach its first global slip?

By then the drive has pressed its own spring and those of the slider, and F_X is at most mu_s F_Z. So a
drive that is soft beside the slider (K < k/10) reaches it after (1/K + (N - 1)/k) mu_s F_Z / V at the
latest. With a stiffer drive there may be no global slip at all. `until` ends the run at its end.

Prints:
    latest: 0.400 s, found: 0.247 s
"""

from precursors import Chain, simulate

chain = Chain.from_slider(drive_velocity=2e-3, drive_stiffness=4e5)
springs = 1 / chain.drive_stiffness + (chain.n_blocks - 1) / chain.stiffness
latest = springs * chain.mu_s * chain.normal_load / chain.drive_velocity
first = simulate(chain, latest, until="global slip")
print(f"latest: {latest:.3f} s, found: {first.duration:.3f} s")
