"""The compiled kernel: a fast version of the method in `solver.plain`.

Between two transitions the blocks that slide obey a linear system with constant
friction and a load that grows linearly in time (Eqs. 2-6). The kernel cuts time into
windows, so short that a Taylor series of some twenty terms is exact to rounding. The
next transition is the earliest root of all event functions. The event function of a
sliding block is its velocity; at the root the block stops. Those of a sticking block
are its margins mu_s w_i -+ F_i, where F_i is the net force of its springs; at a root
the block is released.

In each window the kernel guesses the first root from a few terms and moves there. It
then proves that no event function vanishes earlier, for four blocks at a time
(`proof`). If the guess is bad, the proof fails. The functions without a proof are then
searched by safe steps, as `plain` does for every function.

Forces are in N, and times in units of tau, the inverse of a bound of the chain's
largest frequency. Displacements are multiplied by m/tau^2, so velocities are in N/tau
and a block's acceleration equals the force on it. The state consists of the force T_i
in the spring behind each block and the block's velocity v_i. It has no positions, so
slips of a micrometre after a millimetre of drive keep all their digits. Forces are
carried in two doubles, because their rounding from window to window would be the
largest error. In these units the equations of motion are

    dT_i/dt = c_i (v_{i-1} - v_i),
    dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i    where block i slides.

The array `motion` holds all of this; module `arrays` names its rows. Column 0 is the
drive, and columns 1..N are the blocks. Further columns are padding for groups of four.

| `plain` | kernel |
|---|---|
| `State` | rows of `motion`, with working space |
| `at_start` | `events.take_start` |
| `expand` | `series.expand`: velocities and net forces; spring forces follow from slips |
| `move` | `series.move`, which sums terms group by group (`powers`, `sum_series`) |
| `safe_step` | `roots.safe_step` |
| `first_root` | `roots.first_root`, for functions that `proof.prove` leaves undecided |
| `next_transition` | `events.next_transition`: `guess`, `find_root`, `prove`, `search` |
| last lines of `next_transition` | `friction.mode_at_rest` |
| `find_transitions` | `events.find_transitions`: `rest` if all stick, else `slide` |
"""

from precursors.solver.kernel.arrays import (
    PROGRESS,
    ROW,
    Batch,
    End,
    memory_for,
)
from precursors.solver.kernel.events import run_batch
from precursors.solver.kernel.layout import FINISHED, PAUSED
from precursors.solver.kernel.states import evaluate, should_compile_evaluation
from precursors.solver.kernel.units import parameters
