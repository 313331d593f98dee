"""A run knows the motion at every time, and its file gives back every bit or is
refused."""

from dataclasses import replace

import h5py
import numpy as np
import pytest
from chains import SLIDER, first_transitions

from precursors import Run, RunFileError, simulate
from precursors.model.statics import maximal_strain_positions
from precursors.solver.run import States

# A transition's own time is known to 4e-16 s only, and F_X changes by up to 1e6 N/s
# [N].
FORCE_ROUNDING = 1e-11


@pytest.fixture(scope="module")
def run():
    return simulate(SLIDER(theta="-5/6"), duration=3.0)


@pytest.fixture
def path(run, tmp_path):
    """The file of the run."""
    run.save(tmp_path / "run.h5")
    return tmp_path / "run.h5"


@pytest.mark.parametrize("n_blocks", [1, 4, 5, 10, 30])
def test_the_load_at_a_transition_is_the_one_recorded(n_blocks):
    run = simulate(SLIDER(n_blocks, theta="-5/6"), duration=3.0)
    times, loads = run.transitions["time"], run.transitions["tangential_load"]
    np.testing.assert_allclose(run.tangential_load(times), loads, rtol=0, atol=1e-8)


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


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ([-1e-9], r"between 0 and 3 s, but one is -1e-09 s$"),
        ([1.0, 3.1], r"between 0 and 3 s, but one is 3.1 s$"),
        ([np.nan], r"between 0 and 3 s, but one is nan s$"),
        ([[0.1, 0.2]], r"one number \[s\] or a list of them, but have shape \(1, 2\)"),
        ([True], r"numbers \[s\]"),
        (["1"], r"numbers \[s\]"),
        (np.ma.masked_array([1.0], [True]), r"numbers \[s\]"),
    ],
)
def test_times_outside_the_run_or_that_are_no_numbers_are_refused(run, times, words):
    with pytest.raises(ValueError, match="^times must be " + words):
        run.at(times)


def test_a_run_without_stored_states_says_that_it_cannot_be_evaluated(run):
    bare = replace(run, states=States(*(column[:0] for column in run.states)))
    for evaluate in (bare.at, bare.tangential_load, bare.spring_forces):
        with pytest.raises(ValueError, match=r"^the run has no stored states: [^\n]*$"):
            evaluate([1.0])


def test_at_time_0_a_run_is_where_it_began():
    chain, start, velocities = SLIDER(3), [1e-6, -2e-6, 3e-6], [1e-3, 0.0, -1e-3]
    run = simulate(chain, 0.01, start_positions=start, start_velocities=velocities)
    np.testing.assert_allclose(run.at([0.0]), [[start], [velocities]], rtol=1e-12)
    assert run.spring_forces([0.0])[0] == pytest.approx(
        -chain.springs * np.diff(start, prepend=0.0)
    )


def test_a_run_made_from_transitions_has_them_and_knows_no_states(run, tmp_path):
    columns = [
        run.transitions[name] for name in ("time", "block", "mode", "tangential_load")
    ]
    made = Run.from_transitions(run.chain, run.duration, *columns, run.intervals)
    made.save(tmp_path / "made.h5")
    for same in (made, Run.load(tmp_path / "made.h5")):
        np.testing.assert_array_equal(same.transitions, run.transitions)
        np.testing.assert_array_equal(same.intervals, run.intervals)
        with pytest.raises(ValueError, match="no stored states"):
            same.at([0.0])
    by_difference = Run.from_transitions(run.chain, run.duration, *columns).intervals
    np.testing.assert_allclose(by_difference, run.intervals, atol=1e-14)


