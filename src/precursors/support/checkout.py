"""Find the commit of the sources."""

import json
import subprocess
import warnings
from importlib.metadata import distribution
from pathlib import Path

COMMIT_FILE = "commit.json"  # result of `git_state` when the wheel was built


def git_state(root: Path, ignored: str = "") -> dict[str, str | bool] | None:
    """Return the commit of the sources, its identifiers, and whether files outside the
    folder `ignored` have changed.

    The software hash identifiers (SWHID) are git's own hashes. The result is None if
    git does not track the sources.
    """
    is_known = _git(root, "ls-files", "Snakefile")
    if not is_known or not (hashes := _git(root, "show", "-s", "--format=%H %T")):
        return None
    commit, tree = hashes.split()
    others = [f":(exclude){ignored}"] if ignored else []
    return {
        "commit": commit,
        "swh_revision": f"swh:1:rev:{commit}",
        "swh_directory": f"swh:1:dir:{tree}",
        "changed": bool(_git(root, "status", "--porcelain", "--", ".", *others)),
    }


def built_state() -> dict[str, str | bool] | None:
    """Return the `git_state` from which the installed wheel was built, or None if the
    wheel has no record of it."""
    text = distribution("precursors").read_text(f"extra_metadata/{COMMIT_FILE}")
    state: dict[str, str | bool] | None = json.loads(text) if text else None
    return state


def _git(root: Path, *command: str) -> str:
    """Return the output of a git command, or nothing if it fails; in a checkout, a
    failure gives a warning."""
    try:
        answer = subprocess.run(
            ["git", "-C", root, *command], capture_output=True, text=True
        )
    except OSError:
        return ""
    if answer.returncode == 0:
        return answer.stdout.strip()
    if (root / ".git").exists():  # it belongs to another user, or has no commit
        why = answer.stderr.partition("\n")[0]
        warnings.warn(f"the commit is unknown: git says {why!r}", stacklevel=2)
    return ""
