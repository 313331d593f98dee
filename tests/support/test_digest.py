"""The digest of the code of a job changes only with what the job computes."""

import pytest

from maegawa2010.support import digest

SCRIPT = '''\
"""Add."""
import precursors.whole
from precursors import Given
from precursors.room.sums import add
'''
SUMS = '''\
def add(a, b):
    """Add."""
    from precursors import parts
    return a + b
'''
FILES = {
    "workflow/studies/adding/script.py": SCRIPT,
    "workflow/scripts/other.py": "x = 1\n",
    "src/precursors/__init__.py": "from precursors.given import Given\n",
    "src/precursors/__main__.py": "x = 1\n",
    "src/precursors/given.py": "class Given:\n    pass\n",
    "src/precursors/whole.py": "x = 1\n",
    "src/precursors/room/__init__.py": "",
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


SCRIPT_FILE = "workflow/studies/adding/script.py"
SUMS_FILE = "src/precursors/room/sums.py"


@pytest.mark.parametrize(
    ("name", "text", "changes"),
    [
        (SCRIPT_FILE, SCRIPT.replace("Add.", "Add two numbers."), False),
        (SUMS_FILE, SUMS.replace("a + b", "(a\n        + b)  # all"), False),
        ("workflow/scripts/other.py", "x = 2\n", False),
        ("src/precursors/__main__.py", "x = 2\n", False),
        ("src/precursors/room/unused.py", "x = 2\n", False),
        (SCRIPT_FILE, f"{SCRIPT}x = 1\n", True),
        (SUMS_FILE, SUMS.replace("a + b", "a - b"), True),
        ("src/precursors/given.py", "class Given:\n    x = 1\n", True),
        ("src/precursors/whole.py", "x = 2\n", True),
        # imported by a name that is only known at run time
        ("src/precursors/parts/one.py", "x = 2\n", True),
    ],
)
def test_digest_changes_only_with_what_is_computed(root, name, text, changes):
    digests = []
    for content in (FILES[name], text):
        (root / name).write_text(content, encoding="utf-8")
        digest._read.cache_clear()
        digests.append(digest.digest_code(root, "script"))
    assert (digests[0] != digests[1]) == changes


def test_missing_or_duplicate_script_is_named(root):
    with pytest.raises(OSError, match=r"missing\.py must be one .* but there are 0"):
        digest.digest_code(root, "missing")
    (root / "workflow/script.py").touch()
    with pytest.raises(OSError, match=r"script\.py must be one .* but there are 2"):
        digest.digest_code(root, "script")
