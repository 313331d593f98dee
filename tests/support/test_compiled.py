"""Compiled code is kept on disk, and compiled anew after an edit of any module it was
made from."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from precursors.solver import kernel
from precursors.support.compiled import CACHED_VERSIONS, checksum

KERNEL = Path(kernel.__file__).parent
PATIENCE = 300.0  # s: a start takes some seconds, far more only if it hangs
# A kernel in small: a function that Python calls, and one that it calls in another
# file.
ENTRY = """
from small.decorators import outer
from small.part import times

@outer
def entry(x):
    return times(x) + 1
"""
PART = """
from small.decorators import inner

@inner
def times(x):
    return 3 * x
"""
USE = """
import json
from numba.core import event
from precursors.support.compiled import Announcement
with event.install_listener("numba:compile", Announcement()):
    from small.entry import entry
    print(json.dumps([entry(2), sum(entry.stats.cache_hits.values())]))
"""
SAID = "compiling the solver for this machine, once: some 10 s\n"


class Small:
    """A package with a copy of the kernel's decorators, used in processes of its
    own."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self.package = directory / "small"
        self.package.mkdir(parents=True)
        shutil.copy(KERNEL / "decorators.py", self.package)
        self.write("__init__.py", "")
        self.write("entry.py", ENTRY)
        self.write("part.py", PART)
        self.cache = directory / "cache"

    def write(self, name: str, text: str) -> None:
        (self.package / name).write_text(text, encoding="utf-8")

    def use(self) -> tuple[int, int, str]:
        """What the entry point returns for 2, how often it came from the cache, and
        what stderr says."""
        inherited = {
            key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"
        }
        # Python would take bytecode for that of an edit in the same second.
        inherited |= {"XDG_CACHE_HOME": str(self.cache), "PYTHONDONTWRITEBYTECODE": "1"}
        process = subprocess.run(
            [sys.executable, "-c", USE],
            cwd=self.directory,
            env=inherited | {"PYTHONPATH": str(self.directory)},
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=True,
        )
        return *json.loads(process.stdout), process.stderr


@pytest.fixture
def small(tmp_path):
    return Small(tmp_path / "with spaces, Ümläute and 摩擦")


def test_another_clone_of_the_user_compiles_nothing_until_an_edit_and_old_code_is_removed(
    small, tmp_path
):
    assert small.use() == (7, 0, SAID)
    (place,) = small.cache.glob("precursors/*")
    clone = Small(tmp_path / "clone")
    clone.cache = small.cache
    assert clone.use() == (7, 1, "")
    # As a power cut or a full disk leaves them: empty, and without an end.
    for i, file in enumerate(sorted(place.iterdir())):
        file.write_bytes(file.read_bytes()[: 100 * i])
        assert clone.use() == (7, 0, SAID)
    clone.write("part.py", PART.replace("3 * x", "5 * x"))
    assert clone.use() == (11, 0, SAID)
    (edited,) = set(small.cache.glob("precursors/*")) - {place}
    others = [place.with_name(f"small-{i}") for i in range(CACHED_VERSIONS + 1)]
    for i, other in enumerate(others):
        other.mkdir()
        os.utime(other, (i, i))
    assert small.use() == (7, 1, "")
    assert set(small.cache.glob("precursors/*")) == {place, edited, *others[3:]}


def test_an_edit_of_any_module_and_a_new_name_change_the_checksum(tmp_path):
    copy = shutil.copytree(
        KERNEL, tmp_path / "kernel", ignore=shutil.ignore_patterns("__pycache__")
    )
    sums = [checksum(KERNEL)]
    assert sums == [checksum(copy)]
    for module in sorted(copy.glob("*.py")):
        module.write_text(module.read_text() + "# edited\n")
        sums.append(checksum(copy))
    module.rename(copy / "zebra.py")
    assert len({*sums, checksum(copy)}) == len(sums) + 1


def test_where_nothing_can_be_written_it_compiles_and_says_so(small):
    # A file where a directory should be stops root as well.
    (small.package / "__pycache__").write_text("")
    small.cache.write_text("")
    result, hits, warnings = small.use()
    assert (result, hits) == (7, 0)
    assert "set NUMBA_CACHE_DIR" in warnings
