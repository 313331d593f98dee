"""The kernel's compile cache: an edit of any file is seen, and no fault of the cache is one of ours."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from precursors.solver import kernel
from precursors.solver.compile_cache import stamp

KERNEL = Path(kernel.__file__).parent
MODULES = sorted(file.name for file in KERNEL.glob("*.py"))
PATIENCE = 300.0  # s: a start takes some seconds, far more only if it hangs
# A kernel in small, compiled as the large one is: an entry point, and what it calls in another file.
ENTRY = """
from small.compiled import outer
from small.part import times

@outer
def entry(x):
    return times(x) + 1
"""
PART = """
from small.compiled import inner

@inner
def times(x):
    return 3 * x
"""
USE = """
import json
from small.entry import entry
values = [entry(2), entry(0.5)]
print(json.dumps([values, sum(entry.stats.cache_hits.values())]))
"""
# A disk with room for the index of the cache, but not for the code.
FULL = """
from numba.core import caching
def full(self, name, data):
    raise OSError(28, "No space left on device")
caching.IndexDataCacheFile._save_data = full
"""


class Small:
    """A package with a copy of the kernel's decorators, used in processes of its own."""

    def __init__(self, directory: Path) -> None:
        self.directory, self.package = directory, directory / "small"
        self.package.mkdir(parents=True)
        shutil.copy(KERNEL / "compiled.py", self.package)
        self.write("__init__.py", "")
        self.write("entry.py", ENTRY)
        self.write("part.py", PART)

    def write(self, name: str, text: str) -> None:
        (self.package / name).write_text(text, encoding="utf-8")

    def start(self, code: str = USE, **environment: str) -> subprocess.Popen[str]:
        inherited = {key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"}
        return subprocess.Popen(
            [sys.executable, "-c", code],
            cwd=self.directory,
            env=inherited | {"PYTHONPATH": str(self.directory)} | environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def use(self, **environment: str) -> tuple[list[float], int, str]:
        """What the entry point returns for 2 and 0.5, how many came from the cache, and the warnings."""
        out, err = (process := self.start(**environment)).communicate(timeout=PATIENCE)
        assert process.returncode == 0, err
        values, hits = json.loads(out)
        return values, hits, err

    @property
    def kept(self) -> list[Path]:
        """Files of the cache."""
        return sorted(self.directory.rglob("*.nb[ic]"))


@pytest.fixture
def small(tmp_path):
    return Small(tmp_path / "with spaces, Ümläute and 摩擦")


def test_what_was_compiled_is_used_again_and_an_edit_of_what_it_calls_is_seen(small):
    assert small.use()[:2] == ([7, 2.5], 0)
    assert small.use()[:2] == ([7, 2.5], 2)
    small.write("part.py", PART.replace("3 * x", "5 * x"))
    assert small.use()[:2] == ([11, 3.5], 0)
    assert small.use()[:2] == ([11, 3.5], 2)


def test_code_of_the_version_before_is_not_used_where_the_new_could_not_be_written(small):
    small.use()
    small.write("part.py", PART.replace("3 * x", "5 * x"))
    small.start(FULL + USE).communicate(timeout=PATIENCE)
    assert small.use()[0] == [11, 3.5]


def test_only_entry_points_are_kept(small):
    small.use()
    assert {file.name.split("-")[0] for file in small.kept} == {"entry.entry"}


@pytest.mark.parametrize("module", MODULES)
def test_an_edit_of_any_module_makes_the_kernel_compile_anew(module, tmp_path):
    copy = shutil.copytree(KERNEL, tmp_path / "kernel", ignore=shutil.ignore_patterns("__pycache__"))
    before = stamp(copy)
    assert before == stamp(KERNEL)
    with (copy / module).open("a") as file:
        file.write("# edited\n")
    assert stamp(copy) != before


def test_a_module_that_is_added_or_renamed_makes_the_kernel_compile_anew(tmp_path):
    copy = shutil.copytree(KERNEL, tmp_path / "kernel", ignore=shutil.ignore_patterns("__pycache__"))
    before = stamp(copy)
    (copy / "watch.py").rename(copy / "watched.py")
    renamed = stamp(copy)
    (copy / "new.py").write_text("")
    assert len({before, renamed, stamp(copy)}) == 3


def test_the_cache_lies_where_it_is_asked_to(small, tmp_path):
    place = tmp_path / "elsewhere"
    assert small.use(NUMBA_CACHE_DIR=str(place))[0] == [7, 2.5]
    assert list(place.rglob("*.nbc"))
    assert small.kept == []
    assert small.use(NUMBA_CACHE_DIR=str(place))[1] == 2


def test_where_nothing_can_be_written_it_compiles_and_says_so(small, tmp_path):
    # A file where a directory should be stops root as well.
    (small.package / "__pycache__").write_text("")
    (tmp_path / "home").write_text("")
    nowhere = {"HOME": str(tmp_path / "home"), "XDG_CACHE_HOME": str(tmp_path / "home")}
    values, hits, warnings = small.use(**nowhere)
    assert (values, hits) == ([7, 2.5], 0)
    assert "set NUMBA_CACHE_DIR" in warnings


@pytest.mark.parametrize("kind", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", [lambda content: b"", lambda content: content[: len(content) // 2]])
def test_a_damaged_cache_is_made_anew(small, kind, damage):
    small.use()
    for file in small.kept:
        if file.suffix == f".{kind}":
            file.write_bytes(damage(file.read_bytes()))
    assert small.use()[0] == [7, 2.5]
    assert small.use()[:2] == ([7, 2.5], 2)


def test_code_for_other_arguments_under_the_name_of_ours_is_not_used(small):
    # Two processes that begin with an empty cache may write different signatures to the same file.
    small.use()
    first, second = (file for file in small.kept if file.suffix == ".nbc")
    integers, numbers = first.read_bytes(), second.read_bytes()
    first.write_bytes(numbers)
    second.write_bytes(integers)
    assert repr(small.use()[0]) == "[7, 2.5]"  # and not 7.0


def test_two_processes_may_compile_at_once(small):
    processes = [small.start() for _ in range(2)]
    for process in processes:
        out, err = process.communicate(timeout=PATIENCE)
        assert process.returncode == 0, err
        assert json.loads(out)[0] == [7, 2.5]
    assert small.use()[0] == [7, 2.5]


def test_a_part_called_from_python_is_an_error_and_no_crash(small):
    process = small.start("from small.part import times\ntimes(2)")
    assert "TypeError" in process.communicate(timeout=PATIENCE)[1]
    assert process.returncode == 1