def test_a_saved_run_comes_back_bit_for_bit_and_says_what_its_numbers_are(
    run, tmp_path
):
    path = tmp_path / "new" / "run.h5"
    slider = {"theta": -5 / 6, "n_blocks": 10, "normal_load": 400.0}
    run.save(path, slider)
    back, times = Run.load(path), np.linspace(0, 3, 77)
    assert (back.slider, back.evaluations) == (slider, run.evaluations)
    assert (back.chain, back.duration) == (run.chain, run.duration)
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
            "slider",
        } <= set(file.attrs)
    run.save(tmp_path / "again.h5", dict(reversed(slider.items())))
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
        lambda whole: whole.replace(b"precursors run 5", b"precursors run 9", 1),
    ],
    ids=["empty", "text", "half", "cut at the end", "another version"],
)
def test_a_file_that_is_no_whole_run_is_refused(path, damaged):
    path.write_bytes(damaged(path.read_bytes()))
    refused(path, "not a run file")


def test_whatever_byte_is_damaged_the_file_is_refused_or_has_the_same_run(run, path):
    random, whole, n_refused = np.random.default_rng(2010), path.read_bytes(), 0
    assert b"GCOL" not in whole  # texts without a checksum, in which HDF5 may hang
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
        (
            lambda file: file.attrs.update(larger=np.bytes_(b"[]")),
            "larger is not a table",
        ),
        (lambda file: file.attrs.update(format="precursors run 5"), "its format"),
    ],
)
def test_a_file_whose_texts_are_not_those_of_a_run_is_refused(path, change, words):
    with h5py.File(path, "r+") as file:
        change(file)
    refused(path, words)


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        (
            "transitions/block",
            lambda block: block * 0 - 1_000_000_000,
            "a block is not one of 1 to 10",
        ),
        ("transitions/block", lambda block: block[:-1], "transitions/block has shape"),
        ("transitions/mode", lambda mode: mode * 0 + 3, "a mode is unknown"),
        ("intervals", lambda intervals: intervals[1:], "intervals do not fit"),
        (
            "intervals",
            lambda intervals: intervals * np.nan,
            "an interval is not between 0 and",
        ),
        (
            "intervals",
            lambda intervals: intervals * 1e300,
            "an interval is not between 0 and",
        ),
        (
            "intervals",
            lambda intervals: intervals[::-1],
            "intervals do not add up to its times",
        ),
        ("transitions/time", lambda time: time[::-1], "times are not in order"),
        ("transitions/time", lambda time: time * 2, "times are not in order"),
        ("states/after", lambda after: after[::-1], "states are not in order"),
        (
            "states/offset",
            lambda offset: offset + 1e300,
            "an offset is not between 0 and",
        ),
        (
            "start_positions",
            lambda positions: positions[1:],
            "start_positions do not fit to 10 blocks",
        ),
        ("weights", lambda weights: weights[1:], "do not fit to 9 blocks"),
        (
            "states/after",
            lambda after: after - 1_000_000_000,
            "a state comes after a transition",
        ),
        ("states/after", lambda after: after[1:], "states/force has shape"),
        ("states/force", lambda force: force[:, 1:], "states/force has shape"),
        ("states/offset", lambda offset: offset[1:], "states/offset does not fit"),
        ("states/velocity", None, "velocity"),
    ],
)
def test_a_file_whose_contents_do_not_fit_together_is_refused(
    path, name, change, words
):
    with h5py.File(path, "r+") as file:
        values = file[name][()]
        del file[name]
        if change is not None:
            file[name] = change(values)
    refused(path, words)


def test_states_of_other_types_are_taken_as_numbers(run, path):
    """Compiled code reads memory as doubles and 64-bit integers."""
    with h5py.File(path, "r+") as file:
        for name, kind in (("after", "i4"), ("mode", "i1"), ("velocity", "f4")):
            values = file[f"states/{name}"][()].astype(kind)
            del file[f"states/{name}"]
            file[f"states/{name}"] = values
    times = np.linspace(0, 3, 7)
    np.testing.assert_allclose(
        Run.load(path).tangential_load(times), run.tangential_load(times), rtol=1e-6
    )


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
