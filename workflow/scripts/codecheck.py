"""Compare the files of codecheck.yml with those of an earlier build in tests/golden."""

import math
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from matplotlib import image

GOLDEN = Path("tests/golden")
# Largest differences from the golden files that the rounding of another processor may
# cause, by the unit of a number or the suffix of a file. All else must be the same.
TOLERANCES = {
    "s": 1e-9,  # what the project promises for times up to the first global slip
    "N": 1e-6,  # the load grows by 200 N/s; the linear program of Eq. 15 errs by 1e-9
    "1": 1e-8,  # mu_sapp is a load over 400 N
    "m/s": 1e-8,  # a formula, right to rounding
    "1/s": math.inf,  # exponents of a chaotic motion; the verdict must be the same
    # Root mean square difference of all pixels and colours, out of 255. The locked
    # Matplotlib draws the same picture up to smoothing. Real changes of a figure (colours,
    # markers, sizes, dashes, words, a moved point, fewer arrows) gave at least 1.4.
    ".png": 0.5,
}
# Factor on the tolerance after the first global slip, where the motion is chaotic.
AFTER_GLOBAL_SLIP = 1e3


def manifest(root: Path = Path()) -> list[str]:
    """The files of codecheck.yml."""
    content = yaml.safe_load((root / "codecheck.yml").read_text("utf-8"))
    return [entry["file"] for entry in content["manifest"]]


def difference(made: Path, golden: Path) -> str:
    """Describe how a table or figure differs from the golden one; empty if it does not."""
    if not golden.exists():
        return f"{golden} does not exist: run make golden"
    if made.suffix == ".csv":
        return table_difference(made, golden)
    if made.suffix == ".png":
        drawn, expected = (255 * image.imread(path) for path in (made, golden))
        is_same = (
            drawn.shape == expected.shape
            and np.sqrt(np.mean((drawn - expected) ** 2)) <= TOLERANCES[".png"]
        )
    else:
        is_same = made.read_bytes() == golden.read_bytes()
    return "" if is_same else "another picture"


def table_difference(made: Path, golden: Path) -> str:
    """Describe the first value of a table that differs.

    The unit of a value is the end of its column's name, or is in the column `unit`.
    """
    new, old = (
        pd.read_csv(path, dtype=str, keep_default_na=False) for path in (made, golden)
    )
    if list(new) != list(old) or len(new) != len(old):
        return "other columns, or another number of lines"
    growth = 1.0
    rows = zip(new.to_dict("records"), old.to_dict("records"), strict=True)
    for line, (values, expected) in enumerate(rows, start=2):
        of_row = TOLERANCES.get(expected.get("unit", ""), 0.0)
        for column, value in values.items():
            tolerance = TOLERANCES.get(str(column).rpartition("_")[2], of_row)
            if not agree(value, expected[column], growth * tolerance):
                return f"line {line}: {column} is {value}, not {expected[column]}"
        if expected.get("is_global") == "True":
            growth = AFTER_GLOBAL_SLIP
    return ""


def agree(value: str, expected: str, tolerance: float) -> bool:
    """Whether two cells have the same text, or numbers ("6; 9; 14") that differ by no
    more than the tolerance."""
    if value == expected:
        return True
    try:
        new, old = ([float(x) for x in cell.split("; ")] for cell in (value, expected))
    except ValueError:
        return False
    return len(new) == len(old) and all(
        abs(x - y) <= tolerance for x, y in zip(new, old, strict=True)
    )


def main() -> None:
    """Print a line for each file; the exit code is 1 if any differs."""
    problems = {
        file: difference(Path(file), GOLDEN / Path(file).name) for file in manifest()
    }
    for file, problem in problems.items():
        print(f"{file}: {problem or 'the same'}")
    same = sum(not problem for problem in problems.values())
    print(f"{same} of {len(problems)} files are the same")
    sys.exit(same < len(problems))


if __name__ == "__main__":
    if "--list" in sys.argv:
        print(*manifest())
    else:
        try:
            main()
        except OSError as error:
            sys.exit(f"codecheck: {error}")
