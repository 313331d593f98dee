"""Try everything and print the table: `make test-faults`; FAULTS_SHARE=0.1 tries a tenth."""

from __future__ import annotations

import os
import sys
import time
from importlib import import_module

from faults.outcome import table

MODULES = ("physics", "damage", "configuration", "kill", "disk", "machines")


def main(names: list[str]) -> int:
    """Try the faults of some modules, or of all; return 1 if anything was lost."""
    share = float(os.environ.get("FAULTS_SHARE", "1"))
    if not 0 < share <= 1:
        sys.exit(f"FAULTS_SHARE = {share:g}: allowed is a share of the trials, above 0 and up to 1")
    unknown = sorted(set(names) - set(MODULES))
    if unknown:
        sys.exit(f"{unknown[0]!r} is no fault: allowed are {', '.join(MODULES)}")
    outcomes = []
    for name in names or MODULES:
        begin = time.monotonic()
        outcomes += import_module(f"faults.{name}").try_all(share, processes=2)
        print(f"{name}: {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
    print(table(outcomes))
    lost = [line for outcome in outcomes for line in outcome.lost]
    for line in lost:
        print(f"LOST  {line}")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
