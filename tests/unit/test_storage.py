"""A file is complete or absent, and what was there before is never half overwritten."""

import os
import stat
from concurrent.futures import ThreadPoolExecutor

import pytest

from precursors.storage import write_atomically


def test_the_file_appears_complete_when_the_block_ends(tmp_path):
    path = tmp_path / "deep" / "er" / "table.csv"
    with write_atomically(path) as temporary:
        temporary.write_text("a,b\n")
        assert not path.exists()
    assert path.read_text() == "a,b\n"
    assert os.listdir(path.parent) == ["table.csv"]


def test_the_temporary_name_is_beside_the_file_and_keeps_its_suffix(tmp_path):
    with write_atomically(tmp_path / "run.h5") as temporary:
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".h5"
        temporary.write_text("x")


def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old")

    def fail_half_way():
        with write_atomically(path) as temporary:
            temporary.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail_half_way()
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["table.csv"]


def test_the_file_has_the_permissions_of_an_ordinary_file(tmp_path):
    ordinary, path = tmp_path / "ordinary", tmp_path / "table.csv"
    ordinary.write_text("x")
    with write_atomically(path) as temporary:
        temporary.write_text("x")
    assert stat.S_IMODE(path.stat().st_mode) == stat.S_IMODE(ordinary.stat().st_mode)


@pytest.mark.parametrize("where", ["file/table.csv", "file/deeper/table.csv", "directory"])
def test_an_unwritable_place_is_refused_in_one_line_that_names_it(tmp_path, where):
    (tmp_path / "file").write_text("x")
    (tmp_path / "directory").mkdir()
    path = tmp_path / where
    with pytest.raises(OSError, match="cannot write") as error, write_atomically(path):
        pass
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)
    assert "None" not in str(error.value)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_directory_without_write_permission_is_refused_by_name(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(OSError, match=r"cannot write .*table\.csv"), write_atomically(tmp_path / "table.csv"):
        pass


def test_writers_at_once_leave_one_whole_file(tmp_path):
    # Threads are the harder case: they share a process id as well as a directory.
    path = tmp_path / "table.csv"

    def write_many(letter):
        for _ in range(50):
            with write_atomically(path) as temporary:
                temporary.write_text(letter * 100_000)

    write_many("a")
    with ThreadPoolExecutor() as pool:
        writers = [pool.submit(write_many, letter) for letter in "bcd"]
        while not all(writer.done() for writer in writers):
            text = path.read_text()
            assert text == text[0] * 100_000
    for writer in writers:
        writer.result()
    assert os.listdir(tmp_path) == ["table.csv"]
