"""The files that an independent check compares, and the differences that it allows."""

from pathlib import Path

import codecheck
import numpy as np
import pandas as pd
import pytest
import yaml
from matplotlib import image
from places import ROOT


def test_every_compared_file_has_a_comment_and_is_made(untouched):
    text = (ROOT / "codecheck.yml").read_text(encoding="utf-8")
    manifest = yaml.safe_load(text)["manifest"]
    files = {entry["file"] for entry in manifest if entry["comment"]}
    assert len(files) == len(manifest) > 10
    assert files <= untouched[1].made


def write_rows(path: Path, **columns: object) -> Path:
    pd.DataFrame(columns).to_csv(path, index=False)
    return path


SLIPS = {"onset_s": [1.0, 2.0, 3.0], "front": [4, 10, 5]}
SLIPS |= {"load_before_N": [28.0, 194.0, 50.0], "is_global": [False, True, False]}
CLAIMS = {"claim": ["count", "chaos"], "unit": ["1", "1/s"]}
CLAIMS |= {"ours": ["6; 9", "2.0; 0.2"], "verdict": ["holds", "holds"]}


@pytest.mark.parametrize(
    ("golden", "column", "values", "problem"),
    [
        (SLIPS, "onset_s", [1.0, 2.0 + 0.9e-9, 3.0], ""),
        (SLIPS, "onset_s", [1.0, 2.0 + 1.2e-9, 3.0], "line 3: onset_s is 2.0000000012"),
        (SLIPS, "onset_s", [1.0, 2.0, 3.0 + 0.9e-6], ""),
        (SLIPS, "onset_s", [1.0, 2.0, 3.0 + 1.2e-6], "line 4: onset_s is 3.0000012"),
        (SLIPS, "load_before_N", [28.0 + 0.9e-6, 194.0, 50.0], ""),
        (SLIPS, "load_before_N", [28.0, 194.0, np.nan], "line 4: load_before_N is , "),
        (SLIPS, "front", [4, 10, 6], "line 4: front is 6, not 5"),
        (SLIPS, "is_global", [False] * 3, "line 3: is_global is False, not True"),
        (SLIPS, "theta", 0.0, "other columns, or"),
        (CLAIMS, "ours", ["6; 9.000000001", "1.9; 0.3"], ""),
        (CLAIMS, "ours", ["6; 10", "2.0; 0.2"], "line 2: ours is 6; 10, not 6; 9"),
        (CLAIMS, "ours", ["6", "2.0; 0.2"], "line 2: ours is 6, not 6; 9"),
        (CLAIMS, "ours", ["6; 9", "none"], "line 3: ours is none, not 2.0; 0.2"),
        (CLAIMS, "verdict", ["holds", "fails"], "line 3: verdict is fails, not holds"),
    ],
)
def test_a_number_may_differ_by_the_tolerance_of_its_unit(
    tmp_path, golden, column, values, problem
):
    expected = write_rows(tmp_path / "golden.csv", **golden)
    made = write_rows(tmp_path / "made.csv", **golden | {column: values})
    difference = codecheck.difference(made, expected)
    assert difference.startswith(problem)
    assert bool(difference) == bool(problem)


@pytest.mark.parametrize(
    ("place", "grey", "is_same"),
    [
        ((0, 0), 131, True),
        ((0, 0), 135, False),
        (slice(None), 129, False),
    ],
)
def test_a_picture_may_differ_by_half_a_grey_level(tmp_path, place, grey, is_same):
    pixels = np.full((8, 8, 3), 128, np.uint8)
    image.imsave(tmp_path / "golden.png", pixels)
    pixels[place] = grey
    image.imsave(tmp_path / "made.png", pixels)
    image.imsave(tmp_path / "cut.png", pixels[1:])
    differences = [
        codecheck.difference(tmp_path / name, tmp_path / "golden.png")
        for name in ("made.png", "cut.png")
    ]
    assert differences == ["" if is_same else "another picture", "another picture"]


def test_each_file_has_a_line_and_one_that_differs_fails(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tests/golden").mkdir(parents=True)
    for name, golden in (("a", "1.0"), ("b", "2.0")):
        (tmp_path / f"{name}.svg").write_text("1.0")
        (tmp_path / f"tests/golden/{name}.svg").write_text(golden)
    (tmp_path / "codecheck.yml").write_text("manifest: [{file: a.svg}, {file: b.svg}]")
    with pytest.raises(SystemExit) as ended:
        codecheck.main()
    report = "a.svg: the same\nb.svg: another picture\n1 of 2 files are the same\n"
    assert (ended.value.code, capsys.readouterr().out) == (True, report)
