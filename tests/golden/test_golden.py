"""Tables and figures of the build equal those in this directory, and small pictures equal
those beside their tests; `make golden` replaces both."""

import re
from pathlib import Path

import codecheck
import pandas as pd
import pytest
from golden.regenerate import BUILT, pictures, write_picture
from pdf_text import pages_of
from places import GOLDEN, RESULTS, ROOT

PICTURES = pictures()


@pytest.mark.parametrize("file", codecheck.manifest(ROOT))
def test_a_table_or_figure_equals_the_golden_one(file):
    assert codecheck.difference(ROOT / file, GOLDEN / Path(file).name) == ""


@pytest.mark.parametrize("path", PICTURES, ids=lambda path: path.stem)
def test_a_small_picture_equals_the_golden_one(path, tmp_path):
    drawn = tmp_path / path.name
    write_picture(drawn, PICTURES[path])
    assert codecheck.difference(drawn, path) == ""


def test_every_check_of_eq_15_holds():
    assert pd.read_csv(RESULTS / "tables/eq15.csv")["holds"].eq(True).all()


# Samples near a discontinuity, and means of chaotic motion, differ between processors.
DATA = re.compile(r'(id="data">).*?(?=</script>)', re.DOTALL)
# Computing times differ in each build.
TIMES = re.compile(r"[\d.]+ [µm]s")


@pytest.mark.parametrize("name", BUILT)
def test_committed_documents_are_those_of_the_build(name):
    built = RESULTS / name
    committed = ROOT / BUILT[name]
    if name.endswith(".pdf"):
        built, committed = (
            [TIMES.sub("", page) for page in pages_of(file.read_bytes())]
            for file in (built, committed)
        )
    else:
        built, committed = (
            DATA.sub(r"\1", file.read_text("utf-8")) for file in (built, committed)
        )
    assert built == committed, "older than the build: make golden"
