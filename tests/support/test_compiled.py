"""Compiled code is cached on disk, and compiled anew after an edit of any module it was
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
PATIENCE = 300.0  # [s]; a start takes a few seconds unless it hangs
# A small kernel: a function that Python calls, and one in another file that it calls.
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
NOTICE = "compiling the solver for this machine, once: some 10 s\n"


class Small:
    """A package with a copy of the decorators of the kernel, used in its own
    processes."""

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
        """Return the result for 2, the number of cache hits, and standard error."""
        inherited = {
            key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"
        }
        # Python would use old bytecode after an edit within the same second.
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


def test_clones_share_compiled_code_until_an_edit(small, tmp_path):
    assert small.use() == (7, 0, NOTICE)
    (place,) = small.cache.glob("precursors/*")
    clone = Small(tmp_path / "clone")
    clone.cache = small.cache
    assert clone.use() == (7, 1, "")
    # Empty and truncated files, as after a power cut or on a full disk.
    for i, file in enumerate(sorted(place.iterdir())):
        file.write_bytes(file.read_bytes()[: 100 * i])
        assert clone.use() == (7, 0, NOTICE)
    clone.write("part.py", PART.replace("3 * x", "5 * x"))
    assert clone.use() == (11, 0, NOTICE)
    (edited,) = set(small.cache.glob("precursors/*")) - {place}
    others = [place.with_name(f"small-{i}") for i in range(CACHED_VERSIONS + 1)]
    for i, other in enumerate(others):
        other.mkdir()
        os.utime(other, (i, i))
    assert small.use() == (7, 1, "")
    assert set(small.cache.glob("precursors/*")) == {place, edited, *others[3:]}


def test_edits_and_new_names_change_the_checksum(tmp_path):
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


def test_unwritable_cache_compiles_with_a_warning(small):
    # A file in place of a directory also stops root.
    (small.package / "__pycache__").write_text("")
    small.cache.write_text("")
    result, hits, warnings = small.use()
    assert (result, hits) == (7, 0)
    assert "set NUMBA_CACHE_DIR" in warnings
