"""A run knows the motion at every time, and its file gives back every bit or is refused."""

from dataclasses import replace
from io import BytesIO

import h5py
import numpy as np
import pytest
from chains import first_transitions

from precursors import Chain, Run, RunFileError, simulate
from precursors.model.statics import maximal_strain_positions
from precursors.solver.run import States

POSITION_ROUNDING = 1e-19  # m; roundings of V t, which is 3e-5 m here
FORCE_ROUNDING = (
    1e-11  # N; a transition's own time is known to 4e-16 s only, and F_X changes by up to 1e6 N/s
)


@pytest.fixture(scope="module")
def run():
    return simulate(Chain.from_slider(theta="-5/6"), duration=3.0)


@pytest.mark.parametrize("n_blocks", [1, 4, 5, 10, 30])
def test_the_load_at_a_transition_is_the_one_recorded(n_blocks):
    run = simulate(Chain.from_slider(n_blocks=n_blocks, theta="-5/6"), duration=3.0)
    times, loads = run.transitions["time"], run.transitions["tangential_load"]
    np.testing.assert_allclose(run.tangential_load(times), loads, rtol=0, atol=1e-8)


def test_load_and_positions_obey_eq_3(run):
    times = np.linspace(0.0, run.duration, 1001)
    positions, _ = run.at(times)
    expected = run.chain.drive_stiffness * (run.chain.drive_velocity * times - positions[:, 0])
    np.testing.assert_allclose(run.tangential_load(times), expected, rtol=0, atol=FORCE_ROUNDING)


def test_velocities_are_the_slope_of_the_positions(run):
    onset, after = run.transitions["time"][-20], 1e-9
    times = onset + np.array([0.0, after, 2 * after])
    positions, velocities = run.at(times)
    slope = (positions[2] - positions[0]) / (times[2] - times[0])
    np.testing.assert_allclose(velocities[1], slope, rtol=1e-5, atol=1e-9)


def test_times_may_come_in_any_order_and_more_than_once(run):
    times = np.array([2.9, 0.1, 2.632, 0.1, 1.0])
    forward = run.tangential_load(np.sort(times))
    np.testing.assert_array_equal(run.tangential_load(times), forward[[4, 0, 3, 1, 2]])


@pytest.mark.parametrize("time", [-1e-9, 3.1, np.nan])
def test_a_time_outside_the_run_is_refused(run, time):
    with pytest.raises(ValueError, match=r"times must be between 0 and 3 s"):
        run.at([time])


def test_a_run_without_stored_states_says_that_it_cannot_be_evaluated(run):
    bare = replace(run, states=States(*(column[:0] for column in run.states)))
    for evaluate in (bare.at, bare.tangential_load, bare.spring_forces):
        with pytest.raises(ValueError, match=r"^the run has no stored states: [^\n]*$"):
            evaluate([1.0])


def test_at_time_0_a_run_is_where_it_began():
    chain, start, velocities = Chain.from_slider(n_blocks=3), [1e-6, -2e-6, 3e-6], [1e-3, 0.0, -1e-3]
    run = simulate(chain, 0.01, start_positions=start, start_velocities=velocities)
    np.testing.assert_allclose(run.at([0.0]), [[start], [velocities]], rtol=1e-12)
    assert run.spring_forces([0.0])[0] == pytest.approx(-chain.springs * np.diff(start, prepend=0.0))


def test_a_run_made_from_transitions_has_them_and_knows_no_states(run, tmp_path):
    columns = [run.transitions[name] for name in ("time", "block", "mode", "tangential_load")]
    made = Run.from_transitions(run.chain, run.duration, *columns, run.intervals)
    made.save(tmp_path / "made.h5")
    for same in (made, Run.load(tmp_path / "made.h5")):
        np.testing.assert_array_equal(same.transitions, run.transitions)
        np.testing.assert_array_equal(same.intervals, run.intervals)
        with pytest.raises(ValueError, match="no stored states"):
            same.at([0.0])
    by_difference = Run.from_transitions(run.chain, run.duration, *columns).intervals
    np.testing.assert_allclose(by_difference, run.intervals, atol=1e-14)


def test_nothing_moves_while_all_blocks_stick(run):
    positions, velocities = run.at([0.0, 0.3])
    assert np.abs(positions).max() < POSITION_ROUNDING
    assert not velocities.any()


