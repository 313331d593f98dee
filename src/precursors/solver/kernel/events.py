"""The event loop: run chains from their start and record each transition."""

from numba import int64

from precursors.model.chain import FREE, LEAST_SHARE
from precursors.solver.kernel.arrays import (
    BEARS_LOAD,
    COUPLING,
    FORCE_REST,
    MODE,
    NET_FORCE,
    SIGN,
    SPRING_FORCE,
    STRENGTH,
    VELOCITY,
    WHOLE,
)
from precursors.solver.kernel.decorators import (
    inner,
    outer,
    part,
    seldom,
    unfused,
)
from precursors.solver.kernel.friction import (
    farthest_sliding,
    is_at_rest,
    mode_at_rest,
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
    STOPPED,
    WIDTH,
    WINDOW,
)
from precursors.solver.kernel.proof import prove, search
from precursors.solver.kernel.roots import zero_below
from precursors.solver.kernel.series import (
    begin,
    expand,
    move,
    order_at,
    powers,
    take_net_force,
    two_sum,
)
from precursors.solver.kernel.units import set_up


@outer
def run_batch(batch, end, progress, record, states, motion, first, windows):
    """Run one chain after the other, beginning with chain `first`, into one record.

    Row j of `batch` is a chain with its start, and row j of `progress` is its progress.
    Return how many chains are finished, and how many rows and states they used. The
    loop stops before a new chain if the record is half full. It pauses the present
    chain if the record or the states are full, or after `windows` windows. The state of
    a paused chain is in `motion`, and its rows follow those of the others. To continue
    it, pass a record that begins with its rows.
    """
    n_blocks = batch.weights.shape[1]
    used = stored = 0
    for j in range(first, batch.weights.shape[0]):
        mine = progress[j]
        is_new = mine.stored == 0
        if is_new:
            is_full = 2 * used + n_blocks >= record.shape[0]
            if is_full or stored == states.shape[0]:
                return j, used, stored
            motion[:] = 0.0
        chain = set_up(batch.parameters[j], batch.weights[j], motion)
        my_record = record[used:]
        my_states = states[stored:]
        if is_new:
            start = batch.positions[j], batch.velocities[j], batch.weights[j]
            take_start(
                start, batch.parameters[j], chain, motion, mine, my_record, my_states
            )
        limits = (
            min(end.most, record.shape[0] - used - 1),
            states.shape[0] - stored,
            mine.windows + windows,
        )
        mine.status = find_transitions(
            chain, motion, end, limits, mine, my_record, my_states
        )
        note_time(mine, my_record)
        if (
            mine.status == PAUSED
            and mine.transitions < end.most
            and mine.windows < end.most_windows
        ):
            return j, used, stored
        used += mine.transitions + 1
        stored += mine.stored
    return batch.weights.shape[0], used, stored


@unfused
def take_start(start, parameters, chain, motion, progress, record, states):
    """Take a start at time 0.

    In the first state all blocks with a load stick. Those that move are recorded as
    transitions.
    """
    positions, velocities, weights = start
    mass, stiffness, spring, _, _, _ = parameters
    stiffest = farthest = before = 0.0
    least = LEAST_SHARE * weights.mean()
    for i in range(chain.n_blocks):
        stiffest = max(stiffest, spring)
        farthest = max(farthest, abs(positions[i]))
        motion[SPRING_FORCE, i + 1] = spring * (before - positions[i])
        motion[VELOCITY, i + 1] = velocities[i] * (mass / chain.tau)
        motion[MODE, i + 1] = 0 if weights[i] > 0.0 else FREE
        motion[BEARS_LOAD, i + 1] = 1.0 if weights[i] >= least else 0.0
        progress.loaded += 1 if weights[i] >= least else 0
        before = positions[i]
        spring = stiffness
    progress.tau = chain.tau
    progress.farthest = chain.n_blocks
    store_state(chain, motion, progress, states)
    for i in range(1, chain.n_blocks + 1):
        take_net_force(i, motion)
        if motion[MODE, i] == FREE:
            progress.free += 1
            count_sliding(1, i, motion, progress)
            take_mode(i, motion)
            continue
        # Positions are rounded, so a block within rounding of its limit still sticks.
        rounding = ROUNDINGS * (motion[STRENGTH, i] + 4.0 * stiffest * farthest)
        mode = mode_at_rest(motion[NET_FORCE, i], motion[STRENGTH, i] + rounding)
        if motion[VELOCITY, i] != 0.0:
            mode = 1 if motion[VELOCITY, i] > 0.0 else -1
        motion[MODE, i] = mode
        take_mode(i, motion)
        if mode != 0:
            count_sliding(1, i, motion, progress)
            note_transition(i, mode, motion[SPRING_FORCE, 1], progress, record)
    for i in range(1, chain.n_blocks + 1):
        take_neighbours(i, motion)


@part
def find_transitions(chain, motion, end, limits, progress, record, states):
    """Run a chain to its end, or to one of `limits`: of transitions, states and
    windows.

    On return, the state and `progress` are those of the time reached. The record and
    the states continue from where `progress` says.
    """
    status = PAUSED
    most, most_states, most_windows = limits
    while (
        status == PAUSED
        and progress.transitions < most
        and progress.stored < most_states
        and progress.windows < most_windows
    ):
        progress.windows += 1
        if progress.transitions >= progress.stride * progress.stored:
            store_state(chain, motion, progress, states)
        no_event = progress.sliding == progress.free
        after_global = progress.all_slid != 0 and progress.loaded_sliding == 0
        if end.until_global and after_global:
            status = STOPPED
        elif no_event and (progress.free == 0 or is_at_rest(chain, motion)):
            status = rest(chain, motion, end, progress, record)
        else:
            status = slide(chain, motion, end, progress, record)
    return status


