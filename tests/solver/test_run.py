"""A run knows the motion at every time, and its file gives back every bit or is
refused."""

import fcntl

import h5py
import numpy as np
import pytest
from chains import SLIDER, first_transitions
from random_chains import mild_chain

from precursors import Record, Run, RunFileError, simulate
from precursors.larger.run import LargerRun
from precursors.model.statics import maximal_strain_positions

# A transition's own time is known to 4e-16 s only, and F_X changes by up to 1e6 N/s
# [N].
FORCE_ROUNDING = 1e-11
# Of the duration: some tens of transitions of chains drawn at random.
RANDOM = 1e-9


@pytest.fixture(scope="module")
def run():
    return simulate(SLIDER(theta="-5/6"), duration=3.0)


@pytest.fixture
def path(run, tmp_path):
    """The file of the run."""
    run.save(tmp_path / "run.h5")
    return tmp_path / "run.h5"


@pytest.mark.parametrize("n_blocks", [1, 5, 30])
def test_the_load_at_a_transition_is_the_one_recorded(n_blocks):
    run = simulate(SLIDER(n_blocks, theta="-5/6"), duration=3.0)
    loads = run.tangential_load(run.transitions["time"])
    recorded = run.transitions["tangential_load"]
    np.testing.assert_allclose(loads, recorded, rtol=0, atol=1e-8)


def test_load_and_positions_obey_eq_3_at_times_in_any_order(run):
    times = np.random.default_rng(1).permutation(
        np.linspace(0.0, run.duration, 1001).repeat(2)
    )
    positions, _ = run.at(times)
    expected = run.chain.drive_stiffness * (
        run.chain.drive_velocity * times - positions[:, 0]
    )
    np.testing.assert_allclose(
        run.tangential_load(times), expected, rtol=0, atol=FORCE_ROUNDING
    )
    forward = run.tangential_load(np.sort(times))
    np.testing.assert_array_equal(
        run.tangential_load(times), forward[np.searchsorted(np.sort(times), times)]
    )


@pytest.mark.parametrize("seed", range(20))
def test_a_run_that_goes_on_from_its_state_at_any_time_has_the_transitions_of_the_whole(
    seed,
):
    """The drive is at 0 when a run begins, so that the chain is moved back by what the
    drive went."""
    rng = np.random.default_rng(seed)
    case = mild_chain(rng)
    whole = case.run()
    cut = rng.uniform(0.2, 0.8) * whole.duration
    # Times before it let the state be found from an earlier one, and from one within
    # the same slip.
    positions, velocities = whole.at([cut / 2, 0.999 * cut, cut])
    start = {"start_positions": positions[2] - case.chain.drive_velocity * cut}
    start |= {"start_velocities": velocities[2]}
    rest = whole.transitions[whole.transitions["time"] > cut]
    found = first_transitions(
        case.chain, 100, duration=1.01 * (whole.duration - cut), **start
    ).transitions
    found = found[found["time"] > 0.0][: len(rest)]
    assert found[["block", "mode"]].tolist() == rest[["block", "mode"]].tolist()
    np.testing.assert_allclose(
        found["time"] + cut, rest["time"], rtol=0, atol=RANDOM * case.duration
    )


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ([-1e-9], r"between 0 and 3 s, but one is -1e-09 s$"),
        ([np.nan], r"between 0 and 3 s, but one is nan s$"),
        ([[0.1, 0.2]], r"one number \[s\] or a list of them, but have shape \(1, 2\)"),
        ([True], r"numbers \[s\]"),
        (np.ma.masked_array([1.0], [True]), r"numbers \[s\]"),
    ],
)
def test_times_outside_the_run_or_that_are_no_numbers_are_refused(run, times, words):
    with pytest.raises(ValueError, match="^times must be " + words):
        run.at(times)


def test_at_time_0_a_run_is_where_it_began():
    chain = SLIDER(3)
    start = [1e-6, -2e-6, 3e-6]
    velocities = [1e-3, 0.0, -1e-3]
    run = simulate(chain, 0.01, start_positions=start, start_velocities=velocities)
    np.testing.assert_allclose(run.at([0.0]), [[start], [velocities]], rtol=1e-12)
    assert run.spring_forces([0.0])[0] == pytest.approx(
        -chain.springs * np.diff(start, prepend=0.0)
    )


