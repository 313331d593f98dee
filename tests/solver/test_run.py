"""A run gives the motion at any time, and its file restores every bit or is refused."""

import fcntl
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import h5py
import numpy as np
import pytest
from chains import SLIDER, first_transitions
from random_chains import mild_chain

from precursors import Record, Run, RunFileError, audit, simulate
from precursors.solver.record import arrays_of
from precursors.solver.run_file import SCALARS, WITHOUT_CHECKSUM

# Error after some tens of transitions of random chains, relative to the duration.
RANDOM = 1e-9


@pytest.fixture(scope="module")
def run():
    return simulate(SLIDER(theta="-5/6"), duration=3.0)


@pytest.fixture
def path(run, tmp_path):
    """Save the run and return the path."""
    run.save(tmp_path / "run.h5")
    return tmp_path / "run.h5"


@pytest.mark.parametrize("n_blocks", [1, 4, 5, 10, 30])
def test_tangential_load_at_a_transition_is_the_recorded_one(n_blocks):
    run = simulate(SLIDER(n_blocks, theta="-5/6"), duration=3.0)
    loads = run.tangential_load(run.transitions["time"])
    recorded = run.transitions["tangential_load"]
    np.testing.assert_allclose(loads, recorded, rtol=0, atol=1e-8)


def test_times_may_come_in_any_order(run):
    times = np.random.default_rng(1).permutation(
        np.linspace(0.0, run.duration, 1001).repeat(2)
    )
    forward = run.tangential_load(np.sort(times))
    np.testing.assert_array_equal(
        run.tangential_load(times), forward[np.searchsorted(np.sort(times), times)]
    )


@pytest.mark.parametrize("seed", range(12))
def test_run_resumed_from_any_state_has_the_same_transitions(seed):
    """The drive starts each run at 0, so the chain is moved back by its path."""
    rng = np.random.default_rng(seed)
    case = mild_chain(rng)
    whole = case.run()
    cut = rng.uniform(0.2, 0.8) * whole.duration
    # With earlier times, `at` also starts from states before this slip and within it.
    positions, velocities = whole.at([0.0, cut / 2, 0.999 * cut, cut])
    at_0 = whole.start_positions, whole.start_velocities
    np.testing.assert_allclose((positions[0], velocities[0]), at_0, rtol=1e-12)
    start = {"start_positions": positions[3] - case.chain.drive_velocity * cut}
    start |= {"start_velocities": velocities[3]}
    rest = whole.transitions[whole.transitions["time"] > cut]
    resumed = first_transitions(
        case.chain, 100, duration=1.01 * (whole.duration - cut), **start
    ).transitions
    resumed = resumed[resumed["time"] > 0.0][: len(rest)]
    assert resumed[["block", "mode"]].tolist() == rest[["block", "mode"]].tolist()
    np.testing.assert_allclose(
        resumed["time"] + cut, rest["time"], rtol=0, atol=RANDOM * case.duration
    )


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ([-1e-9], r"between 0 and 3 s, but one is -1e-09 s$"),
        ([1.0, np.nan], r"between 0 and 3 s, but one is nan s$"),
        ([[0.1, 0.2]], r"one number \[s\] or a list of them, but have shape \(1, 2\)"),
    ],
)
def test_times_outside_the_run_or_not_numbers_are_refused(run, times, words):
    with pytest.raises(ValueError, match="^times must be " + words):
        run.at(times)


def without_checksum(path: Path) -> None:
    """Turn a file into one of an older release, without a checksum."""
    with h5py.File(path, "r+") as file:
        file.attrs["format"] = np.bytes_(WITHOUT_CHECKSUM)
        del file.attrs["checksum"]


def assert_same(read: Record, run: Record) -> None:
    """Assert that two records are equal to the last bit."""
    assert (read.chain, read.duration) == (run.chain, run.duration)
    np.testing.assert_array_equal(read.transitions, run.transitions)
    np.testing.assert_array_equal(read.intervals, run.intervals)


def test_record_round_trips_and_is_not_read_as_a_run(run, tmp_path):
    columns = [run.transitions[name] for name in run.transitions.dtype.names]
    made = Record.from_columns(run.chain, run.duration, *columns, run.intervals)
    made.save(tmp_path / "made.h5")
    for record in (made, Record.load(tmp_path / "made.h5")):
        assert type(record) is Record
        assert_same(record, run)
    with pytest.raises(RunFileError, match="a Record and not a Run: "):
        Run.load(tmp_path / "made.h5")
    by_difference = Record.from_columns(run.chain, run.duration, *columns).intervals
    np.testing.assert_allclose(by_difference, run.intervals, atol=1e-14)


def test_saved_run_round_trips_bit_for_bit_with_units(run, tmp_path):
    path = tmp_path / "new" / "run.h5"
    run.save(path)
    back = Run.load(path)
    times = np.linspace(0, 3, 77)
    assert_same(back, run)
    assert (back.chain.theta, back.evaluations) == (-5 / 6, run.evaluations)
    np.testing.assert_array_equal(back.at(times), run.at(times))
    with h5py.File(path) as file:
        assert file["transitions/tangential_load"].attrs["unit"] == b"N"
        assert file.attrs["mu_s"] == 0.7
    run.save(tmp_path / "again.h5")
    assert path.read_bytes() == (tmp_path / "again.h5").read_bytes()


def test_incomplete_run_file_is_refused_in_one_line(path):
    whole = path.read_bytes()
    other = whole.replace(b"precursors run 7", b"precursors run 9", 1)
    for content in (whole[:-100], other):
        path.write_bytes(content)
        with pytest.raises(RunFileError, match=r"^.*run\.h5 is not a run file[^\n]*$"):
            Run.load(path)


