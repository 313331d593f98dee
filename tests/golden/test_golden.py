"""Tables and figures that the workflow wrote to results are those kept here (`make
golden` replaces them)."""

import re
import shutil

import numpy as np
import pandas as pd
import pytest
from golden.regenerate import BUILT, FIGURES, PAPERS_SCENES
from matplotlib.testing.compare import compare_images
from pdf_text import pages_of
from places import GOLDEN, RESULTS, ROOT

# What the project promises for times [s], whatever the processor; a load [N] is off by
# some 200 N/s of the error in its time. After the first global slip errors have grown
# by 1e7: the motion is chaotic.
UP_TO_GLOBAL_SLIP = {"s": 1e-9, "N": 1e-6}
AFTER_GLOBAL_SLIP = {"s": 1e-6, "N": 1e-3}
# mu_sapp is a load over 400 N; everything else in these tables happens up to the first
# global slip.
SUMMARY = UP_TO_GLOBAL_SLIP | {"1": 1e-8}
# Checks of Eq. 15 hold to rounding; the linear program is solved to 1e-9 relative.
EQ15_RELATIVE = 1e-8
# Root mean square over all pixels and colours, of 255. The same release of Matplotlib
# draws the same picture; antialiasing may differ by a few grey levels here and there.
# Of the edits tried (colours, markers, sizes, dashes, words, a moved point) the least,
# fewer arrows in an inset, is worth 1.4.
FIGURE_RMS = 0.5


def assert_golden(
    found: pd.DataFrame, golden: pd.DataFrame, allowed: dict[str, float]
) -> None:
    """Words, counts and flags are the golden ones, and so are numbers of these columns
    to this difference."""
    assert list(found.columns) == list(golden.columns)
    for column in golden:
        if column in allowed:
            np.testing.assert_allclose(
                found[column], golden[column], 0, allowed[column], err_msg=column
            )
        else:
            np.testing.assert_array_equal(found[column], golden[column], err_msg=column)


def tables(name: str) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The table that the workflow wrote, and the golden one."""
    return pd.read_csv(RESULTS / "tables" / name), pd.read_csv(GOLDEN / name)


@pytest.mark.parametrize("scene", PAPERS_SCENES)
def test_slips_are_the_golden_ones(scene):
    found, golden = tables(f"{scene}_slips.csv")
    units = {
        "onset_s": "s",
        "end_s": "s",
        "load_before_N": "N",
        "load_after_N": "N",
        "largest_load_N": "N",
    }
    n = int(np.argmax(golden["is_global"])) + 1
    for rows, allowed in (
        (slice(n), UP_TO_GLOBAL_SLIP),
        (slice(n, None), AFTER_GLOBAL_SLIP),
    ):
        assert_golden(
            found[rows],
            golden[rows],
            {column: allowed[unit] for column, unit in units.items()},
        )
    assert len(found) == len(golden)


def test_the_reproduction_is_the_golden_one():
    found, golden = tables("reproduction.csv")
    for unit, of_unit in golden.groupby("unit"):
        assert_golden(found.loc[of_unit.index], of_unit, {"reproduced": SUMMARY[unit]})


def test_every_check_of_eq_15_holds_and_is_the_golden_one():
    """In numbers and in symbols."""
    found, golden = tables("eq15.csv")
    assert found["holds"].eq(True).all()
    for column in ("expected", "found"):
        numbers, kept = (
            pd.to_numeric(table[column], errors="coerce") for table in (found, golden)
        )
        np.testing.assert_allclose(numbers, kept, rtol=EQ15_RELATIVE)
        found[column], golden[column] = (
            table[column].where(numbers.isna()) for table in (found, golden)
        )
    pd.testing.assert_frame_equal(found, golden)


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_the_golden_one(name, tmp_path):
    # The comparison leaves a picture of the differences beside the one it compares.
    found = shutil.copy(RESULTS / "figures" / name, tmp_path)
    assert compare_images(str(GOLDEN / name), found, tol=FIGURE_RMS) is None


# Draws near a jump, and means of chaotic motion, fall otherwise on other processors.
DATA = re.compile(r'(id="data">).*?(?=</script>)', re.DOTALL)
# Each build measures these anew.
TIMES = re.compile(r"[\d.]+ [µm]s")


@pytest.mark.parametrize("name", BUILT)
def test_what_is_read_without_a_build_says_what_the_build_says(name):
    built = RESULTS / name
    kept = ROOT / BUILT[name]
    if name.endswith(".pdf"):
        built, kept = (
            [TIMES.sub("", page) for page in pages_of(file.read_bytes())]
            for file in (built, kept)
        )
    else:
        built, kept = (
            DATA.sub(r"\1", file.read_text("utf-8")) for file in (built, kept)
        )
    assert built == kept, "older than the build: make golden"
