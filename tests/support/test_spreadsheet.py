"""Tables as people have them are read as they are meant, or refused in one line."""

import numpy as np
import pandas as pd
import pytest

from precursors.support import files
from precursors.support.spreadsheet import (
    LENGTH,
    LOAD,
    TIME,
    read_columns,
    read_profile,
    read_weights,
)

LOADS = [20.0, 30.5]
ROWS = [[0.0, 0.0], [0.5, 40.25]]
NEEDED = "needed: w [N], one a line"
NO_UNIT = "is not one of F_X [N]"
NO_LOAD = "is known as F_X [N]: choose one with --columns"
READ_FROM = pytest.mark.filterwarnings("ignore:.* is read from")
LABVIEW = """\
LabVIEW Measurement\t
Time\t12:30:01.123
***End_of_Header***\t
\t
Channels\t1\t
Y_Unit_Label\tNewton\t
X_Dimension\tTime\t
***End_of_Header***\t\t
X_Value\tKanal 1\tComment
0.0\t0.0
0.5\t40.25
"""


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "table.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


@READ_FROM
@pytest.mark.parametrize(
    "text",
    [
        "20\n30.5\n",
        "load [N]\n20\n30.5",
        "20, 30.5, 40",
        "20 30.5 40\n",
        "1;20\n2;30.5",
        "\ufeffNormalkraft [N]\r\n20,00\r\n30,50\r\n",
        "Блок;Нагрузка, Н\n1;20,0\n2;30,5\n",
        "Charge répartie (N)\r\n20,00\r\n30,50\r\n".encode("cp1252"),
        "Last\r\n20,0\r\n30,5\r\n;\r\n;;\r\n\r\n",
        "sep=;\r\nNormalkraft [N]\r\n20,0\r\n30,5\r\n",
        "b1;20,00\r\nb2;30,50\r\n",
        "b1,20\nb2,30.5\n",
        '"Block","Load [N]"\r\n"1","20,00"\r\n"2","30,50"\r\n',
        "Block;Normalkraft\r\n;[N]\r\n1;20,00\r\n2;30,50\r\n",
        "Messung vom Montag\nBlock;Normalkraft [N]\n1;20,0\n2;30,5\n",
        "Block\tNormalkraft [N]\t\r\n1,0\t20,00\t\r\n2,0\t30,50\t\r\n",
        "Block;Position [mm];Normalkraft [N]\n1;5;20,0\n2;15;30,5\n",
    ],
)
def test_the_load_of_each_block_is_read_as_spreadsheets_write_it(file, text):
    assert read_weights(file(text))[:2] == LOADS


@pytest.mark.parametrize(
    ("text", "about"),
    [
        ("load, N\n1,5\n2,5\n3,5\n", "may be one number with a decimal comma, or two"),
        ("1,20\n2,30\n", "may be one number with a decimal comma, or two"),
        ("block,w [N]\n1,10,5\n2,20,5\n", "line 2: cells: 3, columns: 2"),
        ("w\n1,000\n2,500\n", "'1,000' may have a decimal comma or be in thousands"),
        ("Normalkraft [N]\n1.018,00\n30,5\n", "decimal commas and decimal points"),
        ("Pressure\n20\n30\n", "none of 'Pressure' is known as w [N]: choose one with"),
        ("F x1e3 [N]\n0.04\n0.05\n", "none of 'F x1e3 [N]' is known"),
        (
            "Normalkraft [lbs]\n20\n30\n",
            "the unit of 'Normalkraft [lbs]' is not one of w [N]",
        ),
        ("Load, gf\n20.5\n30.5\n", "none of 'Load, gf' is known"),
        ("Normalkraft;x\n1.5;\n2,5;\n", "has decimal commas and decimal points"),
        ("Block;Normalkraft [N]\n1;#N/A\n2;30,5\n", "line 2: '#N/A' is not a number"),
        ("Block;Normalkraft [N]\n1;20,0\n2;\n", "line 3: '' is not a number"),
        ("Block;Normalkraft [N]\n2;20,0\n1;30,5\n", NEEDED),
        ("b1;20\nb2;30\nSumme;50\n", NEEDED),
        ("1;30;0\n2;40;0\n", "none of '1', '2' is known as w [N]"),
        ("x;w [N]\n0.3;20\n0.2;30\n", NEEDED),
        (b"PK\x03\x04\0\0", "in the spreadsheet, save the table as CSV"),
    ],
)
def test_loads_that_may_be_others_are_refused_in_one_line(file, text, about):
    refuses(read_weights, file(text), about)


