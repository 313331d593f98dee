"""Check the existing results without recomputing them (`make check`): print every claim
with its verdict.

The exit code is 1 if a verdict is not the expected one, or if a result has changed
since it was made.
"""

import sys
from pathlib import Path

from maegawa2010.paper.check import check


def main(
    results: str | Path = "results",
    expected: str | Path = "tests/golden/claims.csv",
) -> None:
    """Print the claims with the verdicts in a results directory; exit with 1 if
    something is wrong."""
    try:
        claims, wrong = check(Path(results), expected)
    except FileNotFoundError as error:
        sys.exit(f"check: {error.filename} is missing: run make all first")
    except (OSError, ValueError) as error:
        sys.exit(f"check: {error}")
    print(claims)
    if wrong:
        sys.exit("\n".join(f"check: {line}" for line in wrong))


if __name__ == "__main__":
    main(*sys.argv[1:])
