"""Replace the golden files by what the workflow and the library give; `git diff` shows
what changed."""

import shutil
import sys

from explorer import example
from golden import benchmark_page
from golden.kept import SMALL, pictures, write_picture
from places import GOLDEN, RESULTS, ROOT, made

from precursors.support.files import write_whole

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
    for figure in ("fig09", *PAPERS_SCENES, "fig13", "hero", "mean", "push", "speed")
)
# What is read without a build.
BUILT = {
    "explorer.html": "docs/explorer.html",
    "paper.pdf": "paper/paper.pdf",
    "supplement.pdf": "paper/supplement.pdf",
}


def main() -> None:
    """Copy golden files from results/, and make the small ones."""
    for kind, names in (("tables", TABLES), ("figures", FIGURES)):
        for name in names:
            shutil.copyfile(RESULTS / kind / name, GOLDEN / name)
    shutil.copyfile(RESULTS / "figures/wave.svg", GOLDEN / "wave.svg")
    benchmark_page.write(made("benchmark"))
    for name, how in pictures().items():
        write_picture(SMALL / f"{name}.png", how)
    write_whole(example.PICTURE, example.picture())
    for name, kept in BUILT.items():
        shutil.copyfile(RESULTS / name, ROOT / kept)


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(f"golden files: {error}")
