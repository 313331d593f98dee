"""Measured tables are read by their names and units, or refused in one line."""

import numpy as np
import pandas as pd
import pytest

from precursors.support import files
from precursors.support.measured import (
    LENGTH,
    LOAD,
    TIME,
    read_profile,
    read_series,
    read_weights,
)

ROWS = [[0.0, 1.0], [0.5, 80.5]]
KRAFT = {"t": "Zeit [ms]", "F_X": "Kraft [kN]"}
BESIDE = "Time (s),Ft (N),Fn (N)\n0,1.0,400\n0.5,80.5,400\n"
HEADER = "Tester 3000\noperator: -\nZeit [ms];Kraft [kN]\n0;0,001\n500;0,0805\n"
REIBKRAFT = "Zeit (s);Reibkraft (N);Normalkraft (N)\n0;1,0;400\n0,5;80,5;400\n"
TRIBOMETER = """\
Time [s],Sliding Time [s],Normal Force [N],Friction Force [N],User Channel 1
0.0,0.0,400.0,1.0,0
0.5,0.4,400.0,80.5,0
"""
EQUAL = "t [s];F [N];F [N]\n0;9;1\n0,5;9;80,5\n"


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "table.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


def curve(source, choice=None, **how):
    ((_, values),) = read_series(source, TIME, [LOAD, LENGTH], 0.1, choice or {}, **how)
    return values


def refuses(read, source, about):
    with pytest.raises(ValueError, match=r"table\.csv: ") as refused:
        read(source)
    assert about in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("text", "how"),
    [
        ("t [s],F_X [N]\n0,1\n0.5,80.5\n", {}),
        ("\ufefft [ms];F_X (kN)\r\n0;0,001\r\n500;0,0805\r\n\r\n", {}),
        ("# Monday\ntime [s]\tForce [N]\tmu\n0\t1,0\t-\n% a pause\n5e-1\t80,5\t\n", {}),
        ('"F_X [N]","t [µs]",F_N [N]\n1,"0",400\n80.5,"5E5",400\n', {}),
        (HEADER, {"header_line": 3, "choice": KRAFT}),
        (BESIDE, {"choice": {"F_X": "Ft"}}),
        (REIBKRAFT, {"choice": {"t": "Zeit (s)", "F_X": "Reibkraft (N)"}}),
        (TRIBOMETER, {"choice": {"t": "Time [s]", "F_X": "Friction Force [N]"}}),
        (EQUAL, {"choice": {"F_X": "3"}}),
        ("t [s];Kraft [N]\n0;0,001\n0,5;0,0805\n", {"choice": {"F_X": "Kraft [kN]"}}),
        ("a, b;F(raw)\n0;1\n0,5;80,5\n", {"choice": {"t": "a, b [s]", "F_X": "2 [N]"}}),
        ("1\n80.5\n", {"sample_rate": 2.0}),
    ],
)
def test_columns_are_read_by_name_and_unit_or_chosen(file, text, how):
    np.testing.assert_allclose(curve(file(text), **how), ROWS, rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "how", "about"),
    [
        ("t [s],F [N]\n0,0,10,5\n", {}, "line 2: cells: 4, columns: 2 (write decimal"),
        ("t [s];F [N]\n0;10;5\n", {}, "line 2: cells: 3"),
        ("t [s],F_X [N],a\n0,10\n", {}, "line 2: cells: 2"),
        ("Time,Temperature\n0,23.1\n", {}, '"t=Time [s],F_X=NAME [N]"'),
        ("Time,Fz\n0,400.2\n", {}, "the columns are 'Time', 'Fz': choose with"),
        (
            REIBKRAFT,
            {},
            "may be column 2, 'Reibkraft (N)' or column 3, 'Normalkraft (N)'",
        ),
        (TRIBOMETER, {}, "'Normal Force [N]' or column 4, 'Friction Force [N]'"),
        ("Frame,Force\n0,1\n", {}, 'choose with --columns "t=NAME [s],F_X=Force [N]"'),
        ("Zeit (s);Kraft (kN)\n0;1\n", {}, '--columns "t=Zeit (s),F_X=Kraft (kN)"'),
        (
            BESIDE,
            {},
            "may be column 2, 'Ft (N)' or column 3, 'Fn (N)'; the columns are",
        ),
        (
            "t [s],load [N],friction [N]\n0,4,1\n",
            {},
            "'load [N]' or column 3, 'friction",
        ),
        (BESIDE, {"choice": {"F_X": "Reibung"}}, "no column is Reibung"),
        (EQUAL, {"choice": {"F_X": "F"}}, "column 2, 'F [N]' or column 3"),
        (
            "t [s],F_X [V]\n0,1\n",
            {},
            "'F_X [V]' needs one of these units in brackets: N",
        ),
        ("t [s],F_X N\n0,1\n", {}, "no column is F_X [N]"),
        (
            HEADER,
            {},
            "'Tester 3000' is not the name of a column: if line 3 has the names",
        ),
        ("0,1\n0.5,2\n", {}, "line 1: '0' is no name"),
        ("t [s],F_X [N]\n0,0\n1,9\n0.2,1\n", {}, "line 4: t [s] must rise, but 0.2"),
        ("t [s];F_X [N]\n0,5;1.018\n", {}, "decimal commas and decimal points"),
        ("t [s],F_X [N]\n0,1e999\n", {}, "line 2: '1e999' is not a number"),
        ('t [s],F_X [N]\n0,"1,5"\n', {}, "line 2: '1,5' is not a number"),
        ('t [s],F_X [N]\n"0"1,2\n', {}, "expected after"),
        ("t [s],F_X [N]\n", {}, "there are no numbers"),
        ("", {}, "line 1 has no names"),
        ("t [s],F_X [N]\n0,1\n", {"sample_rate": 1.0}, "leave out --sample-rate"),
        ("Zeit [s];Kraft [N]\nä".encode("cp1252"), {}, "not UTF-8"),
    ],
)
def test_ambiguous_curve_is_refused(file, text, how, about):
    refuses(lambda path: curve(path, **how), file(text), about)


