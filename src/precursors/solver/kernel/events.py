"""The event loop: chains from their start, transition after transition, into a record."""

from __future__ import annotations

from precursors.solver.kernel.arrays import Progress, Record, System, Window, divide
from precursors.solver.kernel.compiled import inner, inner_unfused, outer, seldom, unfused
from precursors.solver.kernel.friction import farthest_sliding, resting_mode, set_mode, start_from, take_mode
from precursors.solver.kernel.layout import (
    AT_ONCE,
    BEYOND,
    DERIVATIVES,
    EDGE,
    ELAPSED,
    FARTHEST,
    FINISHED,
    GLOBAL,
    LONG,
    ONSET,
    ONSET_ERROR,
    ORDER,
    PAUSED,
    ROUNDINGS,
    ROWS,
    SINCE,
    SLIDING,
    STATUS,
    STOPPED,
    STORED,
    TRANSITIONS,
    WIDTH,
    WINDOW,
    WINDOWS,
)
from precursors.solver.kernel.pointers import pointer, shifted, table
from precursors.solver.kernel.series import (
    distance_reached,
    expand,
    give_back,
    lend,
    powers,
    settle,
)
from precursors.solver.kernel.springs import begin, load_at, net_force, stretch, two_sum
from precursors.solver.kernel.units import set_up
from precursors.solver.kernel.watch import next_transition, watch
from precursors.solver.record import States


@outer
def run_batch(batch, limits, progress, record, states, memory):
    """Run chain after chain from its start, as many as there is room for, into one record.

    Row j of `batch` is a chain with its start, row j of `progress` where it ended. Limits are those of each
    chain. Returns how many chains are finished and whether the one after them is paused: its state is in
    `memory`, and what it recorded follows that of the others. It can go on where it is all there is.
    """
    n_blocks = batch.weights.shape[1]
    columns, motion, search = divide(memory, n_blocks)
    used = stored = windows = 0
    for j in range(batch.weights.shape[0]):
        if not limits.goes_on:
            full = used + max(limits.transitions, n_blocks) > record.time.shape[0]
            if full or stored + limits.states > states.after.shape[0] or windows > limits.windows:
                return j, False
            forget(columns, n_blocks, motion)
        tau, speed, drive_velocity = set_up(batch.parameters[j], batch.weights[j], n_blocks, columns)
        chain = System(n_blocks, tau, speed, drive_velocity, columns[0], columns[1], columns[2])
        reached = Progress(tau, pointer(progress.clock[j]), pointer(progress.counts[j]))
        count = reached.counts
        mine, my_states = rest_of_record(record, used, j), rest_of_states(states, stored, n_blocks)
        if not limits.goes_on:
            start_from(batch.positions[j], batch.velocities[j], batch.parameters[j], chain, motion)
            note_start(chain, motion, count, mine, my_states)
        progress.tau[j] = tau
        count[STATUS] = run_events(chain, motion, search, limits, reached, mine, my_states)
        if count[STATUS] == PAUSED:
            return j, True
        used += count[TRANSITIONS]
        stored += count[STORED]
        windows += count[WINDOWS]
        record.intervals[used + j] = progress.clock[j, SINCE] * tau
    return batch.weights.shape[0], False


@seldom
def forget(columns, n_blocks, motion):
    """Clear what the chain before has left."""
    for values in columns:
        clear(values, n_blocks)
    clear(motion.velocity, n_blocks)
    clear(motion.spring_force, n_blocks)
    clear(motion.force_rest, n_blocks)
    for i in range(n_blocks + 1 + BEYOND):
        motion.mode[i] = 0


@inner
def clear(values, n_blocks):
    """Set all columns to zero."""
    for i in range(n_blocks + 1 + BEYOND):
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
    """What is left of the states after the first `stored`; modes are a row after the other."""
    return States(
        table(shifted(pointer(states.force), stored * n_blocks), n_blocks),
        table(shifted(pointer(states.velocity), stored * n_blocks), n_blocks),
        shifted(pointer(states.mode), stored * n_blocks),
        shifted(pointer(states.after), stored),
        shifted(pointer(states.offset), stored),
    )


@seldom
def note_start(chain, motion, count, record, states):
    """Record the blocks that move at time 0 as transitions; the first state is the start with all modes 0."""
    mode = motion.mode
    k = 0
    for i in range(1, chain.n_blocks + 1):
        states.force[0, i - 1] = motion.spring_force[i]
        states.velocity[0, i - 1] = motion.velocity[i] * chain.speed
        states.mode[i - 1] = 0
        if mode[i] != 0:
            record.time[k], record.block[k], record.mode[k] = 0.0, i, mode[i]
            record.tangential_load[k], record.intervals[k] = motion.spring_force[1], 0.0
            k += 1
    states.after[0], states.offset[0] = 0, 0.0
    count[TRANSITIONS] = count[SLIDING] = k
    count[GLOBAL] = 1 if k == chain.n_blocks else 0
    count[STORED] = 1


