"""All that the explorer says, draws and reads is what is kept here, whatever the reader does."""

import json

import pandas as pd
import pytest
from figures.explorer_sessions import KEPT, SESSIONS, SOURCE, assert_same_page, record

READ = "(new Function('postMessage', 'onmessage', %s + '; return readMeasurement;')()(%s))"


@pytest.mark.parametrize(
    ("lines", "points"),
    [
        ("0 1\n0.5 2.5\n", [[0, 0.5], [1, 2.5]]),
        ("t,F\n0,1\n0.5,2.5", [[0, 0.5], [1, 2.5]]),
        ("time, load\n0.0, 1\n0.5, 2.5", [[0, 0.5], [1, 2.5]]),
        ("Zeit [s];Kraft [N]\r\n0,0;1,0\r\n0,5;2,5\r\n", [[0, 0.5], [1, 2.5]]),
        ('\ufeff"t"\t"F"\n0\t1\n5e-1\t2,5\n', [[0, 0.5], [1, 2.5]]),
        ("# rig 3\n\n0,0 1\n0,5 2,5", [[0, 0.5], [1, 2.5]]),
        ("0;1\n0,5;abc", "Line 2: “abc” is not a number."),
        ("t;F\n0;1\n0.5", "Line 3: there must be two numbers, time [s] and load [N]."),
        ("0 1\n2 1\n1 1", "Line 3: the time goes back to 1 s."),
        ("no\nnumbers", "No line of the file has two numbers, time [s] and load [N]."),
    ],
)
def test_a_measurement_is_read_or_the_wrong_line_is_named(opened, lines, points):
    source = "".join((SOURCE / f"{name}.js").read_text("utf-8") for name in ("solver", "worker"))
    found = opened.evaluate(READ % (json.dumps(source), json.dumps(lines)))
    assert found == (
        {"problem": points} if isinstance(points, str) else dict(zip(("time", "load"), points, strict=True))
    )


@pytest.mark.parametrize("session", SESSIONS)
def test_the_page_says_and_draws_what_is_kept(opened, file, session):
    kept = pd.read_csv(KEPT, keep_default_na=False)
    assert_same_page(record(opened, file.as_uri(), session), kept[kept["session"] == session])
    assert opened.complaints == []
