"""Tables as people have them are read as they are meant, or refused in one line."""

import numpy as np
import pytest

from precursors.model.scenes import read_weights
from precursors.model.spreadsheet import read_columns

TIME_AND_LOAD = ["t [s]", "F_X [N]"]
ROWS = [[0.0, 0.0], [0.5, 40.25]]


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
        "0.0,0.0\n0.5,40.25\n",
        "time,load\n0,0\n.5,40.25\n",
        "t [s];F_X [N]\r\n0;0\r\n0,5;40,25\r\n",
        "\ufefft\tF\n\n0\t0\n5e-1\t4.025E1\n",
        '"t";"F"\n"0";"0"\n"0,5";"40,25"\n',
        "# measured on Monday\n0 0\n 0.5   40.25",
        "Zeit [s];Kraft über alles [N]\n0;0\n0,5;40,25\n".encode("cp1252"),
    ],
)
def test_separators_decimal_commas_and_headers_are_understood(file, text):
    np.testing.assert_array_equal(
        read_columns(file(text), TIME_AND_LOAD, exactly=True), ROWS
    )


@pytest.mark.parametrize(
    ("text", "about"),
    [
        ("0,0\n1,500\n", "decimal comma"),
        ("1,5e3\n", "decimal comma"),
        ("t [ms];F [N]\n1;2\n", "line 1: the column 't [ms]' is in ms"),
        ("t;F [kN]\n1;2\n", "is in kN"),
        ("t_s,F_X_kN\n1,2\n", "is in kN"),
        ("1;2\n3;x\n", "line 2: 'x' is not a number"),
        ("1;2\n3;1.234,5\n", "line 2: '1.234,5' is not a number"),
        ("nan;1\n", "line 1: 'nan' is not a number"),
        ("1;1e999\n", "line 1: '1e999' is not a number"),
        ("30N;1\n", "line 1: '30N' is not a number"),
        ("1;2\n3\n", "line 2: columns: 1, in line 1: 2"),
        ("1\n2\n", "line 1: columns: 1"),
        ("t;F\n", "a header and no numbers"),
        ("", "is empty"),
        ("PK\x03\x04\0\0", "is not plain text"),
    ],
)
def test_what_cannot_be_understood_for_certain_is_refused_in_one_line(
    file, text, about
):
    with pytest.raises(ValueError, match=r"table\.csv") as refused:
        read_columns(file(text), TIME_AND_LOAD, exactly=True)
    assert about in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "text", ["30\n40\n50\n", "load [N]\n30\n40\n50", "30, 40, 50", "1;30\n2;40\n3;50"]
)
def test_the_load_of_each_block_may_have_the_number_of_its_block(file, text):
    assert read_weights(file(text)) == [30.0, 40.0, 50.0]


@pytest.mark.parametrize("text", ["0;30\n1;40\n", "10;30\n20;40\n", "1;30;0\n2;40;0\n"])
def test_other_columns_are_never_read_as_more_blocks(file, text):
    with pytest.raises(ValueError, match="alone or after the number of its block"):
        read_weights(file(text))


def test_what_is_no_file_is_refused(tmp_path):
    with pytest.raises(ValueError, match="is not a file"):
        read_columns(tmp_path, TIME_AND_LOAD)