@READ_FROM
@pytest.mark.parametrize(
    "text",
    [
        "t [s];F_X [N]\r\n0;0\r\n0,5;40,25\r\n",
        "\ufefft\tF\n\n0\t0\n5e-1\t4.025E1\n",
        '"t";"F"\n"0";"0"\n"0,5";"40,25"\n',
        '"t","F"\n"0,0","0,0"\n"0,5","40,25"\n',
        "# measured on Monday\nt F\n0 0\n 0.5   40.25",
        "t [s] F_X [N]\n0 0\n0.5 40.25",
        "Zeit [s];Kraft über alles [N]\n0;0\n0,5;40,25\n".encode("cp1252"),
        "F_X [N],t [s]\n0.0,0.0\n40.25,0.5\n",
        "t [s];Weg [mm];F_X [N]\n0;1;0\n0,5;2;40,25\n",
        "Time,Force,T\ns,N,°C\n0,0.0,9\n0.5,40.25,9\n",
        "Time (s),F_X (N),F_Y (N)\n0.0,0.0,9\n0.5,40.25,9\n",
        "Time (Sekunden),Force (Newtons)\n0.0,0.0\n0.5,40.25\n",
        "Operator: N. N.\nDate;1.5.2024\nTime;Force\ns;N\n0;0\n0,5;40,25\n",
        "Zeit;Kraft\n1.5.2024 23:59:59,6;0\n2.5.2024 0:00:00,1;40,25\n",
        "Time [hh:mm:ss],Force [N]\n12:30:01.5,0.0\n12:30:02,40.25\n",
        LABVIEW,
        "Время, с;Сила, Н\n0;0\n0,5;40,25\n",
        "時間;変位;荷重\n秒;mm;N\n0;1;0\n0.5;2;40.25\n",
        "time_s;Ft/N;Fn/N\n0;0;9\n0,5;40,25;9\n",
        "Zeit (s);Reibkraft (N);Normalkraft (N)\n0;0;9\n0,5;40,25;9\n",
        "Time [s],Sliding Time [s],Normal Force [N],Friction Force [N],Coefficient of "
        "Friction\n0,9,9,0,9\n0.5,9,9,40.25,9\n",
        "onset_s,end_s,load_before_N,load_after_N\n0,9,0,9\n0.5,9,40.25,9\n",
        "Tempo (in sec.);Forza (in N)\n0;0\n0,5;40,25\n",
        "t F\n0,0 0,0\n0,5 40,25\n",
        "% Time (s)   Force (N)\n0 0\n0.5 40.25\n",
        "Time,Force\n2024-05-01T12:30:01.5+09:00,0.0\n2024-05-01T12:30:02+09:00,40.25\n",
    ],
)
def test_columns_are_found_by_name_or_by_unit(file, text):
    np.testing.assert_array_equal(read_columns(file(text), [TIME, LOAD]), ROWS)


@READ_FROM
@pytest.mark.parametrize(
    ("text", "choice"),
    [
        ("T,signal\n0,0\n0.5,40.25\n", {"t": "T", "F_X": "signal"}),
        ("t [s],delay [s],F\n9,0,0\n9,0.5,40.25\n", {"t": "delay [s]"}),
        ("0,0.0\n0.5,40.25\n", {"t": "1", "F_X": "2"}),
    ],
)
def test_columns_may_be_chosen(file, text, choice):
    read = read_columns(file(text), [TIME, LOAD], choice=choice)
    np.testing.assert_array_equal(read, ROWS)


