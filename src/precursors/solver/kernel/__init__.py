"""The compiled kernel: the same method as `solver.plain`, fast.

Between two transitions the blocks that slide obey a linear system with constant
friction and a load that grows linearly in time (Eqs. 2-6). The kernel sums its solution
as a Taylor series to rounding, in windows short enough for some twenty terms. The next
transition is the earliest root of all event functions: the velocity of a block that
slides (it stops), and the margins mu_s w_i -+ F_i of a block that sticks (it lets go;
F_i is the net force of its springs).

In each window the kernel guesses the first root from a few terms, goes there, and
proves for all blocks at once, four in a register, that none of their functions vanishes
before (`proof`). A bad guess fails the proof and does no harm: what is not proved is
searched by safe steps, as `plain` does it for every function.

Units: forces are in N and times in tau, one over a bound of the chain's largest
frequency. Displacements are multiplied by m/tau^2, so that velocities are in N/tau and
a block's acceleration is the force on it. The state is the force T_i in the spring
behind each block and the block's velocity v_i, and not its position: slips of a
micrometre after a millimetre of drive keep all their digits. Forces are carried in two
doubles, as their rounding from window to window would be the largest error. In these
units the motion is

    dT_i/dt = c_i (v_{i-1} - v_i),
    dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i    where block i slides.

All of it is in one array, `motion`, whose rows `arrays` names. Column 0 is the drive,
columns 1..N are the blocks. Beyond them is room for a group of four.

| `plain` | kernel |
|---|---|
| `State` | rows of `motion`, with room to work in |
| `at_start` | `events.take_start` |
| `expand` | `series.expand`: velocities and net forces; spring forces follow from slips |
| `move` | `series.move`, which sums terms group by group (`powers`, `sum_series`) |
| `safe_step` | `roots.safe_step` |
| `first_root` | `roots.first_root`, for functions that `proof.prove` leaves open |
| `next_transition` | `events.next_transition`: `guess`, `find_root`, `prove`, `search` |
| its last lines | `friction.mode_at_rest` |
| `find_transitions` | `events.find_transitions`: `rest` where all stick, else `slide` |
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
from precursors.solver.kernel.states import evaluate, is_compiled_now
from precursors.solver.kernel.units import parameters
