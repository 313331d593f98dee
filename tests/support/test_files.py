"""A file is written completely or not at all; an old file is never half overwritten."""

import os
import resource
import stat
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from precursors import Chain, simulate
from precursors.figures import style
from precursors.support.files import (
    check_writable,
    read_table,
    write_table,
    write_text,
    write_whole,
)

RUN = simulate(Chain.from_slider(), 1.0)
TABLE = pd.DataFrame({"time_s": [0.1, 1 / 3, 1e-300], "block": [1, 2, 3]})
WRITERS = {
    "run.h5": RUN.save,
    "table.csv": lambda path: write_table(TABLE, path),
    "figure.png": lambda path: style.save(Figure(), path),
}


def test_file_is_written_with_its_directories_and_normal_mode(tmp_path):
    path = tmp_path / "deep" / "er" / "table.csv"
    write_whole(path, b"a,b\n")
    assert path.read_bytes() == b"a,b\n"
    assert os.listdir(path.parent) == ["table.csv"]
    (tmp_path / "ordinary").touch()
    assert stat.S_IMODE(path.stat().st_mode) == stat.S_IMODE(
        (tmp_path / "ordinary").stat().st_mode
    )


@pytest.mark.parametrize("name", WRITERS)
def test_full_disk_leaves_the_old_file_and_reports_one_line(tmp_path, name):
    path = tmp_path / name
    WRITERS[name](path)
    old = path.read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(old) - 1, hard))
    try:
        with pytest.raises(OSError, match=rf"^cannot write {path}: File too large$"):
            WRITERS[name](path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == old
    assert os.listdir(tmp_path) == [name]


def test_file_appears_only_when_it_is_complete(tmp_path, monkeypatch):
    def killed(temporary, target):
        (name,) = os.listdir(tmp_path)
        assert name not in names
        names.append(name)
        raise KeyboardInterrupt

    names = ["table.csv"]
    monkeypatch.setattr(os, "replace", killed)
    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            write_text(tmp_path / "table.csv", "new")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("where", ["file/deeper/table.csv", "directory"])
def test_unwritable_place_is_named_in_one_line(tmp_path, where):
    (tmp_path / "file").write_text("x")
    (tmp_path / "directory").mkdir()
    for write in (check_writable, lambda path: write_text(path, "")):
        with pytest.raises(
            OSError, match=rf"^cannot write {tmp_path / where}: [^\n]{{10,}}$"
        ):
            write(tmp_path / where)


def test_a_device_is_not_replaced():
    for write in (check_writable, lambda path: write_text(path, "")):
        with pytest.raises(OSError, match=r"^cannot write /dev/null: it .*not a file"):
            write("/dev/null")
    assert Path("/dev/null").is_char_device()


def test_a_link_is_followed_and_stays_a_link(tmp_path):
    (tmp_path / "link.csv").symlink_to(tmp_path / "table.csv")
    write_text(tmp_path / "link.csv", "new")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "table.csv").read_text() == "new"


def test_table_keeps_every_digit_and_other_formats_are_refused(tmp_path):
    path = tmp_path / "table.csv"
    write_table(TABLE, path)
    pd.testing.assert_frame_equal(read_table(path), TABLE, check_exact=True)
    path.write_bytes(b"")
    with pytest.raises(ValueError, match=r"table\.csv: No columns to parse"):
        read_table(path)


def test_ending_alone_is_not_a_file_name(tmp_path):
    with pytest.raises(ValueError, match=r"/\.png must end in \.svg or \.png"):
        check_writable(tmp_path / ".png", (".svg", ".png"))