@unfused
def run_events(chain, motion, search, limits, progress, record, states):
    """Run a chain until `duration` [s], the end of the first global slip, full records or enough windows.

    The state, `clock` and `count` are left at the time reached; record and states are filled from where
    `count` says.
    """
    clock, count = progress.clock, progress.counts
    lay_out(chain, motion)
    count[AT_ONCE] = 0
    count[FARTHEST] = chain.n_blocks
    status = PAUSED
    last_window = count[WINDOWS] + limits.windows
    while (
        status == PAUSED
        and count[TRANSITIONS] < limits.transitions
        and count[WINDOWS] < last_window
        and count[STORED] < limits.states
    ):
        count[WINDOWS] += 1
        if count[TRANSITIONS] >= limits.stride * count[STORED]:
            store_state(chain, motion, clock, count, states)
        if count[SLIDING] == 0:
            status = rest(chain, motion, limits, progress, record)
        else:
            status = slide(chain, motion, search, limits, progress, record)
    for i in range(1, chain.n_blocks + 1):
        motion.velocity[i] = motion.rate[0, i]
    return status


@seldom
def lay_out(chain, motion):
    """Set the motion out from a state; column 0 is the drive, what is beyond the blocks does not move."""
    for values in (motion.slides, motion.sense, motion.push, motion.slip, motion.origins, motion.fastest):
        clear(values, chain.n_blocks)
    for n in range(ROWS + 1):
        for i in range(chain.n_blocks + 1 + BEYOND):
            motion.rate[n, i] = 0.0
    motion.rate[0, 0] = motion.fastest[0] = chain.drive_velocity
    for i in range(1, chain.n_blocks + 1):
        motion.rate[0, i] = motion.velocity[i]
        take_mode(i, chain, motion)


@seldom
def store_state(chain, motion, clock, count, states):
    """Store the state that is reached."""
    c = count[STORED]
    for i in range(1, chain.n_blocks + 1):
        states.force[c, i - 1] = motion.spring_force[i]
        states.velocity[c, i - 1] = motion.rate[0, i] * chain.speed
        states.mode[c * chain.n_blocks + i - 1] = motion.mode[i]
    states.after[c], states.offset[c] = count[TRANSITIONS], clock[SINCE] * chain.tau
    count[STORED] += 1


@inner_unfused
def time_left(chain, limits, clock):
    """Time until the end of the run [tau]."""
    return ((limits.duration - clock[ONSET]) - clock[ONSET_ERROR]) / chain.tau - clock[ELAPSED]


@inner_unfused
def rest(chain, motion, limits, progress, record):
    """All blocks stick: end the run, or wait in closed form until block 1 lets go."""
    clock, count = progress.clock, progress.counts
    if limits.until_global and count[GLOBAL] != 0:
        return STOPPED
    force, second = motion.spring_force, motion.force_rest
    first = 1
    remaining = time_left(chain, limits, clock)
    loading_rate = chain.coupling[1] * chain.drive_velocity
    wait = max((chain.strength[1] - net_force(first, motion)) / loading_rate, 0.0)
    if wait >= remaining:
        remaining = max(remaining, 0.0)
        force[1], second[1] = two_sum(force[1], loading_rate * remaining + second[1])
        start_clock(clock, remaining, chain.tau)
        return FINISHED
    if wait > 0.0:
        force[1], second[1] = two_sum(force[2], chain.strength[1] + second[2])
    start_clock(clock, wait, chain.tau)
    set_mode(first, first, chain, motion)
    count[FARTHEST] = 1
    count_sliding(1, chain, count)
    note_transition(first, first, 0.0, clock[SINCE], force[1], progress, record)
    return PAUSED


@seldom
def start_clock(clock, wait, tau):
    """Start a new event `wait` after the end of the last; the onset is carried in two doubles."""
    add = (clock[ELAPSED] + wait) * tau + clock[ONSET_ERROR]
    total = clock[ONSET] + add
    clock[ONSET_ERROR] = add - (total - clock[ONSET])
    clock[ONSET] = total
    clock[ELAPSED] = 0.0
    clock[SINCE] += wait


@inner
def count_sliding(more, chain, count):
    """Count the blocks that slide, and note when all do."""
    count[SLIDING] += more
    if count[SLIDING] == chain.n_blocks:
        count[GLOBAL] = 1


@inner_unfused
def note_transition(i, new, t, since, load, progress, record):
    """Record that block i has a new mode from time t of the window, `since` [tau] after the last change."""
    clock, tau, k = progress.clock, progress.tau, progress.counts[TRANSITIONS]
    record.time[k] = clock[ONSET] + (clock[ONSET_ERROR] + (clock[ELAPSED] + t) * tau)
    record.block[k], record.mode[k], record.tangential_load[k] = i, new, load
    record.intervals[k] = since * tau
    clock[SINCE] = 0.0
    progress.counts[TRANSITIONS] = k + 1


