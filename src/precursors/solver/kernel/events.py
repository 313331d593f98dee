"""The event loop: chains from their start, transition after transition, into a record."""

from __future__ import annotations

from precursors.solver.kernel.arrays import Record, System, as_progress, divide, n_columns
from precursors.solver.kernel.compiled import inner, inner_unfused, outer, seldom, unfused
from precursors.solver.kernel.friction import (
    at_start,
    farthest_sliding,
    resting_mode,
    set_mode,
    take_mode,
    take_neighbours,
)
from precursors.solver.kernel.guess import LEAST, MARGIN, NEAR, find_root, guess
from precursors.solver.kernel.layout import (
    FINISHED,
    PAUSED,
    PROOF_ORDER,
    ROUNDINGS,
    ROWS,
    STOPPED,
    WIDTH,
    WINDOW,
)
from precursors.solver.kernel.pointers import pointer, shifted
from precursors.solver.kernel.proof import prove, search
from precursors.solver.kernel.series import expand, order_at, powers, set_rows
from precursors.solver.kernel.springs import begin, move, take_net_force, two_sum
from precursors.solver.kernel.units import set_up
from precursors.solver.record import States


@outer
def run_batch(batch, limits, progress, record, states, memory):
    """Run chain after chain from its start, as many as there is room for, into one record.

    Row j of `batch` is a chain with its start, row j of `progress` has the bytes of where it ended. Limits
    are those of each chain. Returns how many chains are finished and whether the one after them is paused:
    its state is in `memory`, and what it recorded follows that of the others. It can go on where it is all
    there is.
    """
    n_blocks = batch.weights.shape[1]
    columns, motion = divide(memory, n_blocks)
    used = stored = windows = 0
    for j in range(batch.weights.shape[0]):
        if not limits.goes_on:
            full = used + max(limits.transitions, n_blocks) > record.time.shape[0]
            if full or stored + limits.states > states.after.shape[0] or windows > limits.windows:
                return j, False
            forget(columns, n_blocks, motion)
        tau, speed, drive_velocity = set_up(batch.parameters[j], batch.weights[j], n_blocks, columns)
        chain = System(n_blocks, tau, speed, drive_velocity, columns[0], columns[1], columns[2])
        mine, my_record = as_progress(pointer(progress[j])), rest_of_record(record, used, j)
        my_states = rest_of_states(states, stored, n_blocks)
        if not limits.goes_on:
            mine.tau = tau
            at_start(batch.positions[j], batch.velocities[j], batch.parameters[j], chain, motion)
            note_start(chain, motion, mine, my_record, my_states)
        mine.status = find_transitions(chain, motion, limits, mine, my_record, my_states)
        if mine.status == PAUSED:
            return j, True
        used += mine.transitions
        stored += mine.stored
        windows += mine.windows
        record.intervals[used + j] = mine.since * tau
    return batch.weights.shape[0], False


@seldom
def forget(columns, n_blocks, motion):
    """Clear what the chain before has left."""
    for values in columns:
        clear(values, n_blocks)
    clear(motion.velocity, n_blocks)
    clear(motion.spring_force, n_blocks)
    clear(motion.force_rest, n_blocks)
    for i in range(n_columns(n_blocks)):
        motion.mode[i] = 0


@inner
def clear(values, n_blocks):
    """Set all columns to zero."""
    for i in range(n_columns(n_blocks)):
        values[i] = 0.0


@inner
def rest_of_record(record, used, n_runs):
    """What is left of a record after `n_runs` runs; each leaves one interval more than transitions."""
    return Record(
        shifted(pointer(record.time), used),
        shifted(pointer(record.block), used),
        shifted(pointer(record.mode), used),
        shifted(pointer(record.tangential_load), used),
        shifted(pointer(record.intervals), used + n_runs),
    )


@inner
def rest_of_states(states, stored, n_blocks):
    """What is left of the states after the first `stored`; their numbers are a row after the other."""
    return States(
        shifted(pointer(states.force), stored * n_blocks),
        shifted(pointer(states.velocity), stored * n_blocks),
        shifted(pointer(states.mode), stored * n_blocks),
        shifted(pointer(states.after), stored),
        shifted(pointer(states.offset), stored),
    )