def test_a_record_has_its_transitions_and_is_read_as_a_record_only(run, tmp_path):
    columns = [
        run.transitions[name] for name in ("time", "block", "mode", "tangential_load")
    ]
    made = Record.from_columns(run.chain, run.duration, *columns, run.intervals)
    made.save(tmp_path / "made.h5")
    for same in (made, Record.load(tmp_path / "made.h5")):
        assert (type(same), same.chain.theta) == (Record, -5 / 6)
        np.testing.assert_array_equal(same.transitions, run.transitions)
        np.testing.assert_array_equal(same.intervals, run.intervals)
    with pytest.raises(RunFileError, match="a Record and not a Run: "):
        Run.load(tmp_path / "made.h5")
    by_difference = Record.from_columns(run.chain, run.duration, *columns).intervals
    np.testing.assert_allclose(by_difference, run.intervals, atol=1e-14)


def test_a_saved_run_comes_back_bit_for_bit_and_says_what_its_numbers_are(
    run, tmp_path
):
    path = tmp_path / "new" / "run.h5"
    run.save(path)
    back = Run.load(path)
    times = np.linspace(0, 3, 77)
    assert back.chain == run.chain
    assert back.chain.theta == -5 / 6
    assert back.duration == run.duration
    assert back.evaluations == run.evaluations
    np.testing.assert_array_equal(back.transitions, run.transitions)
    np.testing.assert_array_equal(back.intervals, run.intervals)
    np.testing.assert_array_equal(back.at(times), run.at(times))
    assert [p.name for p in path.parent.iterdir()] == ["run.h5"]
    with h5py.File(path) as file:
        units = {
            name: file[f"transitions/{name}"].attrs["unit"]
            for name in ("time", "tangential_load")
        }
        assert units == {"time": b"s", "tangential_load": b"N"}
        assert {
            "precursors",
            "numpy",
            "mu_s",
            "drive_velocity",
            "duration",
            "theta",
        } <= set(file.attrs)
    run.save(tmp_path / "again.h5")
    assert path.read_bytes() == (tmp_path / "again.h5").read_bytes()


@pytest.mark.parametrize("theta", [-1.0, 1.0])
@pytest.mark.parametrize("duration", [1e-9, 1e-3])
def test_a_run_whose_values_are_at_the_limits_comes_back_too(tmp_path, theta, duration):
    """Without a transition, with all of them at time 0 and with one at its end; of
    blocks 1 and N."""
    chain = SLIDER(30, theta=theta)
    start = maximal_strain_positions(chain)
    runs = [simulate(chain, duration), simulate(chain, duration, start_positions=start)]
    runs.append(simulate(chain, duration, start_velocities=-np.ones(30)))
    runs += [
        first_transitions(chain, most, start_positions=start, duration=duration)
        for most in (29, 31)
    ]
    for run in runs:
        run.save(tmp_path / "run.h5")
        back = Run.load(tmp_path / "run.h5")
        np.testing.assert_array_equal(back.transitions, run.transitions)
        for kept, known in zip(back.states, run.states, strict=True):
            np.testing.assert_array_equal(kept, known)


def refused(path, words="") -> None:
    """Demand one line that names the file."""
    with pytest.raises(RunFileError, match=words) as error:
        Run.load(path)
    assert path.name in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "damaged",
    [
        lambda whole: b"",
        lambda whole: b"time,load\n1,2\n",
        lambda whole: whole[: len(whole) // 2],
        lambda whole: whole[:-100],
        lambda whole: whole.replace(b"precursors run 6", b"precursors run 9", 1),
    ],
    ids=["empty", "text", "half", "cut at the end", "another version"],
)
def test_a_file_that_is_no_whole_run_is_refused(path, damaged):
    path.write_bytes(damaged(path.read_bytes()))
    refused(path, "not a run file")