@pytest.mark.filterwarnings("always")
@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("t [ms];F [kN]\n0;0\n500;0,04025\n", ["t [ms]", "F [kN]"]),
        (
            "F_X_mN,Time (minutes)\n0.0,0.0\n40250,0.00833333333333333333\n",
            ["minutes", "mN"],
        ),
        ("Time,Load\nmsec,kN\n0,0.0\n500,0.04025\n", ["msec", "kN"]),
        ("Время, мс;Сила, кН\n0;0\n500;0,04025\n", ["мс", "кН"]),
        ("TIME MSEC,LOAD-KN\n0,0.0\n500,0.04025\n", ["MSEC", "KN"]),
        ("t;Load cell 2 [N]\n0;0\n0.5;40.25\n", ["F_X [N] is read from 'Load cell 2"]),
        ("Time..ms.,Force..kN.\n0,0.0\n500,0.04025\n", ["ms", "kN"]),
        ("# of Monday\n# t (ms), F (kN)\n0,0.0\n500,0.04025\n", ["t (ms)", "F (kN)"]),
        ("# t F\n# ms kN\n#\n0 0\n500 0.04025\n", ["t [ms]", "F [kN]"]),
        ("t;F\n0;0\n0,25;\n0,5;40,25\n", ["rows without a value: 1"]),
        (pd.DataFrame({"F [kN]": [0, 0.04025], "t [s]": [0, 0.5]}), ["F [kN]"]),
    ],
)
def test_what_is_converted_or_left_out_is_told(file, text, told, recwarn):
    table = file(text) if isinstance(text, str) else text
    read = read_columns(table, [TIME, LOAD])
    np.testing.assert_allclose(read, ROWS, rtol=1e-15)
    assert len(recwarn) == len(told)
    for warning, words in zip(recwarn, told, strict=True):
        assert words in str(warning.message)


def test_a_column_of_loads_has_the_times_of_its_sample_rate(file):
    read = read_columns(file("F\n1,5\n2,5\n"), [TIME, LOAD], 10.0)
    assert read.tolist() == [[0.0, 1.5], [0.1, 2.5]]
    with pytest.raises(ValueError, match="no line may stand empty"):
        read_columns(file("F\n1,5\n\n2,5\n"), [TIME, LOAD], 10.0)


def test_a_profile_is_a_column_or_a_matrix_without_positions(file):
    assert read_profile(file("p [MPa]\n1\n2\n")).tolist() == [[1.0], [2.0]]
    assert read_profile(file("0;1\n0;2\n")).tolist() == [[0.0, 1.0], [0.0, 2.0]]
    for text in ("x;p\n1;1\n2;0\n", "1;1\n2;0\n3;0\n"):
        refuses(read_profile, file(text), "without names and positions")
    refuses(read_profile, file("1;2;3\n"), "lines: 1; needed: a line for each position")
    refuses(
        read_profile, file("Temperature\n1\n2\n"), "none of 'Temperature' is known as p"
    )
    chosen = read_profile(file("x;p\n1;1\n2;0\n"), {"p": "p"})
    assert chosen.tolist() == [[1.0], [0.0]]


@READ_FROM
@pytest.mark.parametrize(
    "text",
    [
        "L_p/L [1];F_X [N]\n0,5;100\n",
        "L_p [%];F_X [N]\n50;100\n",
        "F_X [N],L_p [mm]\n100,20\n",
        "load_before_N,front,front_length_m,slider_length_m\n100,5,0.02,0.04\n",
    ],
)
def test_lengths_are_shares_of_the_slider(file, text):
    read = read_columns(file(text), [LOAD, LENGTH], length=0.04)
    assert read.tolist() == [[100.0, 0.5]]


