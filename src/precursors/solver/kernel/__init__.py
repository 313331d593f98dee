"""The compiled kernel: the chain's linear operator, its Taylor series, the earliest root and the event loop.

Between two transitions the blocks that slide obey a linear system with constant friction and a load that
grows linearly in time; its solution is summed as a Taylor series to rounding. The next transition is the
earliest root of a velocity (a sliding block stops) or of a stick margin mu_s w_i -+ F_i (a stuck block
lets go). With |g''| <= M on the window, the positive root of g + g' s - M s^2/2 is a step that cannot pass
a root of g; repeated on the function whose bound is smallest, it converges to the earliest root of all or
proves that the window holds none. A cubic with the rest of the series as its error bound is tried first.

Inside, forces are in N, displacements are multiplied by m/tau^2 into N, time is in tau and velocity in N/tau,
with tau such that the highest frequency of the chain times tau is at most `REACH`. The state is the force
T_i in the spring behind each block and its velocity v_i, not its position: slips of a micrometre after a
millimetre of drive keep all their digits. In these units the motion (Eqs. 2-6) is

    dT_i/dt = c_i (v_{i-1} - v_i),    dv_i/dt = r_i (G_i - f_i),    G_i = T_i - T_{i+1} + dashpots

where f_i is mode_i mu_k w_i on a block that slides. The share r_i of a block's mass in what moves with it is
1, but for block 1 with a loading head. Without additions there are no dashpots, and a block that sticks does
not move: `additions` is None then, and what they need is not even compiled. Else it holds four arrays:

- `dashpot`, gamma_i: G_i has gamma_i (v_{i-1} - v_i) - gamma_{i+1} (v_i - v_{i+1}) besides;
- `anchor`, chi_i: a block that sticks hangs on a spring between it and the plane; zero where the interface is
  rigid. On springs, all blocks move all the time;
- `grip`, p_i: the force f_i of that spring, dp_i/dt = chi_i v_i; a block that stops begins with p_i = G_i;
- `hold`: r_i chi_i of the blocks that stick, zero of the others.

Column 0 of every array is the drive, columns 1..N are the blocks; beyond them is room for groups of four.

A transition changes the motion of blocks at distance d only in order 2 d + 1 of the time since, with dashpots
in order d + 1. In a long chain each group of blocks therefore keeps Taylor series about a time of its own
within a common window, and a transition renews those of its neighbourhood only.

`compiled` says how all this becomes machine code, and how that is kept; `arrays` and `layout` what is
where, `units` what the units are, and `lanes` works on four blocks at once. `series` is the linear operator,
`springs` has forces and `friction` what they do to modes; `bounds`, `margins` and `watch` bound the next
transition from below, `roots` finds it, `events` goes from one to the next, `states` gives the state at any
time, and `ringing` hurries through rest on interface springs.
"""

from precursors.solver.kernel.arrays import (
    Record,
    Room,
    States,
    new_additions,
    new_columns,
    new_motion,
    new_ringing,
    new_search,
    new_state,
    width,
)
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
from precursors.solver.kernel.units import (
    System,
    is_linked,
    parameters,
    scale,
    to_positions,
)

__all__ = [
    "CLOCK_SIZE",
    "COUNT_SIZE",
    "DERIVATIVES",
    "ELAPSED",
    "FINISHED",
    "LONG",
    "ONSET",
    "ONSET_ERROR",
    "PAUSED",
    "ROOT_STEPS",
    "ROUNDINGS",
    "SINCE",
    "STATUS",
    "STORED",
    "TRANSITIONS",
    "WINDOWS",
    "Record",
    "Room",
    "States",
    "System",
    "evaluate",
    "is_linked",
    "new_additions",
    "new_columns",
    "new_motion",
    "new_ringing",
    "new_search",
    "new_state",
    "parameters",
    "run_batch",
    "scale",
    "to_positions",
    "width",
]