@seldom
def store_state(chain, motion, progress, states):
    """Store the present state (see `record.States.from_rows`)."""
    n = chain.n_blocks
    state = states[progress.stored]
    state[0] = progress.transitions
    state[1] = progress.since * chain.tau
    for i in range(1, n + 1):
        state[i + 1] = motion[SPRING_FORCE, i]
        state[i + 1 + n] = motion[VELOCITY, i] * chain.speed
        state[i + 1 + 2 * n] = motion[MODE, i]
    progress.stored += 1


@part
def time_left(end, progress):
    """Return the time until the end of the run [tau]."""
    since_onset = (end.duration - progress.onset) - progress.onset_error
    return since_onset / progress.tau - progress.elapsed


@part
def rest(chain, motion, end, progress, record):
    """End the run if nothing moves any more; otherwise skip to the release of block
    1."""
    block_1 = int64(1)
    remaining = max(time_left(end, progress), 0.0)
    loading_rate = motion[COUPLING, 1] * chain.drive_velocity
    wait = max((motion[STRENGTH, 1] - motion[NET_FORCE, 1]) / loading_rate, 0.0)
    if wait >= remaining:
        start_clock(remaining, progress)
        return FINISHED
    if wait > 0.0:
        motion[SPRING_FORCE, 1], motion[FORCE_REST, 1] = two_sum(
            motion[SPRING_FORCE, 2], motion[STRENGTH, 1] + motion[FORCE_REST, 2]
        )
    take_net_force(block_1, motion)
    start_clock(wait, progress)
    set_mode(block_1, block_1, chain, motion)
    count_sliding(1, block_1, motion, progress)
    note_transition(block_1, block_1, motion[SPRING_FORCE, 1], progress, record)
    return PAUSED


@seldom
def start_clock(wait, progress):
    """Start a new event at a time `wait` after the last; the onset has two doubles."""
    add = (progress.elapsed + wait) * progress.tau + progress.onset_error
    total = progress.onset + add
    progress.onset_error = add - (total - progress.onset)
    progress.onset = total
    progress.elapsed = 0.0
    progress.since += wait


@inner
def count_sliding(more, i, motion, progress):
    """Count `more` sliding blocks, and note whether all blocks that bear load slide at
    once."""
    progress.sliding += more
    if motion[BEARS_LOAD, i] > 0.0:
        progress.loaded_sliding += more
        if progress.loaded_sliding == progress.loaded:
            progress.all_slid = 1


@part
def note_time(progress, record):
    """Write the time into the row after the last transition, and return the row."""
    row = record[progress.transitions]
    row[0] = progress.onset + (progress.onset_error + progress.elapsed * progress.tau)
    row[4] = progress.since * progress.tau
    return row


@part
def note_transition(i, new, load, progress, record):
    """Record the new mode of block i."""
    row = note_time(progress, record)
    row[1] = i
    row[2] = new
    row[3] = load
    progress.since = 0.0
    progress.transitions += 1


@part
def slide(chain, motion, end, progress, record):
    """Move through one window, to its first transition or to its end."""
    if progress.sliding == progress.free:
        # Only blocks without load move, which does not count as an event.
        start_clock(0.0, progress)
    remaining = time_left(end, progress)
    if remaining <= 0.0:
        return FINISHED
    roundings = ROUNDINGS * 2.0 ** (progress.at_once // (4 * chain.n_blocks))
    progress.farthest = farthest_sliding(progress.farthest, motion)
    window = min(WINDOW, remaining)
    s, i, side = next_transition(window, roundings, chain, motion, progress)
    progress.elapsed += s
    progress.since += s
    progress.at_once = progress.at_once + 1 if s == 0.0 else 0
    if i == 0:
        return PAUSED
    old = int(motion[MODE, i])
    new = side
    if old != 0:
        # A block that stops at its limit sticks; if its force still grows, its margin
        # releases it at once.
        new = mode_at_rest(
            motion[NET_FORCE, i],
            motion[STRENGTH, i] + zero_below(i, roundings, motion),
        )
    set_mode(i, new, chain, motion)
    progress.farthest = max(progress.farthest, i)
    if new != old:
        count_sliding(abs(new) - abs(old), i, motion, progress)
        note_transition(i, new, motion[SPRING_FORCE, 1], progress, record)
    return PAUSED


@part
def next_transition(window, roundings, chain, motion, progress):
    """Move to the first transition in a window; return (time, block, side).

    Without a transition these are (window, 0, 1).
    """
    end = last_column(chain, progress.farthest)
    begin(end, motion)
    expand(int64(2), int64(PROOF_ORDER), end, motion)
    if motion[WHOLE, 1] != window:
        powers(window, PROOF_ORDER, WHOLE, motion)
    share, guessed = guess(end, motion)
    s = min(max(MARGIN * share, LEAST), 1.0) * window
    i = 0
    side = 1
    rows = order_at(s)
    expand(int64(PROOF_ORDER + 2), rows, end, motion)
    if guessed > 0:
        root = find_root(share * window, guessed, rows, motion, progress)
        if NEAR * window < root <= s:
            s = root
            i = guessed
            side = -1 if motion[SIGN, i] > 0.0 else 1
    progress.derivatives += rows * end
    move(s, end, chain, motion)
    if prove(end, i, motion) != 0:
        share, block, its_side = search(order_at(s), end, roundings, motion, progress)
        if share < 1.0:
            s = share * s
            i = block
            side = its_side
            move(s, end, chain, motion)
    return s, i, side


@inner
def last_column(chain, farthest):
    """Return the last column of the groups that can move or feel a motion.

    Block `farthest` slides; its motion is felt up to the next block.
    """
    return WIDTH * ((min(farthest + 1, chain.n_blocks) + WIDTH - 1) // WIDTH)
