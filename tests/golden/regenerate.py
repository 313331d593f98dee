"""Replace the golden files by what the workflow and the library give; `git diff` shows
what changed."""

import shutil
import sys
from pathlib import Path

import check_claims
from explorer import example
from golden import benchmark_page
from golden.kept import pictures, write_picture, write_table
from golden.small_tables import small_larger_tables

from precursors.support.files import read_table, write_text, write_whole

GOLDEN = Path(__file__).parent
ROOT = GOLDEN.parents[1]
PAPERS_SCENES = ("fig10", "fig11", "fig12")
TABLES = (
    *(f"{scene}_slips.csv" for scene in PAPERS_SCENES),
    "reproduction.csv",
    "eq15.csv",
    "claims.csv",
    "open_points.csv",
)
FIGURES = tuple(
    f"{figure}.png"
    for figure in ("fig09", *PAPERS_SCENES, "fig13", "hero", "push", "speed")
)
# What is read without a build.
BUILT = {
    "explorer.html": "docs/explorer.html",
    "paper.pdf": "paper/paper.pdf",
    "supplement.pdf": "paper/supplement.pdf",
}


def main(results: Path, golden: Path = GOLDEN) -> None:
    """Copy golden files from `results` to `golden`, and make the small ones."""
    for kind, names in (("tables", TABLES), ("figures", FIGURES)):
        for name in names:
            shutil.copyfile(results / kind / name, golden / name)
    shutil.copyfile(results / "figures/wave.svg", golden / "wave.svg")
    claims = read_table(golden / "claims.csv")
    write_text(
        golden / "check.txt",
        f"{check_claims.printed(claims)}\n",
    )
    benchmark_page.write(read_table(results / "tables/benchmark.csv"))
    for name, table in small_larger_tables().items():
        write_table(name, table)
    for name, how in pictures().items():
        write_picture(golden / f"small/{name}.png", how)
    write_whole(example.PICTURE, example.picture())
    for name, kept in BUILT.items():
        shutil.copyfile(results / name, ROOT / kept)


if __name__ == "__main__":
    try:
        main(Path("results"))
    except OSError as error:
        sys.exit(f"golden files: {error}")