def test_file_that_cannot_be_locked_is_read(run, path):
    """Some file systems of clusters do not support locks."""
    with path.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        np.testing.assert_array_equal(Run.load(path).transitions, run.transitions)


def test_damaged_bytes_are_refused_or_change_nothing(run, path):
    random = np.random.default_rng(2010)
    whole = path.read_bytes()
    n_refused = 0
    assert b"GCOL" not in whole  # HDF5 may hang in texts without a checksum
    for place in random.integers(0, len(whole), 100):
        spoiled = bytearray(whole)
        spoiled[place : place + 8] = random.bytes(8)
        path.write_bytes(spoiled)
        try:
            read = Run.load(path)
        except RunFileError:
            n_refused += 1
            continue
        assert_same(read, run)
        for loaded, known in zip(read.states, run.states, strict=True):
            np.testing.assert_array_equal(loaded, known)
    assert n_refused > 50


def other_values(values: np.ndarray) -> Iterator[np.ndarray]:
    """Yield arrays with other values, types, shapes or lengths."""
    if values.dtype.kind == "f":
        one = values.copy()
        one.flat[np.argmax(abs(one))] *= 1 + 1e-6
        yield from (1.01 * values, one, np.full_like(values, np.nan))
        yield from (values.astype("f4"), values.astype("i8"))
    else:
        yield from (values + 1, values[::-1], values + 0.4, values.astype("f8"))
        yield from (values.astype("i8") + 256, values.astype("i8") + 2**32)
    yield from (values.astype("S24"), values[None], values[:-1], values[1:])
    yield from (values[:0], np.concatenate([values, values[-1:]]))


def changes(run: Run) -> Iterator[tuple[str, str, object]]:
    """Yield names of datasets and attributes with their new values; None removes
    them."""
    for name, values in arrays_of(run).items():
        for other in (None, *other_values(values)):
            if not np.array_equal(other, values) or other.dtype != values.dtype:
                yield "dataset", name, other
        yield "dataset", f"{name}s", values
    for name in (*SCALARS, "theta", "duration", "evaluations"):
        yield from (("attribute", name, value) for value in (None, b"0.1", [0.1]))
    for name in (*SCALARS, "duration"):
        of = run if name == "duration" else run.chain
        yield "attribute", name, 1.01 * getattr(of, name)
    yield from [("attribute", "theta", 0.5), ("attribute", "note", 1.0)]


def changed(good: bytes, kind: str, name: str, value: object) -> bytes:
    """Return the content of a run file with one change."""
    memory = BytesIO(good)
    with h5py.File(memory, "r+") as file:
        place = file.attrs if kind == "attribute" else file
        unit = file[name].attrs["unit"] if name in file else b"1"
        if name in place:
            del place[name]
        if value is not None:
            place[name] = value
        if value is not None and kind == "dataset":
            file[name].attrs["unit"] = unit
    return memory.getvalue()


@pytest.mark.parametrize("has_checksum", [True, False])
def test_each_change_of_a_file_is_refused_on_loading_or_by_audit(has_checksum, path):
    chain = SLIDER(weights=[30.0, 0.0, 20.0, 40.0])
    run = simulate(chain, 0.8, start_positions=[0.0, 1e-6, 0.0, -1e-6])
    run.save(path)
    if not has_checksum:
        without_checksum(path)
    audit(Run.load(path)).raise_if_failed()
    good = path.read_bytes()
    audited = []
    for change in changes(run):
        path.write_bytes(changed(good, *change))
        try:
            report = audit(Run.load(path))
        except RunFileError:
            continue
        audited.append((change, report.ok))
    missed = [change[:2] for change, ok in audited if ok]
    if has_checksum:
        assert audited == []
    else:  # nothing else in the file contradicts them
        assert missed == [("attribute", "length")]
        assert len(audited) > 20


@pytest.mark.parametrize("kind", ["virtual", "external", "link"])
def test_dataset_stored_in_another_file_is_refused(kind, path, tmp_path):
    with h5py.File(path, "r+") as file:
        n = len(file["intervals"])
        del file["intervals"]
        if kind == "virtual":
            layout = h5py.VirtualLayout((n,), "f8")
            layout[:] = h5py.VirtualSource("other.h5", "intervals", (n,))
            file.create_virtual_dataset("intervals", layout)
        elif kind == "external":
            other = [(tmp_path / "other", 0, 8 * n)]
            file.create_dataset("intervals", (n,), "f8", external=other)
        else:
            file["intervals"] = h5py.ExternalLink("other.h5", "intervals")
    with pytest.raises(RunFileError, match=r"intervals is (a link|stored in another)"):
        Run.load(path)


def test_dataset_longer_than_its_file_is_refused(path):
    with h5py.File(path, "r+") as file:
        del file["intervals"]
        file.create_dataset("intervals", (10**13,), "f8", chunks=True)
    with pytest.raises(RunFileError, match="intervals is incomplete"):
        Run.load(path)


def test_file_of_a_larger_chain_names_the_version_that_reads_it(run, path):
    with h5py.File(path, "r+") as file:
        del file["states"]
        file["load_points"] = np.zeros((2, 2))  # only files of the older model have it
    words = r"^\S+run\.h5 is a run of an older model, .* git checkout 88883c9 reads it$"
    with pytest.raises(RunFileError, match=words):
        Record.load(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none\.h5: no such file"):
        Run.load(tmp_path / "none.h5")
    with pytest.raises(FileNotFoundError, match="is not a file"):
        Run.load(tmp_path)