@seldom
def note_start(chain, motion, progress, record, states):
    """Record the blocks that move at time 0 as transitions; the first state is the start with all modes 0."""
    mode = motion.mode
    k = 0
    for i in range(1, chain.n_blocks + 1):
        states.force[i - 1] = motion.spring_force[i]
        states.velocity[i - 1] = motion.velocity[i] * chain.speed
        states.mode[i - 1] = 0
        if mode[i] != 0:
            record.time[k], record.block[k], record.mode[k] = 0.0, i, mode[i]
            record.tangential_load[k], record.intervals[k] = motion.spring_force[1], 0.0
            k += 1
    states.after[0], states.offset[0] = 0, 0.0
    progress.transitions = k
    progress.stored = 1
    count_sliding(k, chain, progress)


@unfused
def find_transitions(chain, motion, limits, progress, record, states):
    """Run a chain until `duration` [s], the end of the first global slip, full records or enough windows.

    The state and `progress` are left at the time reached; record and states are filled from where it says.
    """
    lay_out(chain, motion)
    progress.at_once = 0
    progress.farthest = chain.n_blocks
    status = PAUSED
    last_window = progress.windows + limits.windows
    while (
        status == PAUSED
        and progress.transitions < limits.transitions
        and progress.windows < last_window
        and progress.stored < limits.states
    ):
        progress.windows += 1
        if progress.transitions >= limits.stride * progress.stored:
            store_state(chain, motion, progress, states)
        if progress.sliding == 0:
            status = rest(chain, motion, limits, progress, record)
        else:
            status = slide(chain, motion, limits, progress, record)
    return status


@seldom
def lay_out(chain, motion):
    """Set the motion out from a state; column 0 is the drive, what is beyond the blocks does not move."""
    for values in (motion.slides, motion.push, motion.hold, motion.felt, motion.sign, motion.net_force):
        clear(values, chain.n_blocks)
    for i in range(ROWS * motion.wide):
        motion.rate[i] = 0.0
    motion.rate[0], motion.slides[0] = chain.drive_velocity, 1.0
    motion.whole[1] = 0.0
    for i in range(1, chain.n_blocks + 1):
        take_mode(i, chain, motion)
        take_net_force(i, motion)
    for i in range(1, chain.n_blocks + 1):
        take_neighbours(i, chain, motion)


@seldom
def store_state(chain, motion, progress, states):
    """Store the state that is reached."""
    row, place = progress.stored, progress.stored * chain.n_blocks
    for i in range(1, chain.n_blocks + 1):
        states.force[place + i - 1] = motion.spring_force[i]
        states.velocity[place + i - 1] = motion.velocity[i] * chain.speed
        states.mode[place + i - 1] = motion.mode[i]
    states.after[row], states.offset[row] = progress.transitions, progress.since * chain.tau
    progress.stored += 1


@inner_unfused
def time_left(limits, progress):
    """Time until the end of the run [tau]."""
    since_onset = (limits.duration - progress.onset) - progress.onset_error
    return since_onset / progress.tau - progress.elapsed


@inner_unfused
def rest(chain, motion, limits, progress, record):
    """All blocks stick: end the run, or wait in closed form until block 1 lets go."""
    if limits.until_global and progress.all_slid != 0:
        return STOPPED
    force, second = motion.spring_force, motion.force_rest
    block_1 = 1
    remaining = max(time_left(limits, progress), 0.0)
    loading_rate = chain.coupling[1] * chain.drive_velocity
    wait = max((chain.strength[1] - motion.net_force[1]) / loading_rate, 0.0)
    if wait >= remaining:
        force[1], second[1] = two_sum(force[1], loading_rate * remaining + second[1])
        start_clock(remaining, progress)
        return FINISHED
    if wait > 0.0:
        force[1], second[1] = two_sum(force[2], chain.strength[1] + second[2])
    take_net_force(block_1, motion)
    start_clock(wait, progress)
    set_mode(block_1, block_1, chain, motion)
    progress.farthest = 1
    count_sliding(1, chain, progress)
    note_transition(block_1, block_1, force[1], progress, record)
    return PAUSED