def test_a_saved_run_comes_back_bit_for_bit(run, tmp_path):
    path = tmp_path / "new" / "run.h5"
    slider = {"theta": -5 / 6, "n_blocks": 10, "normal_load": 400.0}
    run.save(path, slider)
    back = Run.load(path)
    assert back.slider == slider
    assert back.evaluations == run.evaluations
    assert back.chain == run.chain
    assert back.duration == run.duration
    np.testing.assert_array_equal(back.transitions, run.transitions)
    np.testing.assert_array_equal(back.intervals, run.intervals)
    times = np.linspace(0, 3, 77)
    np.testing.assert_array_equal(back.at(times)[0], run.at(times)[0])
    assert [p.name for p in path.parent.iterdir()] == ["run.h5"]


@pytest.mark.parametrize("theta", [-1.0, 1.0])
@pytest.mark.parametrize("duration", [1e-9, 1e-3])
def test_a_run_whose_values_are_at_the_limits_comes_back_too(tmp_path, theta, duration):
    """Without a transition, with all of them at time 0 and with one at its end; of blocks 1 and N."""
    chain = Chain.from_slider(n_blocks=30, theta=theta)
    start = maximal_strain_positions(chain)
    runs = [simulate(chain, duration), simulate(chain, duration, start_positions=start)]
    runs.append(simulate(chain, duration, start_velocities=-np.ones(30)))
    runs += [first_transitions(chain, most, start_positions=start, duration=duration) for most in (29, 31)]
    for run in runs:
        run.save(tmp_path / "run.h5")
        back = Run.load(tmp_path / "run.h5")
        np.testing.assert_array_equal(back.transitions, run.transitions)
        for kept, known in zip(back.states, run.states, strict=True):
            np.testing.assert_array_equal(kept, known)


def test_the_file_says_what_its_numbers_are(run, tmp_path):
    run.save(tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5") as file:
        assert file["transitions/time"].attrs["unit"] == b"s"
        assert file["transitions/tangential_load"].attrs["unit"] == b"N"
        assert {"precursors", "numpy", "mu_s", "drive_velocity", "duration", "slider"} <= set(file.attrs)


def test_two_saves_give_the_same_bytes(run, tmp_path):
    run.save(tmp_path / "a.h5", {"theta": 0.0, "n_blocks": 10})
    run.save(tmp_path / "b.h5", {"n_blocks": 10, "theta": 0.0})
    assert (tmp_path / "a.h5").read_bytes() == (tmp_path / "b.h5").read_bytes()


def damaged(kind, whole):
    match kind:
        case "empty":
            return b""
        case "text":
            return b"time,load\n1,2\n"
        case "truncated":
            return whole[: len(whole) // 2]
        case "cut at the end":
            return whole[:-100]
        case "one bit":
            with h5py.File(BytesIO(whole)) as file:
                chunk = file["transitions/time"].id.get_chunk_info(0)
            middle = chunk.byte_offset + chunk.size // 2
            return whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]
    raise AssertionError(kind)


@pytest.mark.parametrize("kind", ["empty", "text", "truncated", "cut at the end", "one bit"])
def test_a_damaged_file_is_refused_in_one_line_that_names_it(run, tmp_path, kind):
    run.save(tmp_path / "run.h5")
    path = tmp_path / "bad.h5"
    path.write_bytes(damaged(kind, (tmp_path / "run.h5").read_bytes()))
    with pytest.raises(RunFileError) as error:
        Run.load(path)
    assert "bad.h5" in str(error.value)
    assert "\n" not in str(error.value)


def test_whatever_byte_is_damaged_the_file_is_refused_or_has_the_same_run(run, tmp_path):
    path, random = tmp_path / "run.h5", np.random.default_rng(2010)
    run.save(path)
    whole = path.read_bytes()
    assert b"GCOL" not in whole  # texts without a checksum, in which HDF5 may hang
    n_refused = 0
    for place in random.integers(0, len(whole), 200):
        spoiled = bytearray(whole)
        spoiled[place : place + 8] = random.bytes(8)
        path.write_bytes(spoiled)
        try:
            np.testing.assert_array_equal(Run.load(path).transitions, run.transitions)
        except RunFileError:
            n_refused += 1
    assert n_refused > 100


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda file: file.attrs.update(slider=np.bytes_(b"[" * 30_000)), "recursion"),
        (lambda file: file.attrs.update(larger=np.bytes_(b"[]")), "larger is not a table"),
        (lambda file: file.create_dataset("load_points", (10**12, 2), float), "than its file can hold"),
        (lambda file: file.update(load_points=h5py.SoftLink("/load_points")), "too many links"),
        (lambda file: file.attrs.update(format="precursors run 5"), "its format"),
    ],
)
def test_a_file_made_to_be_read_for_ever_is_refused_at_once(run, tmp_path, change, words):
    run.save(tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5", "r+") as file:
        change(file)
    with pytest.raises(RunFileError, match=words):
        Run.load(tmp_path / "run.h5")


def test_a_foreign_file_and_another_version_are_refused(run, tmp_path):
    path = tmp_path / "other.h5"
    with h5py.File(path, "w") as file:
        file["x"] = 1.0
    with pytest.raises(RunFileError, match="not a run file"):
        Run.load(path)
    run.save(path)
    path.write_bytes(path.read_bytes().replace(b"precursors run 5", b"precursors run 9", 1))
    with pytest.raises(RunFileError, match="not a run file"):
        Run.load(path)


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        ("transitions/block", lambda block: block * 0 - 1_000_000_000, "a block is not one of 1 to 10"),
        ("transitions/block", lambda block: block + 10, "a block is not one of 1 to 10"),
        ("transitions/block", lambda block: block[:-1], "transitions/block has shape"),
        ("transitions/mode", lambda mode: mode * 0 + 3, "a mode is unknown"),
        ("intervals", lambda intervals: intervals[1:], "intervals do not fit"),
        ("intervals", lambda intervals: intervals * np.nan, "an interval is not between 0 and"),
        ("intervals", lambda intervals: intervals * 1e300, "an interval is not between 0 and"),
        ("intervals", lambda intervals: intervals[::-1], "intervals do not add up to its times"),
        ("transitions/time", lambda time: time[::-1], "times are not in order"),
        ("transitions/time", lambda time: time * np.nan, "times are not in order"),
        ("transitions/time", lambda time: time * 2, "times are not in order"),
        ("states/after", lambda after: after[::-1], "states are not in order"),
        ("states/offset", lambda offset: offset + 1e300, "an offset is not between 0 and"),
        ("start_positions", lambda positions: positions[1:], "start_positions do not fit to 10 blocks"),
        ("weights", lambda weights: -weights, "block 1"),
        ("weights", lambda weights: weights[1:], "do not fit to 9 blocks"),
        ("states/after", lambda after: after - 1_000_000_000, "a state comes after a transition"),
        ("states/after", lambda after: after[1:], "states/force has shape"),
        ("states/mode", lambda mode: mode + 7, "a mode is unknown"),
        ("states/force", lambda force: force[:, 1:], "states/force has shape"),
        ("states/offset", lambda offset: offset[1:], "states/offset does not fit"),
        ("intervals", None, "intervals"),
        ("states/velocity", None, "velocity"),
    ],
)
def test_a_file_whose_contents_do_not_fit_together_is_refused(run, tmp_path, name, change, words):
    path = tmp_path / "run.h5"
    run.save(path)
    with h5py.File(path, "r+") as file:
        values = file[name][()]
        del file[name]
        if change is not None:
            file[name] = change(values)
    with pytest.raises(RunFileError, match=words) as error:
        Run.load(path)
    assert "run.h5" in str(error.value)
    assert "\n" not in str(error.value)