def test_a_file_that_cannot_be_locked_is_read(run, path):
    """As on some file systems of clusters."""
    with path.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        np.testing.assert_array_equal(Run.load(path).transitions, run.transitions)


def test_whatever_byte_is_damaged_the_file_is_refused_or_has_the_same_run(run, path):
    random = np.random.default_rng(2010)
    whole = path.read_bytes()
    n_refused = 0
    assert b"GCOL" not in whole  # texts without a checksum, in which HDF5 may hang
    for place in random.integers(0, len(whole), 100):
        spoiled = bytearray(whole)
        spoiled[place : place + 8] = random.bytes(8)
        path.write_bytes(spoiled)
        try:
            np.testing.assert_array_equal(Run.load(path).transitions, run.transitions)
        except RunFileError:
            n_refused += 1
    assert n_refused > 50


@pytest.mark.parametrize("text", [b"[]", b'{"step": "1"}', b"{"])
def test_a_larger_run_whose_numbers_are_no_table_of_numbers_is_refused(run, path, text):
    columns = [run.transitions[name] for name in run.transitions.dtype.names]
    points = np.zeros((2, 2))
    larger = LargerRun.from_columns(
        run.chain, run.duration, *columns, numbers={"step": 1.0}, load_points=points
    )
    larger.save(path)
    assert Record.load(path).numbers == {"step": 1.0}
    with h5py.File(path, "r+") as file:  # the name in older files
        file.attrs["larger"] = file.attrs["numbers"]
        del file.attrs["numbers"]
    assert Record.load(path).numbers == {"step": 1.0}
    with h5py.File(path, "r+") as file:
        file.attrs["larger"] = np.bytes_(text)
    refused(path, "not a run file")


MISFITS = (
    ("transitions/block", lambda block: block + 10, "is not between 1 and 10"),
    ("transitions/block", lambda block: block + 0.5, "is of type float64"),
    ("transitions/block", lambda block: block[:-1], "transitions/block has shape"),
    ("intervals", lambda intervals: intervals * np.nan, "intervals is not finite"),
    ("intervals", lambda intervals: intervals[::-1], "do not add up to its times"),
    ("transitions/time", lambda time: time[::-1], "time is not in order"),
    ("transitions/time", lambda time: time * 2, "time is not between 0.0 and 3.0"),
    ("states/after", lambda after: after - 10**9, "states/after is not between"),
    ("states/after", lambda after: after + 1, "no state of the start"),
    ("states/force", lambda force: force[:, 1:], "states/force has shape"),
    ("states/offset", lambda offset: offset + 1e300, "states/offset is not between"),
    ("states/velocity", None, "velocity"),
    ("duration", lambda _: np.inf, "duration must be a finite number"),
    ("duration", lambda _: "3", "duration is not a number"),
    ("mass", lambda _: np.nan, "mass must be a finite number"),
    ("theta", lambda _: 1.1, "theta must be"),
)


@pytest.mark.parametrize(("name", "change", "words"), MISFITS)
def test_a_file_whose_contents_do_not_fit_together_is_refused(
    path, name, change, words
):
    with h5py.File(path, "r+") as file:
        place = file if name in file else file.attrs
        values = place[name][()]
        del place[name]
        if change is not None:
            place[name] = change(values)
    refused(path, words)


def test_a_missing_file_and_an_unwritable_place_are_named(run, tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none\.h5: no such file"):
        Run.load(tmp_path / "none.h5")
    with pytest.raises(FileNotFoundError, match="is not a file"):
        Run.load(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        run.save(tmp_path / "file" / "run.h5")


def test_a_run_prints_its_size_and_its_chain_in_a_few_lines():
    assert repr(simulate(SLIDER(theta="5/6"), 1.0)).splitlines() == [
        "Run of 1 s with 74 transitions",
        "Chain of 10 blocks",
        "  w_1 = 6.66667 N, w_N = 73.3333 N, F_Z = 400 N, mu_s = 0.7, mu_k = 0.45",
        "  m = 0.0012 kg, k = 2.5e+07 N/m, K = 800000 N/m, V = 0.0001 m/s, L = 0.1 m",
    ]