def test_pandas_table_follows_the_same_rules():
    frame = pd.DataFrame({"F_X [kN]": [0.001, 0.0805], "t [s]": [0, 0.5]}, [7, 3])
    np.testing.assert_allclose(curve(frame), ROWS, rtol=1e-15)
    for wrong, about in (
        (frame.rename(columns={"t [s]": "Zeit [s]"}), 'as in "t=Zeit'),
        (frame.replace(0.5, np.nan), "row 2: 'nan' is not a number"),
        (frame[:0], "there are no numbers"),
    ):
        with pytest.raises(ValueError, match=about):
            curve(wrong)


@pytest.mark.parametrize(
    ("text", "about"),
    [
        ("20\n30.5\n", ""),
        ("w [N]\n20\n30.5\n", ""),
        ("Block;load [kN]\n1;0,02\n2;0,0305\n", ""),
        ("block,w [N]\n1,10,5\n2,20,5\n", "line 2: cells: 3, columns: 2"),
        ("Block,w [N]\n1,10\n3,20\n", "line 3: block must be 2, but is '3'"),
        ("F x1e3 [N]\n0.04\n", "no column is w [N]"),
        ("w [N]\nnan\n30\n", "line 2: 'nan' is not a number: write one, or 0"),
        ("nan\n30\n", "line 1: 'nan' is not a number"),
        ("w [N]\n20\n#N/A\n30\n", "line 3: '#N/A' is not a number"),
        ("w [N]\n20\n\n30\n", "line 3: cells: 0"),
        ("w [N]\n1,000\n", "line 2: cells: 2, columns: 1"),
    ],
)
def test_normal_loads_are_read_one_per_block(file, text, about):
    if about:
        refuses(read_weights, file(text), about)
    else:
        assert read_weights(file(text)) == [20.0, 30.5]


def test_a_profile_has_its_positions_or_equal_cells(file):
    points = read_profile(file("x [mm],p [MPa]\n0,1\n10,2\n40,5\n"))
    assert points.tolist() == [[0.0, 0.01, 0.04], [1.0, 2.0, 5.0]]
    assert read_profile(file("p [MPa]\n1\n2\n")).tolist() == [[1.0, 2.0]]
    for text, about in (
        ("0,1\n10,2\n", "line 1: '0' is no name"),
        ("Ort [mm];p [MPa]\n0;1\n", 'choose with --columns "x=Ort [mm],p=p [MPa]"'),
        ("x [mm],p [MPa]\n10,1\n5,2\n", "line 3: x [m] must rise"),
    ):
        refuses(read_profile, file(text), about)


@pytest.mark.parametrize(
    "front", ["L_p [mm]\n20", "L_p/L\n0.2", "front length [%]\n20"]
)
def test_front_lengths_are_shares_of_the_slider(file, front):
    name, value = front.split("\n")
    path = file(f"t [s],{name}\n0.4,{value}\n")
    assert curve(path).tolist() == [[0.4, 0.2]]
    path = file(f"Zeit,{name}\n400,{value}\n")
    assert curve(path, {"t": "Zeit [ms]"}).tolist() == [[0.4, 0.2]]
    path = file(f"t [s],{name}\n0.4,{value}0\n".replace(".20", "1.2"))
    refuses(curve, path, "line 2: L_p/L must be between 0 and 1")


def test_front_lengths_are_read_against_the_load(file):
    path = file("F_X [N],L_p [mm]\n60,20\n120,50\n190,100\n")
    ((_, values),) = read_series(path, LOAD, [LENGTH], 0.1)
    assert values.tolist() == [[60.0, 0.2], [120.0, 0.5], [190.0, 1.0]]


def test_a_table_may_have_loads_and_front_lengths(file):
    path = file("t [s],F_X [N],L_p [mm]\n0,1,20\n")
    loads, lengths = read_series(path, TIME, [LOAD, LENGTH], 0.1)
    assert (loads[0], lengths[0]) == (LOAD, LENGTH)
    assert (loads[1].tolist(), lengths[1].tolist()) == ([[0.0, 1.0]], [[0.0, 0.2]])


def test_endless_or_special_file_is_not_read(file, monkeypatch):
    with pytest.raises(OSError, match="/dev/zero: it is not a regular file"):
        read_weights("/dev/zero")
    monkeypatch.setattr(files, "MOST_READ", 3)
    with pytest.raises(OSError, match="it has more than 3 bytes"):
        read_weights(file("10\n20\n"))