@seldom
def start_clock(wait, progress):
    """Start a new event `wait` after the end of the last; the onset is carried in two doubles."""
    add = (progress.elapsed + wait) * progress.tau + progress.onset_error
    total = progress.onset + add
    progress.onset_error = add - (total - progress.onset)
    progress.onset = total
    progress.elapsed = 0.0
    progress.since += wait


@inner
def count_sliding(more, chain, progress):
    """Count the blocks that slide, and note when all do."""
    progress.sliding += more
    if progress.sliding == chain.n_blocks:
        progress.all_slid = 1


@inner_unfused
def note_transition(i, new, load, progress, record):
    """Record that block i has a new mode now."""
    tau, k = progress.tau, progress.transitions
    record.time[k] = progress.onset + (progress.onset_error + progress.elapsed * tau)
    record.block[k], record.mode[k], record.tangential_load[k] = i, new, load
    record.intervals[k] = progress.since * tau
    progress.since = 0.0
    progress.transitions = k + 1


@inner_unfused
def slide(chain, motion, limits, progress, record):
    """Go through one window, to its first transition or to its end."""
    remaining = time_left(limits, progress)
    left_of_slip = limits.longest_slip / chain.tau - progress.elapsed
    if remaining <= 0.0:
        return FINISHED
    if left_of_slip <= 0.0:
        return STOPPED
    roundings = ROUNDINGS * 2.0 ** (progress.at_once // (4 * chain.n_blocks))
    progress.farthest = farthest_sliding(progress.farthest, motion.mode)
    window = min(WINDOW, min(remaining, left_of_slip))
    s, i, side = next_transition(window, roundings, chain, motion, progress)
    progress.elapsed += s
    progress.since += s
    progress.at_once = progress.at_once + 1 if s == 0.0 else 0
    if i == 0:
        return PAUSED
    old = motion.mode[i]
    new = resting_mode(i, roundings, chain, motion) if old != 0 else side
    set_mode(i, new, chain, motion)
    progress.farthest = max(progress.farthest, i)
    if new != old:
        count_sliding(abs(new) - abs(old), chain, progress)
        note_transition(i, new, motion.spring_force[1], progress, record)
    return PAUSED


@inner_unfused
def next_transition(window, roundings, chain, motion, progress):
    """Go to the first transition in a window: (time in it, block, side); (window, 0, 1) if there is none.

    Guess it, go there, and prove for all blocks at once that nothing comes before. A wrong guess costs time
    only: where the proof fails, the functions of those blocks are searched.
    """
    end = last_column(chain, progress.farthest)
    whole = motion.whole
    set_rows(end, motion)
    expand(2, PROOF_ORDER, end, chain, motion)
    begin(end, motion)
    if whole[1] != window:
        powers(window, PROOF_ORDER, whole)
    share, guessed = guess(end, motion)
    s, i, side = min(max(MARGIN * share, LEAST), 1.0) * window, 0, 1
    rows = order_at(s)
    expand(PROOF_ORDER + 2, rows, end, chain, motion)
    if guessed > 0:
        root = find_root(share * window, guessed, rows, motion, progress)
        if NEAR * window < root <= s:
            s, i = root, guessed
            side = -1 if motion.sign[i] > 0.0 else 1
    progress.derivatives += rows * end
    move(s, end, chain, motion)
    if prove(end, i, motion) != 0:
        share, found, found_side = search(order_at(s), end, roundings, chain, motion, progress)
        if share < 1.0:
            s, i, side = share * s, found, found_side
            move(s, end, chain, motion)
    return s, i, side


@inner
def last_column(chain, farthest):
    """Last column of the groups that take part: no block beyond the next one feels that `farthest` slides."""
    return WIDTH * ((min(farthest + 1, chain.n_blocks) + WIDTH - 1) // WIDTH)
