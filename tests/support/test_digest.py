"""The digest of a job's code: it changes with what the job computes, and with nothing
else."""

import pytest

from maegawa2010.support import digest

SCRIPT = '''\
"""Add."""
from typing import TYPE_CHECKING
import helper
from precursors import Given
from precursors.room.sums import add
if TYPE_CHECKING:
    from precursors.room import types
'''
SUMS = '''\
def add(a, b):
    """Add."""
    from precursors import parts
    return a + b
'''
LAZY = """\
from importlib import import_module
from typing import TYPE_CHECKING
if TYPE_CHECKING:
    from precursors.given import Given
    from precursors.later import Later
def __getattr__(name):
    return import_module(name)
"""
FILES = {
    "workflow/scripts/script.py": SCRIPT,
    "workflow/scripts/helper.py": "def help_out():\n    return 1\n",
    "workflow/scripts/other.py": "x = 1\n",
    "src/precursors/__init__.py": LAZY,
    "src/precursors/given.py": "class Given:\n    pass\n",
    "src/precursors/later.py": "class Later:\n    pass\n",
    "src/precursors/__main__.py": "x = 1\n",
    "src/precursors/room/__init__.py": "",
    "src/precursors/room/types.py": "x = 1\n",
    "src/precursors/room/unused.py": "x = 1\n",
    "src/precursors/room/sums.py": SUMS,
    "src/precursors/parts/__init__.py": (
        "from importlib import import_module\nname = 'one'\nimport_module(f'{__name__}.{name}')\n"
    ),
    "src/precursors/parts/one.py": "x = 1\n",
}


@pytest.fixture
def root(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


SCRIPT_FILE = "workflow/scripts/script.py"
SUMS_FILE = "src/precursors/room/sums.py"


@pytest.mark.parametrize(
    ("name", "text", "changes"),
    [
        (SCRIPT_FILE, SCRIPT.replace("Add.", "Add two numbers."), False),
        (SUMS_FILE, SUMS.replace("a + b", "(a\n        + b)  # all"), False),
        ("workflow/scripts/other.py", "x = 2\n", False),
        ("src/precursors/room/types.py", "x = 2\n", False),
        ("src/precursors/given.py", "class Given:\n    x = 1\n", True),
        ("src/precursors/later.py", "class Later:\n    x = 1\n", False),
        (SCRIPT_FILE, f"{SCRIPT}x = 1\n", True),
        ("workflow/scripts/helper.py", "def help_out():\n    return 2\n", True),
        (SUMS_FILE, SUMS.replace("a + b", "a - b"), True),
        (
            "src/precursors/parts/one.py",
            "x = 2\n",
            True,
        ),  # by a name that only a run knows
    ],
)
def test_the_digest_changes_with_what_the_script_computes_and_with_nothing_else(
    root, name, text, changes
):
    digests = []
    for content in (FILES[name], text):
        (root / name).write_text(content, encoding="utf-8")
        digest._read.cache_clear()
        digests.append(digest.digest_code(root, "script"))
    assert (digests[0] != digests[1]) == changes


def test_a_script_that_is_not_there_is_named(root):
    with pytest.raises(OSError, match="missing"):
        digest.digest_code(root, "missing")


def test_all_that_a_package_imports_later_is_read_with_it_but_not_its_command_line(
    root,
):
    digests = []
    script = root / SCRIPT_FILE
    script.write_text("import precursors\n", encoding="utf-8")
    for name in ("", "__main__.py", "later.py"):
        if name:
            (root / "src/precursors" / name).write_text("x = 2\n", encoding="utf-8")
        digest._read.cache_clear()
        digests.append(digest.digest_code(root, "script"))
    assert digests[0] == digests[1] != digests[2]
