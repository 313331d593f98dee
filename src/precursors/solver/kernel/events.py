"""The event loop: chains from their start, transition after transition, into a record."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.arrays import (
    MOTION_AT,
    RECORD_AT,
    SEARCH_AT,
    STATE_AT,
    STATES_AT,
    Columns,
    Limits,
    Motion,
    Record,
    Search,
    State,
    States,
    Window,
)
from precursors.solver.kernel.compiled import inner, outer, seldom, unfused
from precursors.solver.kernel.friction import farthest_sliding, resting_mode, set_mode, start_from, take_mode
from precursors.solver.kernel.layout import (
    BETWEEN_LOOKS,
    BEYOND,
    DERIVATIVES,
    ELAPSED,
    FINISHED,
    GLOBAL,
    GLOBAL_SLIP,
    LEVELS,
    LONG,
    LONG_WINDOW,
    ONSET,
    ONSET_ERROR,
    PAUSED,
    ROUNDINGS,
    ROWS,
    SHORT_WINDOW,
    SINCE,
    SLIDING,
    STATUS,
    STORED,
    TRANSITIONS,
    WIDTH,
    WINDOWS,
    WINDOWS_PER_STATE,
)
from precursors.solver.kernel.ringing import leap, prepare_leaps
from precursors.solver.kernel.series import (
    distance_reached,
    expand,
    give_back,
    lend,
    order_for,
    powers,
    settle,
)
from precursors.solver.kernel.springs import load_at, on_springs, stretch
from precursors.solver.kernel.units import set_up
from precursors.solver.kernel.watch import next_transition, watch


@outer
def run_batch(
    parameters,
    weights,
    positions,
    velocities,
    duration,
    until_global,
    room,
    state_room,
    budget,
    is_begun,
    stride,
    additions,
    ringing,
    taus,
    clocks,
    counts,
    *arrays,
):
    """Run chain after chain from its start, as many as there is room for, into one record.

    Row j of `parameters`, `weights`, `positions` and `velocities` is a chain with its start, row j of `taus`,
    `clocks` and `counts` where it ended. Limits are those of each chain, and `arrays` those of a `Room`, one
    by one, as Numba takes microseconds to look into tuples. Returns how many chains are finished and whether
    the one after them is not: its state is in the room, and what it recorded follows that of the others. It
    goes on from there where it is all there is, and `is_begun`.
    """
    limits = Limits(duration, until_global, room, state_room, budget)
    chain, state = Columns(*arrays[:STATE_AT]), State(*arrays[STATE_AT:MOTION_AT])
    motion = Motion(*arrays[MOTION_AT:SEARCH_AT])
    search = Search(*arrays[SEARCH_AT:RECORD_AT])
    record, states = Record(*arrays[RECORD_AT:STATES_AT]), States(*arrays[STATES_AT:])
    used = stored = windows = 0
    n_blocks = weights.shape[1]
    for j in range(weights.shape[0]):
        clock, count = clocks[j], counts[j]
        if not is_begun:
            full = used + max(limits.room, n_blocks) > record.time.shape[0]
            if full or stored + limits.state_room > states.after.shape[0] or windows > limits.budget:
                return j, False
            forget(chain, additions, state, clock, count)
        mine, my_states = rest_of_record(record, used, j), rest_of_states(states, stored)
        tau, drive_velocity = set_up(parameters[j], weights[j], chain, additions)
        if not is_begun:
            start_from(positions[j], velocities[j], parameters[j], tau, chain, additions, state)
            note_start(state, count, mine, my_states, additions)
        taus[j] = tau
        count[STATUS] = run_events(
            tau,
            drive_velocity,
            limits,
            chain,
            additions,
            ringing,
            state,
            motion,
            search,
            clock,
            count,
            mine,
            my_states,
            stride,
        )
        if count[STATUS] == PAUSED:
            return j, True
        used += count[TRANSITIONS]
        stored += count[STORED]
        windows += count[WINDOWS]
        record.intervals[used + j] = clock[SINCE] * tau
    return weights.shape[0], False


@seldom
def forget(chain, additions, state, clock, count):
    """Clear what the chain before has left."""
    for values in chain:
        clear(values)
    for values in (state.velocity, state.tension, clock):
        clear(values)
    if additions is not None:
        for values in additions:
            clear(values)
    for i in range(state.mode.shape[0]):
        state.mode[i] = 0
    for i in range(count.shape[0]):
        count[i] = 0


@inner
def clear(values):
    """Set all values to zero."""
    for i in range(values.shape[0]):
        values[i] = 0.0


@inner
def rest_of_record(record, used, n_runs):
    """What is left of a record after `n_runs` runs; each leaves one interval more than transitions."""
    return Record(
        record.time[used:],
        record.block[used:],
        record.mode[used:],
        record.tangential_load[used:],
        record.intervals[used + n_runs :],
    )


@inner
def rest_of_states(states, stored):
    """What is left of the states after the first `stored`."""
    return States(
        states.force[stored:],
        states.velocity[stored:],
        states.mode[stored:],
        states.after[stored:],
        states.offset[stored:],
        states.grip[stored:],
    )


@seldom
def note_start(state, count, record, states, additions):
    """Record the blocks that move at time 0 as transitions; the first state is the start with all modes 0."""
    mode = state.mode
    if additions is not None:
        for i in range(mode.shape[0]):
            states.grip[0, i] = additions.grip[i]
    k = 0
    n_blocks = mode.shape[0] - 1 - BEYOND
    for i in range(mode.shape[0]):
        states.force[0, i], states.velocity[0, i], states.mode[0, i] = state.tension[i], state.velocity[i], 0
        if mode[i] != 0:
            record.time[k], record.block[k], record.mode[k] = 0.0, i, mode[i]
            record.tangential_load[k], record.intervals[k] = state.tension[1], 0.0
            k += 1
    states.after[0], states.offset[0] = 0, 0.0
    count[TRANSITIONS] = count[SLIDING] = k
    count[GLOBAL] = 1 if k == n_blocks else 0
    count[STORED] = 1


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
def with_rate(m, rate):
    """The same motion with the Taylor rows in another array."""
    return Motion(rate, *m[1:])


@inner
def of_known_widths(search):
    """Tell the compiler the widths of the series, which saves a product each time one is looked into."""
    series, level = lanes.of_width(search.series, ROWS + 1), lanes.of_width(search.level, LEVELS)
    return Search(series, level, search.terms, search.stage, search.bound, search.active)


@seldom
def lay_out(drive_velocity, chain, additions, state, motion):
    """Set the motion out from a state; column 0 is the drive, what is beyond the blocks does not move."""
    for values in (motion.mobile, motion.sense, motion.push, motion.slip, motion.origins, motion.fastest):
        clear(values)
    for n in range(ROWS + 1):
        clear(motion.rate[n])
    motion.rate[0, 0] = motion.fastest[0] = drive_velocity
    for i in range(1, state.mode.shape[0] - BEYOND):
        motion.rate[0, i] = state.velocity[i]
        take_mode(i, state.mode, chain, additions, motion)


@seldom
def store_state(n_transitions, offset, additions, state, rate, states, count):
    """Store the state `offset` [s] after the last transition."""
    c = count[STORED]
    for i in range(state.mode.shape[0]):
        states.force[c, i], states.velocity[c, i], states.mode[c, i] = (
            state.tension[i],
            rate[0, i],
            state.mode[i],
        )
        if additions is not None:
            states.grip[c, i] = additions.grip[i]
    states.after[c], states.offset[c] = n_transitions, offset
    count[STORED] += 1


@seldom
def widen(end, t, order, tension, motion):
    """Let four more columns beyond `end` take part from time t of the window on."""
    for j in range(end + 1, end + WIDTH + 2):
        for n in range(order + 1):
            motion.rate[n, j] = 0.0
        motion.slip[j], motion.origins[j], motion.tension_before[j] = 0.0, t, tension[j]
        motion.fastest[j] = 0.0


@unfused
def run_events(
    tau,
    drive_velocity,
    limits,
    chain,
    additions,
    ringing,
    state,
    motion,
    search,
    clock,
    count,
    record,
    states,
    stride,
):
    """Run a chain until `duration` [s], the end of the first global slip, full buffers or a spent budget.

    `state`, the grip in `additions`, `clock` and `count` are left at the state reached. `record` is filled
    from count[TRANSITIONS] on; after every `stride` transitions or so a state goes to `states`.
    """
    coupling, strength = chain.coupling, chain.strength
    tension, mode = state.tension, state.mode
    rate, slip, origins, tension_before = motion.rate, motion.slip, motion.origins, motion.tension_before
    behind, ahead = motion.behind, motion.ahead
    n_blocks = mode.shape[0] - 1 - BEYOND
    lay_out(drive_velocity, chain, additions, state, motion)
    motion = with_rate(motion, lanes.of_width(motion.rate, state.mode.shape[0]))
    rate = motion.rate
    search = of_known_widths(search)
    farthest = farthest_sliding(n_blocks, mode)
    loading_rate = coupling[1] * drive_velocity
    short_order, long_order = order_for(SHORT_WINDOW), order_for(LONG_WINDOW)
    k = count[TRANSITIONS]
    sliding = count[SLIDING]
    status = PAUSED
    idle = 0
    doubt = ROUNDINGS
    springy = False
    if additions is not None:
        springy = on_springs(additions)
        since_state = until_look = 0
        for values in (ringing.lost, ringing.lost_grip, ringing.pivot):
            clear(values)
    last_window = count[WINDOWS] + limits.budget
    while k < limits.room and count[WINDOWS] < last_window and count[STORED] < limits.state_room:
        count[WINDOWS] += 1
        store = k >= stride * count[STORED]
        if additions is not None and springy:
            since_state += 1
            store = since_state > WINDOWS_PER_STATE * stride
        if store:
            store_state(k, clock[SINCE] * tau, additions, state, rate, states, count)
            if additions is not None:
                since_state = 0
        remaining = ((limits.duration - clock[ONSET]) - clock[ONSET_ERROR]) / tau - clock[ELAPSED]
        if sliding == 0 and limits.until_global and count[GLOBAL] != 0:
            status = GLOBAL_SLIP
            break
        if sliding == 0 and not springy:
            wait = max((strength[1] - (tension[1] - tension[2])) / loading_rate, 0.0)
            if wait >= remaining:
                remaining = max(remaining, 0.0)
                tension[1] += loading_rate * remaining
                start_clock(clock, remaining, tau)
                status = FINISHED
                break
            if wait > 0.0:
                tension[1] = tension[2] + strength[1]
            start_clock(clock, wait, tau)
            first = 1
            set_mode(first, first, chain, additions, state, motion)
            sliding = farthest = 1
            if n_blocks == 1:
                count[GLOBAL] = 1
            record.time[k] = clock[ONSET] + clock[ONSET_ERROR]
            record.block[k], record.mode[k], record.tangential_load[k] = 1, 1, tension[1]
            record.intervals[k] = clock[SINCE] * tau
            clock[SINCE] = 0.0
            k += 1
            continue
        if remaining <= 0.0:
            status = FINISHED
            break
        if additions is not None and springy and sliding == 0:
            until_look -= 1
            if until_look < 0:
                until_look = BETWEEN_LOOKS
                if ringing.pivot[1] == 0.0:
                    prepare_leaps(drive_velocity, chain, additions, ringing)
                power = leap(remaining, chain, additions, ringing, tension, motion)
                if power >= 0:
                    until_look = 0
                    t = SHORT_WINDOW * 2.0**power
                    slip[0] = drive_velocity * t
                    first = 1
                    stretch(first, n_blocks, chain, additions, ringing, state, motion)
                    clock[ELAPSED] += t
                    clock[SINCE] += t
                    since_state += 2**power
                    count[DERIVATIVES] += 4 * n_blocks * n_blocks
                    continue
        # A window: the state is that of its start, and every series has its origin there.
        farthest = farthest_sliding(farthest, mode)
        last = min(farthest + 1, n_blocks)
        end = WIDTH * ((last + WIDTH - 1) // WIDTH)
        if additions is not None and springy:
            last = n_blocks
            end = WIDTH * ((last + WIDTH - 1) // WIDTH)
        is_long = last > LONG
        if additions is not None and springy:
            is_long = False
        order = long_order if is_long else short_order
        limit = min(LONG_WINDOW if is_long else SHORT_WINDOW, remaining)
        for i in range(end + 2):
            tension_before[i] = tension[i]
            slip[i] = origins[i] = 0.0
        for n in range(order + 1):
            rate[n, end + 1] = 0.0
        motion.fastest[end + 1] = 0.0
        search.active[0] = 0
        first, final = 1, end
        noted = 0.0
        t = 0.0
        while True:
            expand(first, final, order, chain.coupling, additions, tension, motion)
            count[DERIVATIVES] += order * (final - first + 1)
            powers(limit - t, order, motion.weight)
            window = Window(t, limit - t, order, first, final, min(final, last), end, is_long, doubt)
            watch(window, chain, additions, state, motion, search)
            if first > 1:
                give_back(first - 1, order, motion, behind)
            if final < end:
                give_back(final + 1, order, motion, ahead)
            t, slot = next_transition(limit, t, order, chain, additions, state, motion, search, count)
            slip[0] = drive_velocity * t
            idle = idle + 1 if t == noted else 0
            doubt = ROUNDINGS * 2.0 ** (idle // (4 * n_blocks))
            if slot < 0:
                break
            i = slot // 2
            if is_long:
                if i == last and last < n_blocks:
                    last += 1
                    if last > end:
                        widen(end, t, order, tension, motion)
                        end += WIDTH
                distance = distance_reached(limit - t, additions)
                first = WIDTH * ((max(i - distance, 1) - 1) // WIDTH) + 1
                final = min(WIDTH * ((i + distance + WIDTH - 1) // WIDTH), end)
                if first > 1:
                    lend(first - 1, t, order, motion, behind)
                if final < end:
                    lend(final + 1, t, order, motion, ahead)
            settle(t, first, final, order, motion)
            stretch(first, final, chain, additions, ringing, state, motion)
            old = mode[i]
            new = (
                resting_mode(i, doubt, chain, additions, tension, motion) if old != 0 else 1 - 2 * (slot % 2)
            )
            set_mode(i, new, chain, additions, state, motion)
            farthest = max(farthest, i)
            if new != old:
                sliding += abs(new) - abs(old)
                if sliding == n_blocks:
                    count[GLOBAL] = 1
                load = tension[1]
                if first > 1:
                    load = load_at(t, order, coupling, motion)
                record.time[k] = clock[ONSET] + (clock[ONSET_ERROR] + (clock[ELAPSED] + t) * tau)
                record.block[k], record.mode[k], record.tangential_load[k] = i, new, load
                record.intervals[k] = (clock[SINCE] + (t - noted)) * tau
                clock[SINCE] = 0.0
                noted = t
                k += 1
            if not is_long:
                break
            if sliding == 0 or k == limits.room:
                if first > 1:
                    give_back(first - 1, order, motion, behind)
                if final < end:
                    give_back(final + 1, order, motion, ahead)
                break
        if is_long or slot < 0:
            first = 1
            settle(t, first, end, order, motion)
            stretch(first, end, chain, additions, ringing, state, motion)
        clock[ELAPSED] += t
        clock[SINCE] += t - noted
    count[TRANSITIONS] = k
    count[SLIDING] = sliding
    for i in range(1, n_blocks + 1):
        state.velocity[i] = rate[0, i]
    return status
