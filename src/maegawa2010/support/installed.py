"""Whether Python imports what the checkout holds."""

from importlib.machinery import PathFinder
from pathlib import Path

from maegawa2010.support.provenance import checksums


def check_installed(sources: Path) -> None:
    """Refuse installed packages whose files differ from those of a checkout: a job
    would run the one, and be recorded with the digest of the other.

    Raises
    ------
    ValueError
        In one line with a file that differs.
    """
    for name in ("precursors", "maegawa2010"):
        spec = PathFinder.find_spec(name)
        installed = Path(spec.origin if spec and spec.origin else "").parent
        if installed.resolve() == (sources / name).resolve():
            continue
        ours, theirs = (
            checksums(folder.rglob("*"), folder)
            for folder in (sources / name, installed)
        )
        for file, _ in sorted(ours.items() ^ theirs.items()):
            raise ValueError(
                f"{installed / file} differs from {sources / name / file}: "
                'install this checkout, with pip install -e ".[workflow,paper]"'
            )
