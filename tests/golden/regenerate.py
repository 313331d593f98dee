"""Replace the golden tables and figures by what the workflow and the library give, and print what changed."""

import shutil
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
from figures import explorer_sessions, test_pictures
from golden import small_tables
from matplotlib import image

GOLDEN = Path(__file__).parent
PAPERS_SCENES = ("fig10", "fig11", "fig12")
TABLES = (
    *(f"{scene}_slips.csv" for scene in PAPERS_SCENES),
    "mu_sapp.csv",
    "reproduction.csv",
    "eq15.csv",
    "claims.csv",
)
FIGURES = tuple(f"{figure}.png" for figure in ("fig09", *PAPERS_SCENES, "fig13"))


def main(results: Path, golden: Path = GOLDEN) -> None:
    """Copy golden files from `results` to `golden`, and make the small ones."""
    for kind, names in (("tables", TABLES), ("figures", FIGURES)):
        for name in names:
            replace(golden / name, partial(shutil.copyfile, results / kind / name))
    for name, make in {**small_tables.TABLES, **small_tables.ELSEWHERE}.items():
        replace(golden / f"small/{name}.csv", partial(small_tables.write, make()))
    for name in test_pictures.PICTURES:
        replace(golden / f"small/{name}.png", partial(test_pictures.save_small, name))
    replace(golden / "small/explorer.csv", partial(explorer_sessions.recorded().to_csv, index=False))


def replace(path: Path, write: Callable[[Path], object]) -> None:
    """Write a golden file anew, and print what changed."""
    new = path.with_stem(f"new_{path.stem}")
    write(new)
    difference = table_difference if path.suffix == ".csv" else figure_difference
    print(f"{path.name}: {difference(path, new) if path.exists() else 'new'}")
    new.replace(path)


def table_difference(old_path: Path, new_path: Path) -> str:
    """Columns that differ, numbers by their largest difference."""
    old, new = (pd.read_csv(path) for path in (old_path, new_path))
    if list(old.columns) != list(new.columns) or len(old) != len(new):
        return (
            f"{len(old)} rows of {', '.join(old.columns)} became {len(new)} rows of {', '.join(new.columns)}"
        )
    changes = []
    for name in old.columns:
        a, b = old[name], new[name]
        differs = ~((a == b) | (a.isna() & b.isna()))
        if not differs.any():
            continue
        change = f"{name} differs in {differs.sum()} of {len(old)} rows"
        if all(pd.api.types.is_float_dtype(column) for column in (a, b)):
            change += f", by {np.abs(a - b).max():.3g} at most"
        changes.append(change)
    return "; ".join(changes) or "same"


def figure_difference(old_path: Path, new_path: Path) -> str:
    """Root mean square difference of the pixels, on the scale 0..255 of Matplotlib's compare_images."""
    old, new = (image.imread(path)[..., :3].astype(float) * 255 for path in (old_path, new_path))
    if old.shape != new.shape:
        return f"{old.shape[1]} x {old.shape[0]} pixels became {new.shape[1]} x {new.shape[0]}"
    rms = np.sqrt(np.mean((old - new) ** 2))
    return f"rms {rms:.3g}" if rms else "same"


if __name__ == "__main__":
    try:
        main(Path("results"))
    except OSError as error:
        sys.exit(f"golden files: {error}")
