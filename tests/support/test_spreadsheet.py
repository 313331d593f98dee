"""Tables as people have them are read as they are meant, or refused in one line."""

import numpy as np
import pytest

from precursors.support.spreadsheet import (
    LOAD,
    TIME,
    read_columns,
    read_weights,
)

LOADS = [20.0, 30.5]
ROWS = [[0.0, 0.0], [0.5, 40.25]]
NEEDED = "needed: normal load of each block"


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "table.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


@pytest.mark.parametrize(
    "text",
    [
        "20\n30.5\n",
        "load [N]\n20\n30.5",
        "20, 30.5, 40",
        "20 30.5 40\n",
        "1;20\n2;30.5",
        "\ufeffNormalkraft [N]\r\n20,00\r\n30,50\r\n",
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
        "b1;b2;b3\n20,0;30,5;40,0\n",
    ],
)
def test_the_load_of_each_block_is_read_as_spreadsheets_write_it(file, text):
    assert read_weights(file(text))[:2] == LOADS


@pytest.mark.parametrize(
    ("text", "about"),
    [
        ("load, N\n1,5\n2,5\n3,5\n", "'3,5' may be one number with a decimal comma"),
        (
            "Normalkraft [N]\n1.018,00\n30,5\n",
            "line 2: '1.018,00' has a separator of thousands",
        ),
        (
            'load [N]\n30.5\n"1,018.00"\n',
            "line 3: '1,018.00' has a separator of thousands",
        ),
        ("Force (N)\n1\u202f018,00\n30,5\n", "has a separator of thousands"),
        ("Normalkraft [kN]\n0,020\n0,030\n", "the column 'Normalkraft [kN]' is in kN"),
        ("Normalkraft;x\n1.5;\n2,5;\n", "has decimal commas and decimal points"),
        ("Normalkraft [N]\n#N/A\n30,5\n", "line 2: '#N/A' is not a number"),
        ("Block;Normalkraft [N]\n1;20,0\n2;\n", "line 3: '' is not a number"),
        ("Block;Normalkraft [N]\n2;20,0\n1;30,5\n", NEEDED),
        ("b1;20\nb2;30\nSumme;50\n", NEEDED),
        ("1;30;0\n2;40;0\n", NEEDED),
        (b"PK\x03\x04\0\0", "in the spreadsheet, save the table as CSV"),
    ],
)
def test_loads_that_may_be_others_are_refused_in_one_line(file, text, about):
    refuses(read_weights, file(text), about)


@pytest.mark.parametrize(
    "text",
    [
        "0.0,0.0\n0.5,40.25\n",
        "t [s];F_X [N]\r\n0;0\r\n0,5;40,25\r\n",
        "\ufefft\tF\n\n0\t0\n5e-1\t4.025E1\n",
        '"t";"F"\n"0";"0"\n"0,5";"40,25"\n',
        '"t","F"\n"0,0","0,0"\n"0,5","40,25"\n',
        "# measured on Monday\n0 0\n 0.5   40.25",
        "t [s] F_X [N]\n0 0\n0.5 40.25",
        "Zeit [s];Kraft über alles [N]\n0;0\n0,5;40,25\n".encode("cp1252"),
        "Zeit;Kraft\ns;N\n0;0\n0,5;40,25\n",
        "F_X [N],t [s]\n0.0,0.0\n40.25,0.5\n",
        "t [s];Weg [mm];F_X [N]\n0;1;0\n0,5;2;40,25\n",
    ],
)
def test_columns_are_found_by_unit_by_name_or_in_order(file, text):
    np.testing.assert_array_equal(read_columns(file(text), [TIME, LOAD]), ROWS)


@pytest.mark.parametrize(
    ("text", "about"),
    [
        ("0,0\n1,500\n", "decimal comma"),
        ("t [ms];F [N]\n1;2\n", "the column 't [ms]' is in ms; needed: t [s]"),
        ("t_s,F_X_kN\n1,2\n", "is in kN"),
        ("t [s];Signal [V]\n0;0\n", "the column 'Signal [V]' is in V"),
        ("t [ms] F [kN]\n0;0\n", "columns: 2; needed: t [s], F_X [N]"),
        ("t [s];F_X [N];F_Y [N]\n0;1;0\n", "line 2: columns: 3"),
        ("1;2\n3;x\n", "line 2: 'x' is not a number"),
        ("1;2\n3;1.234,5\n", "line 2: '1.234,5' has a separator of thousands"),
        ("nan;1\n", "line 1: 'nan' is not a number"),
        ("1;1e999\n", "line 1: '1e999' is not a number"),
        ("1;2\n3\n", "line 2: '' is not a number"),
        ("1\n2\n", "line 1: columns: 1"),
        ("t;F\n", "has no numbers"),
        ("", "has no numbers"),
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
