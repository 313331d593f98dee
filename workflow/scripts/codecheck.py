"""Compare the files of codecheck.yml with those kept in tests/golden."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from matplotlib import image

GOLDEN = Path("tests/golden")
# Numbers differ between machines by roundings; pixels (0 to 1) by the release of
# Matplotlib.
RELATIVE = 1e-6
ABSOLUTE = 1e-9
PIXELS = 0.02
# Exponents of a chaotic motion, which stand in some claims, differ between processors;
# verdicts do not.
COLUMNS = {"claims.csv": ["claim", "verdict"]}


def manifest() -> list[str]:
    """The files of codecheck.yml."""
    content = yaml.safe_load(Path("codecheck.yml").read_text("utf-8"))
    return [entry["file"] for entry in content["manifest"]]


def difference(made: Path, kept: Path) -> str:
    """Say where a table or figure differs from the one that is kept; empty if it does
    not."""
    if made.suffix == ".png":
        drawn, expected = (image.imread(path) for path in (made, kept))
        same = (
            drawn.shape == expected.shape
            and np.sqrt(np.mean((drawn - expected) ** 2)) <= PIXELS
        )
        return "" if same else "another picture"
    tables = [
        pd.read_csv(path, usecols=COLUMNS.get(made.name)) for path in (made, kept)
    ]
    # A column may hold numbers and formulas.
    numbers = [table.apply(pd.to_numeric, errors="coerce") for table in tables]
    texts = [table.where(n.isna()) for table, n in zip(tables, numbers, strict=True)]
    try:
        for new, old in (numbers, texts):
            pd.testing.assert_frame_equal(new, old, rtol=RELATIVE, atol=ABSOLUTE)
    except AssertionError as error:
        return " ".join(str(error).split())
    return ""


def main() -> None:
    """Print a line for each file; the exit code is that of the worst."""
    found = {
        file: difference(Path(file), GOLDEN / Path(file).name) for file in manifest()
    }
    for file, problem in found.items():
        print(f"{file}: {problem or 'as kept'}")
    print(
        f"{sum(not problem for problem in found.values())} of {len(found)} files as kept"
    )
    sys.exit(any(found.values()))


if __name__ == "__main__":
    if "--list" in sys.argv:
        print(*manifest())
    else:
        try:
            main()
        except OSError as error:
            sys.exit(f"codecheck: {error}")
