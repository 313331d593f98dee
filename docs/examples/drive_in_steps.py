"""Change the speed of the drive in steps, with one run for each speed.

Normal loads change in the same way: give `replace` new `weights`.

Prints:
    0.0001 m/s: 90 transitions, then F_X = 142.578 N
    0.001 m/s: 146 transitions, then F_X = 184.758 N
    0.0001 m/s: 234 transitions, then F_X = 167.126 N
"""

from dataclasses import replace

from precursors import Chain, simulate

chain = Chain.from_slider()
start = {}
for speed, duration in ((1e-4, 2.0), (1e-3, 0.1), (1e-4, 1.0)):  # m/s, s
    run = simulate(replace(chain, drive_velocity=speed), duration, **start)
    positions, velocities = run.at([duration])
    # The drive is at 0 when a run begins, so the chain is shifted with it.
    start = {
        "start_positions": positions[0] - speed * duration,
        "start_velocities": velocities[0],
    }
    load = run.tangential_load([duration])[0]
    print(f"{speed:g} m/s: {len(run.transitions)} transitions, then F_X = {load:.3f} N")
