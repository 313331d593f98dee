"""Files of the library's rooms, for rules that run again when one of them is edited."""

from pathlib import Path


def files_of(library: str | Path, *rooms: str) -> list[str]:
    """Python files of some rooms, in order.

    Parameters
    ----------
    library : path
        Directory of the package.
    *rooms : str
        A room ("solver"), a part of one ("accuracy/proof") or a module ("figures/style").

    Raises
    ------
    ValueError
        If a room has no file.
    """
    found = []
    for room in rooms:
        path = Path(library, room)
        files = sorted(path.rglob("*.py")) if path.is_dir() else [path.with_suffix(".py")]
        if not all(file.is_file() for file in files):
            raise ValueError(f"{path} is neither a room nor a module of the library")
        found += [str(file) for file in files]
    return found
