"""Print the paper's numbers beside ours, and where the figures are."""

from __future__ import annotations

import sys
from pathlib import Path

from precursors.support.files import read_table

QUANTITIES = {
    "events_counted": "events counted in Fig. 13, the first global slip included",
    "mu_sapp": "apparent static friction coefficient mu_sapp",
    "global_slip_s": "time of the first global slip",
    "global_slip_load_N": "load at the first global slip",
    "events_to_global_slip": "all events up to the first global slip",
}


# Results to open first. Another slider than the paper's has no article.
PAGES = ("paper.pdf", "supplement.pdf", "explorer.html", "figures")


def main(results: str | Path) -> None:
    """Print the table of the reproduction with four digits per number, and what to
    open next."""
    table = (
        read_table(Path(results, "tables/reproduction.csv"))
        .rename_axis(index=None)
        .set_index("scene")
    )
    table["quantity"] = table["quantity"].map(QUANTITIES)
    print(
        table.to_string(
            float_format="{:.4g}".format, na_rep="-", justify="left", index_names=False
        )
    )
    there = [str(Path(results, name)) for name in PAGES if Path(results, name).exists()]
    print(f"Open {', '.join(there)}; `make check` prints the claims of the paper.")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except (ValueError, OSError) as error:
        sys.exit(f"reproduction: {error}")
