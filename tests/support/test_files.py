"""A file is complete or absent, and what was there before is never half overwritten."""

import errno
import os
import signal
import stat
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from precursors.support.files import read_table, write_table, write_text, write_whole

WRITE_SLOWLY = """
import sys
from precursors.support.files import write_whole
with write_whole(sys.argv[1]) as temporary:
    temporary.write_text("half")
    print("writing", flush=True)
    sys.stdin.read()
"""


def test_the_file_appears_complete_when_the_block_ends(tmp_path):
    path = tmp_path / "deep" / "er" / "table.csv"
    with write_whole(path) as temporary:
        temporary.write_text("a,b\n")
        assert not path.exists()
    assert path.read_text() == "a,b\n"
    assert os.listdir(path.parent) == ["table.csv"]


def test_the_temporary_name_is_beside_the_file_and_keeps_its_suffix(tmp_path):
    with write_whole(tmp_path / "run.h5") as temporary:
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".h5"
        temporary.write_text("x")


def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old")

    def fail_half_way():
        with write_whole(path) as temporary:
            temporary.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail_half_way()
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["table.csv"]


def test_the_file_has_the_permissions_of_an_ordinary_file(tmp_path):
    ordinary, path = tmp_path / "ordinary", tmp_path / "table.csv"
    ordinary.write_text("x")
    with write_whole(path) as temporary:
        temporary.write_text("x")
    assert stat.S_IMODE(path.stat().st_mode) == stat.S_IMODE(ordinary.stat().st_mode)


@pytest.mark.parametrize("where", ["file/table.csv", "file/deeper/table.csv", "directory"])
def test_an_unwritable_place_is_refused_in_one_line_that_names_it(tmp_path, where):
    (tmp_path / "file").write_text("x")
    (tmp_path / "directory").mkdir()
    path = tmp_path / where
    with pytest.raises(OSError, match="cannot write") as error, write_whole(path):
        pass
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)
    assert "None" not in str(error.value)


@pytest.fixture
def slow_writer(tmp_path):
    """A process that has begun to write table.csv, and waits."""
    command = [sys.executable, "-c", WRITE_SLOWLY, tmp_path / "table.csv"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "writing\n"
        yield process
        process.kill()


def test_what_a_killed_writer_left_is_removed_by_the_next_one(tmp_path, slow_writer):
    slow_writer.send_signal(signal.SIGKILL)
    slow_writer.wait()
    assert len(os.listdir(tmp_path)) == 1
    with write_whole(tmp_path / "table.csv") as temporary:
        temporary.write_text("whole")
    assert os.listdir(tmp_path) == ["table.csv"]


def test_no_room_is_an_error_that_names_the_file(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old")

    def fill_the_disk():
        with write_whole(path):
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OSError, match=r"cannot write .*table\.csv: No space left on device$"):
        fill_the_disk()
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["table.csv"]


def test_a_device_is_not_replaced():
    with pytest.raises(OSError, match="it exists and is not a file"), write_whole("/dev/null"):
        pass
    assert Path("/dev/null").is_char_device()


def test_a_link_is_followed_and_stays_a_link(tmp_path):
    (tmp_path / "link.csv").symlink_to(tmp_path / "table.csv")
    write_text(tmp_path / "link.csv", "new")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "table.csv").read_text() == "new"


def test_a_table_keeps_every_digit(tmp_path):
    table = pd.DataFrame({"time_s": [0.1, 1 / 3, 1e-300], "block": [1, 2, 3]})
    write_table(table, tmp_path / "table.csv")
    pd.testing.assert_frame_equal(read_table(tmp_path / "table.csv"), table, check_exact=True)


def test_what_is_no_table_is_refused_by_name(tmp_path):
    (tmp_path / "table.csv").write_bytes(b"")
    with pytest.raises(ValueError, match=r"table\.csv: No columns to parse"):
        read_table(tmp_path / "table.csv")