def test_states_of_other_types_are_taken_as_numbers(run, tmp_path):
    """Compiled code reads memory as doubles and 64-bit integers."""
    run.save(tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5", "r+") as file:
        for name, kind in (("after", "i4"), ("mode", "i1"), ("velocity", "f4")):
            values = file[f"states/{name}"][()].astype(kind)
            del file[f"states/{name}"]
            file[f"states/{name}"] = values
    times = np.linspace(0, 3, 7)
    loads = Run.load(tmp_path / "run.h5").tangential_load(times)
    np.testing.assert_allclose(loads, run.tangential_load(times), rtol=1e-6)


@pytest.mark.parametrize("times", [[True], ["1"], [1j], np.ma.masked_array([1.0], [True])])
def test_times_that_are_not_numbers_are_refused(run, times):
    with pytest.raises(ValueError, match=r"times must be numbers \[s\]"):
        run.at(times)


def test_a_missing_file_and_an_unwritable_place_are_named(run, tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none\.h5: no such file"):
        Run.load(tmp_path / "none.h5")
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        run.save(tmp_path / "file" / "run.h5")


def test_a_run_prints_its_size_and_its_chain_in_a_few_lines():
    run = simulate(Chain.from_slider(theta="5/6"), 1.0)
    lines = repr(run).splitlines()
    assert lines[:2] == ["Run of 1 s with 74 transitions", "Chain of 10 blocks"]
    assert "w_N = 73.3333 N" in lines[2]
    assert len(lines) == 4


def test_times_in_a_table_are_refused():
    with pytest.raises(
        ValueError, match=r"times must be one number \[s\] or a list of them, but have shape \(1, 2\)"
    ):
        simulate(Chain.from_slider(), 0.5).at([[0.1, 0.2]])
