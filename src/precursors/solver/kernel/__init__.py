"""The compiled kernel: the same method as `solver.plain`, fast.

Between two transitions the blocks that slide obey a linear system with constant friction and a load that
grows linearly in time (Eqs. 2-6). The kernel sums its solution as a Taylor series to rounding, in windows
short enough for some twenty terms. The next transition is the earliest root of all event functions: the
velocity of a block that slides (it stops), and the margins mu_s w_i -+ F_i of a block that sticks (it lets
go; F_i is the net force of its springs). If |g''| <= M on the window, then the positive root of
g + g' s - M s^2/2 is a step that cannot pass a root of g. Repeated on the function whose bound is smallest,
such steps converge to the earliest root of all, or prove that the window has none. Cheaper bounds come first:
the sum of a series' terms, one safe step, a cubic with the rest of the series as its error.

Units: forces are in N and times in tau, chosen so that the highest frequency of the chain times tau is at
most `REACH`. Displacements are multiplied by m/tau^2, so that velocities are in N/tau and a block's
acceleration is the force on it. The state is the force T_i in the spring behind each block and the block's
velocity v_i, and not its position: slips of a micrometre after a millimetre of drive keep all their digits.
Forces are carried in two doubles, as their rounding from window to window would be the largest error.
In these units the motion is

    dT_i/dt = c_i (v_{i-1} - v_i),    dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i   where block i slides.

Column 0 of every array is the drive, columns 1..N are the blocks. Beyond them is room for groups of four.

A transition changes the motion of blocks at distance d only in order 2 d + 1 of the time since. Where more
than `LONG` blocks move, each group of four keeps Taylor series about a time of its own within a common
window, and a transition renews those of its neighbourhood only.

Modules: `compiled` and `pointers` say how all this becomes machine code, and `lanes` works on four blocks at
once. `layout` and `arrays` say what is where. `units` scales a chain, `series` is its linear operator,
`springs` and `friction` are Eqs. 2-6. `bounds`, `margins` and `watch` bound the next transition from below,
and `roots` finds it. `events` goes from one transition to the next, `states` gives the state at any time.
"""

from precursors.solver.kernel.arrays import Batch, Limits, Progress, Record, System, memory_for
from precursors.solver.kernel.events import run_batch
from precursors.solver.kernel.layout import (
    CLOCK_SIZE,
    COUNT_SIZE,
    DERIVATIVES,
    ELAPSED,
    FINISHED,
    LONG,
    ONSET,
    ONSET_ERROR,
    PAUSED,
    ROOT_STEPS,
    ROUNDINGS,
    SINCE,
    STATUS,
    STORED,
    TRANSITIONS,
    WINDOWS,
)
from precursors.solver.kernel.states import evaluate
from precursors.solver.kernel.units import parameters, scale
