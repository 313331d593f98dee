"""A file is complete or absent, and what was there before is never half overwritten."""

import ast
import errno
import os
import signal
import stat
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from precursors.support.files import write_atomically

WRITE_SLOWLY = """
import sys, time
from precursors.support.files import write_atomically
with write_atomically(sys.argv[1]) as temporary:
    temporary.write_text("half")
    print("writing", flush=True)
    time.sleep(60)
"""


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


@pytest.fixture
def slow_writer(tmp_path):
    """A process that has begun to write table.csv and goes on for a minute."""
    command = [sys.executable, "-c", WRITE_SLOWLY, tmp_path / "table.csv"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "writing\n"
        yield process
        process.kill()


def test_what_a_killed_writer_left_is_removed_by_the_next_one(tmp_path, slow_writer):
    slow_writer.send_signal(signal.SIGKILL)
    slow_writer.wait()
    assert len(os.listdir(tmp_path)) == 1
    with write_atomically(tmp_path / "table.csv") as temporary:
        temporary.write_text("whole")
    assert os.listdir(tmp_path) == ["table.csv"]


def test_what_another_process_is_writing_is_not_taken_for_a_leftover(tmp_path, slow_writer):
    with write_atomically(tmp_path / "table.csv") as temporary:
        temporary.write_text("whole")
    assert len(os.listdir(tmp_path)) == 2


def test_hidden_files_of_others_are_no_leftovers(tmp_path):
    others = {".table.csv", ".mine.table.csv", f".{'a' * 16}.another_table.csv"}
    for name in others:
        (tmp_path / name).write_text("x")
    with write_atomically(tmp_path / "table.csv") as temporary:
        temporary.write_text("whole")
    assert set(os.listdir(tmp_path)) == others | {"table.csv"}


def test_no_room_is_an_error_that_names_the_file(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old")

    def fill_the_disk():
        with write_atomically(path):
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OSError, match=r"^cannot write .*table\.csv: No space left on device$"):
        fill_the_disk()
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["table.csv"]


ROOT = Path(__file__).parents[2]
WRITERS = {"copyfile", "copytree", "savefig", "to_csv", "write_bytes", "write_text"}
WHOLE = {"write_atomically", "write_checked", "write_sealed"}
# Logs, a page of docs/, and what is copied for Typst into a directory that is thrown away.
NO_RESULTS = {"job.py", "list_figures.py", "pages.py: shutil.copytree", "pages.py: target.write_bytes"}


def written_in_place(path):
    """Calls that write a file outside a block that renames it, as file: what is written to."""

    def visit(node, inside):
        if isinstance(node, ast.With):
            calls = [item.context_expr for item in node.items]
            inside = inside or any(isinstance(c, ast.Call) and ast.unparse(c.func) in WHOLE for c in calls)
        if not inside and isinstance(node, ast.Call):
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if name in WRITERS:
                yield f"{path.name}: {ast.unparse(node.func)}"
            values = [*node.args, *(keyword.value for keyword in node.keywords)]
            modes = {v.value for v in values if isinstance(v, ast.Constant) and isinstance(v.value, str)}
            if name in ("open", "File") and any(
                set("wxa") & set(m) and set(m) <= set("wxa+bt") for m in modes
            ):
                yield f"{path.name}: {ast.unparse(node)}"
        for child in ast.iter_child_nodes(node):
            yield from visit(child, inside)

    yield from visit(ast.parse(path.read_text(encoding="utf-8")), inside=False)


def test_no_result_is_written_in_place():
    files = [*(ROOT / "src").rglob("*.py"), *(ROOT / "workflow/scripts").glob("*.py")]
    assert len(files) > 100
    found = {call for path in files if path.name != "storage.py" for call in written_in_place(path)}
    assert not {c for c in found if c not in NO_RESULTS and c.split(":")[0] not in NO_RESULTS}


def test_a_result_that_is_written_in_place_is_seen(tmp_path):
    calls = [
        "table.to_csv(path)",
        "path.open('w')",
        "path.open(mode='wb')",
        "open(path, 'x', encoding='utf-8')",
        "h5py.File(path, 'w')",
        "shutil.copyfile('a', path)",
    ]
    (tmp_path / "a.py").write_text("\n".join([*calls, "open(path)", "path.open('rb')"]))
    assert len(list(written_in_place(tmp_path / "a.py"))) == len(calls)