@pytest.mark.parametrize(
    ("text", "about"),
    [
        (
            "0;0\n1;500\n",
            "none of '1', '2' is known as t [s]: choose one with --columns",
        ),
        ("t [s],F [N]\n0,0,10,5\n0,1,20,5\n", "line 2: cells: 4, columns: 2"),
        ("t [s],F [N],,\n0,0,10,5\n", "line 2: cells: 4, columns: 2"),
        ("t [s];F [N]\n0;10\n1;20;5\n", "line 3: cells: 3, columns: 2"),
        ("Temps, s,F [N]\n0.0,1.5,7\n", "a name may have a comma"),
        ("t a F\n0 1\n", "line 2: cells: 2, columns: 3"),
        ('t,F\n"0"1,2\n', "expected after"),
        ("t [s];Signal [V]\n0;0\n", NO_LOAD),
        ("Time (s),Force (mV)\n0,1.5\n", NO_UNIT),
        ("Time,Load\nsec,g\n0,1.5\n", NO_UNIT),
        ("t_h,F_lbf\n0,1.5\n", "is known as t [s]: choose"),
        ("t (s);Druck (MPa)\n0;1\n", NO_LOAD),
        ("t \uff08s\uff09,F \uff08千克\uff09\n0,1.5\n", NO_UNIT),
        ("Время, с;Сила, Н\n0;0\n".encode("cp1251"), "is known as t [s]: choose"),
        ("t;Сила, кH\n0;0\n", NO_LOAD),  # the H is Latin
        ("t;F [MN]\n0;0\n", NO_UNIT),
        ("t;Weight g\n0;0\n", NO_LOAD),
        ("t/10^-3 s;F/N\n0;0\n", "is known as t [s]: choose"),
        ("t;Load %\n0;0\n", NO_UNIT),
        (
            LABVIEW.replace("Newton", "Volts"),
            f"none of 'X_Value', 'Kanal 1 [Volts]', 'Comment' {NO_LOAD}",
        ),
        ("t [s];A [N];B [N]\n0;1;0\n", f"each of 'A [N]', 'B [N]' {NO_LOAD}"),
        ("Time;F\n1.5.2024 0:00:00;1\n3.5.2024 0:00:00;1\n", "half a day"),
        (f"t;F\n0;1\n{'1' * 140_000};2\n", "field larger than field limit"),
        ("t;F\n1;2\n3;x\n", "line 3: 'x' is not a number"),
        (
            "Weg;Kraft [N]\n0;0\n",
            "none of 'Weg', 'Kraft [N]' is known as t [s]",
        ),
        ("Frame,Force\n0,1.0\n", "none of 'Frame', 'Force' is known as t [s]"),
        *(
            (f"Time;{name}\n0;0\n", f"none of 'Time', '{name}' {NO_LOAD}")
            for name in ("Temperature", "Fz", "mu", "F_X/400", "F^2", "load share")
        ),
        *(
            (f"Time;{name} [N]\n0;0\n", NO_LOAD)
            for name in ("Fz", "F_N", "F x1e3", "F^2", "Nominal Normal Force", "dF")
        ),
        (f"{LABVIEW}\nChannels\t1\t\n", "'Channels' is not a number"),
        ("t;F\nnan;1\n", "line 2: 'nan' is not a number"),
        ("t;F\n1;1e999\n", "line 2: '1e999' is not a number"),
        ("", "there are no numbers"),
    ],
)
def test_what_cannot_be_understood_for_certain_is_refused_in_one_line(
    file, text, about
):
    refuses(lambda path: read_columns(path, [TIME, LOAD]), file(text), about)


def refuses(read, path, about):
    with pytest.raises(ValueError, match=r"table\.csv") as refused:
        read(path)
    assert about in str(refused.value)
    assert "\n" not in str(refused.value)


def test_what_may_have_no_end_is_not_read(file, monkeypatch):
    with pytest.raises(OSError, match="/dev/zero: it is not a regular file"):
        read_weights("/dev/zero")
    monkeypatch.setattr(files, "MOST_READ", 3)
    with pytest.raises(OSError, match="it has more than 3 bytes"):
        read_weights(file("10\n20\n"))