@inner_unfused
def slide(chain, motion, search, limits, progress, record):
    """Go through one window: to the next transition, to all of them in a long chain, or to its end."""
    clock, count = progress.clock, progress.counts
    remaining = time_left(chain, limits, clock)
    left_of_slip = limits.longest_slip / chain.tau - clock[ELAPSED]
    if remaining <= 0.0:
        return FINISHED
    if left_of_slip <= 0.0:
        return STOPPED
    window = open_window(min(remaining, left_of_slip), chain, motion, search, count)
    t = noted = 0.0
    slot = -1
    while True:
        t, slot = look_ahead(window, chain, motion, search, count)
        motion.slip[0] = chain.drive_velocity * t
        count[AT_ONCE] = count[AT_ONCE] + 1 if t == noted else 0
        if slot < 0:
            break
        i = slot // 2
        window = around(i, t, window, chain, motion, count)
        settle(t, window.first, window.final, motion)
        stretch(window.first, window.final, chain, motion)
        old = motion.mode[i]
        new = resting_mode(i, window.roundings, chain, motion) if old != 0 else 1 - 2 * (slot % 2)
        set_mode(i, new, chain, motion)
        count[FARTHEST] = max(count[FARTHEST], i)
        if new != old:
            count_sliding(abs(new) - abs(old), chain, count)
            load = load_at(t, chain, motion) if window.first > 1 else motion.spring_force[1]
            note_transition(i, new, t, clock[SINCE] + (t - noted), load, progress, record)
            noted = t
        if not window.is_long:
            break
        if count[SLIDING] == 0 or count[TRANSITIONS] == limits.transitions:
            return_neighbours(window, motion)
            break
    if window.is_long or slot < 0:
        first = 1
        settle(t, first, window.end, motion)
        stretch(first, window.end, chain, motion)
    clock[ELAPSED] += t
    clock[SINCE] += t - noted
    return PAUSED


@inner_unfused
def open_window(remaining, chain, motion, search, count):
    """A window from now on, in which every series has its origin at the start."""
    count[FARTHEST] = farthest_sliding(count[FARTHEST], motion.mode)
    last = min(count[FARTHEST] + 1, chain.n_blocks)
    end = WIDTH * ((last + WIDTH - 1) // WIDTH)
    is_long = last > LONG
    limit = min(WINDOW, remaining)
    begin(end, motion)
    if count[EDGE] != end:
        count[EDGE] = end
        for n in range(ORDER + 1):
            motion.rate[n, end + 1] = 0.0
    motion.fastest[end + 1] = 0.0
    search.active[0] = 0
    return Window(0.0, limit, limit, 1, end, last, end, is_long, roundings_now(chain, count))


@inner_unfused
def roundings_now(chain, count):
    """Relative size below which a value counts as zero, larger where rounding decides in a circle."""
    if count[AT_ONCE] < 4 * chain.n_blocks:
        return ROUNDINGS
    return ROUNDINGS * 2.0 ** (count[AT_ONCE] // (4 * chain.n_blocks))


@inner_unfused
def look_ahead(window, chain, motion, search, count):
    """The next transition of the window: (time in it, slot); (limit, -1) where there is none."""
    expand(window.first, window.final, chain, motion)
    count[DERIVATIVES] += ORDER * (window.final - window.first + 1)
    if motion.weight[1] != window.span:
        powers(window.span, motion.weight)
    watch(window, chain, motion, search)
    return_neighbours(window, motion)
    return next_transition(window, chain, motion, search, count)


@inner_unfused
def around(i, t, window, chain, motion, count):
    """The rest of the window, in which only blocks near block i feel its transition at time t."""
    span, last, end = window.limit - t, window.last, window.end
    first, final = window.first, window.final
    if window.is_long:
        if i == last and last < chain.n_blocks:
            last += 1
            if last > end:
                widen(end, t, motion)
                count[EDGE] = 0
                end += WIDTH
        distance = distance_reached(span)
        first = WIDTH * ((max(i - distance, 1) - 1) // WIDTH) + 1
        final = min(WIDTH * ((i + distance + WIDTH - 1) // WIDTH), end)
        if first > 1:
            lend(first - 1, t, motion, motion.behind)
        if final < end:
            lend(final + 1, t, motion, motion.ahead)
    return Window(t, span, window.limit, first, final, last, end, window.is_long, roundings_now(chain, count))


@inner_unfused
def return_neighbours(window, motion):
    """Give the neighbours of blocks first..final their own series back."""
    if window.first > 1:
        give_back(window.first - 1, motion, motion.behind)
    if window.final < window.end:
        give_back(window.final + 1, motion, motion.ahead)


@seldom
def widen(end, t, motion):
    """Let four more columns beyond `end` take part from time t of the window on."""
    for j in range(end + 1, end + WIDTH + 2):
        for n in range(ORDER + 1):
            motion.rate[n, j] = 0.0
        motion.slip[j], motion.origins[j] = 0.0, t
        motion.force_before[j], motion.rest_before[j] = motion.spring_force[j], motion.force_rest[j]
        motion.fastest[j] = 0.0
