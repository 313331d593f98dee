"""The commit of the sources."""

import json
import subprocess
import warnings
from importlib.metadata import distribution
from pathlib import Path

COMMIT_FILE = "commit.json"  # what `git_state` said when the wheel was built


def git_state(root: Path) -> dict[str, str | bool] | None:
    """Commit of the sources, its software hash identifiers, and whether files were
    changed since.

    None where git does not know the sources. The identifiers (SWHID) are git's own
    hashes.
    """
    is_known = _git(root, "ls-files", "Snakefile")
    if not is_known or not (told := _git(root, "show", "-s", "--format=%H %T")):
        return None
    commit, tree = told.split()
    return {
        "commit": commit,
        "swh_revision": f"swh:1:rev:{commit}",
        "swh_directory": f"swh:1:dir:{tree}",
        "changed": bool(_git(root, "status", "--porcelain")),
    }


def built_state() -> dict[str, str | bool] | None:
    """The same of the sources that the installed wheel was built from; None where it
    does not say."""
    text = distribution("precursors").read_text(f"extra_metadata/{COMMIT_FILE}")
    state: dict[str, str | bool] | None = json.loads(text) if text else None
    return state


def _git(root: Path, *command: str) -> str:
    """Output of a git command, or nothing where it fails; in a checkout with a
    warning."""
    try:
        answer = subprocess.run(
            ["git", "-C", root, *command], capture_output=True, text=True
        )
    except OSError:
        return ""
    if answer.returncode == 0:
        return answer.stdout.strip()
    if (root / ".git").exists():  # of another user, or without a commit
        why = answer.stderr.partition("\n")[0]
        warnings.warn(f"the commit is unknown: git says {why!r}", stacklevel=2)
    return ""
