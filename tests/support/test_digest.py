"""The digest of a job's code: it changes with what the job computes, and with nothing else."""

import pytest

from precursors.support import digest

SCRIPT = '''\
"""Add."""
from typing import TYPE_CHECKING
import helper
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
FILES = {
    "workflow/scripts/script.py": SCRIPT,
    "workflow/scripts/helper.py": "def help_out():\n    return 1\n",
    "workflow/scripts/other.py": "x = 1\n",
    "src/precursors/__init__.py": "",
    "src/precursors/room/__init__.py": "",
    "src/precursors/room/types.py": "x = 1\n",
    "src/precursors/room/unused.py": "x = 1\n",
    "src/precursors/room/sums.py": SUMS,
    "src/precursors/parts/__init__.py": (
        "from importlib import import_module\nname = 'one'\nimport_module(f'{__name__}.{name}')\n"
    ),
    "src/precursors/parts/one.py": "x = 1\n",
    "src/precursors/named.py": "x = 1\n",
}


@pytest.fixture
def root(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def changes(root, name, text, *modules):
    """Whether the digest of script.py is another one after a file has got this text."""
    digests = []
    for content in (FILES[name], text):
        (root / name).write_text(content, encoding="utf-8")
        digest._read.cache_clear()
        digests.append(digest.digest_code(root, "script", *modules))
    return digests[0] != digests[1]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("workflow/scripts/script.py", SCRIPT.replace("Add.", "Add two numbers.")),
        ("src/precursors/room/sums.py", SUMS.replace("Add.", "Add it.")),
        (
            "src/precursors/room/sums.py",
            "def add(a, b):\n    from precursors import parts  # all\n    return (a\n        + b)\n",
        ),
        ("workflow/scripts/other.py", "x = 2\n"),
        ("src/precursors/room/unused.py", "x = 2\n"),
        ("src/precursors/room/types.py", "x = 2\n"),
        ("src/precursors/named.py", "x = 2\n"),
    ],
    ids=[
        "docstring of the script",
        "docstring",
        "comment and format",
        "script",
        "module",
        "types",
        "by name",
    ],
)
def test_what_is_not_computed_does_not_change_it(root, name, text):
    assert not changes(root, name, text)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("workflow/scripts/script.py", f"{SCRIPT}x = 1\n"),
        ("workflow/scripts/helper.py", "def help_out():\n    return 2\n"),
        ("src/precursors/room/sums.py", SUMS.replace("a + b", "a - b")),
        ("src/precursors/parts/one.py", "x = 2\n"),
    ],
    ids=["the script", "beside it", "a module", "imported by a name that only a run knows"],
)
def test_what_the_script_computes_changes_it(root, name, text):
    assert changes(root, name, text)


def test_a_module_that_the_rule_names_belongs_to_it(root):
    assert changes(root, "src/precursors/named.py", "x = 2\n", "named")


def test_a_script_that_is_not_there_is_named(root):
    with pytest.raises(OSError, match="missing"):
        digest.digest_code(root, "missing")
