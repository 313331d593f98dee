"""Methods are timed as they should be, and compared with what is proved."""

import math

import pandas as pd
import pytest
from benchmark.made_up import (
    CHAIN,
    DURATION,
    TRUE,
    made_up,
)

from maegawa2010.methods import METHODS, ROWS, Method, Result
from maegawa2010.studies.work_precision import tables
from maegawa2010.studies.work_precision.figure import fastest_as_accurate
from maegawa2010.studies.work_precision.tables import (
    SHORTEST,
    charted_values,
    measure_methods,
)
from precursors import Record, TransitionLimitError
from precursors.benchmark.compare import Truth
from precursors.proof import ExactChain, certify

FIVE = TRUE[:5]  # two slips, the second not over
# A call of a fake method takes so long, on a clock that the test moves [s]; one is
# repeated in a round.
CALL = 2.0**-8
SHORT_CALL = 2.0**-11


def test_the_full_chart_has_more_values_with_exact_solver_first():
    full, default = (charted_values(full) for full in (True, False))
    assert next(iter(full.items())) == next(iter(default.items())) == ("exact", (0.0,))
    for name in METHODS:
        assert len(default[name]) <= len(full[name])
        for values in (full[name], default[name]):
            assert list(values) == sorted(values, reverse=True)


class Fake:
    """A method that takes as long as its setting says, at first longer, and gives a
    run."""

    def __init__(self, clock) -> None:
        self.run = made_up(FIVE)
        self.clock = clock
        self.calls = []
        self.compiling = 0.0

    def solve(
        self, _chain, _duration: float, value: float, _until: str | None
    ) -> Result:
        self.clock.now += value if self.calls else value + self.compiling
        self.calls.append(value)
        if isinstance(self.run, Record):
            return Result(self.run, 7)
        raise self.run


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch, clock) -> Fake:
    fake = Fake(clock)
    method = Method("rk4", "time [s]", fake.solve)
    monkeypatch.setitem(METHODS, "rk4", method)
    return fake


def measured(*values: float, **limits: float) -> list[dict]:
    truth = Truth.exact(CHAIN, DURATION, FIVE)
    table = measure_methods(truth, DURATION, {"rk4": values}, 5, **limits)
    return table.to_dict("records")


def test_a_row_holds_time_work_and_errors(fake):
    fake.run = made_up(FIVE[:4])
    (row,) = measured(CALL)
    assert row.pop("time_error_s") == 0.0
    counts = [row.pop(f"transitions_{which}") for which in ("right", "found", "true")]
    assert counts == [4, 4, 5]
    shown = [ROWS["rk4"][name] for name in ("color", "marker")]
    about = ["rk4", ROWS["rk4"]["label"], *shown, "time [s]"]
    assert list(row.values()) == [*about, CALL, 7, CALL]


def test_a_method_stops_before_the_first_value_that_takes_long(fake):
    rows = measured(CALL, 10 * CALL, 11 * CALL, SHORT_CALL, longest=10 * CALL)
    assert [row["value"] for row in rows] == [CALL, 10 * CALL]
    assert fake.calls.count(11 * CALL) == 2  # one to warm up
    assert SHORT_CALL not in fake.calls


def test_long_calls_are_timed_once_and_short_ones_in_each_round(fake):
    rows = measured(CALL + SHORT_CALL, CALL, SHORT_CALL, long=CALL)
    assert [row["seconds"] for row in rows] == [CALL + SHORT_CALL, CALL, SHORT_CALL]
    repeated = 5 * round(SHORTEST / SHORT_CALL)
    # two calls to see how long one takes, and two before the rounds
    assert [fake.calls.count(row["value"]) for row in rows] == [2, 9, 4 + repeated]


def test_a_first_call_that_compiles_counts_for_nothing(fake):
    fake.compiling = 10.0
    (row,) = measured(SHORT_CALL, longest=2.0)
    assert row["seconds"] == SHORT_CALL


def test_a_run_that_breaks_off_is_a_row_with_what_there_is(fake):
    fake.run = TransitionLimitError("enough", made_up(FIVE[:3]))
    (row,) = measured(CALL)
    assert row["transitions_right"] == 3
    assert math.isnan(row["evaluations"])


def test_methods_are_measured_to_the_first_global_slip(monkeypatch):
    values = {"exact": [0.0], "leapfrog": [1e-6, 1e-7]}
    monkeypatch.setattr(tables, "charted_values", lambda _full: values)
    certificate = certify(ExactChain.from_slider(n_blocks=2, theta="1/4"), 6.0)
    table = tables.work_precision_table(certificate, "two", False)
    assert table["method"].tolist() == ["exact", "leapfrog", "leapfrog"]
    exact, coarse, fine = table.to_dict("records")
    assert exact["transitions_right"] == exact["transitions_true"]
    assert 0 < exact["transitions_true"] < len(certificate.transitions)
    assert 0 < exact["time_error_s"] < fine["time_error_s"] < coarse["time_error_s"]


# Method, time [s], error of a time [s], whether it found every transition.
SETTINGS = [
    ("exact", 1.0, 4e-16, True),
    ("heyoka", 11.0, 2e-14, True),
    ("heyoka", 12.0, 1e-15, True),
    ("heyoka", 13.0, 4e-15, True),
    ("heyoka", 2.0, 1e-16, False),
]


@pytest.mark.parametrize(
    ("more", "seconds"),
    [
        ([], 12.0),  # none is as accurate as the exact solver: the most accurate
        ([15.0], 15.0),
        ([16.0, 15.0, 17.0], 15.0),  # all three are: the fastest of them
    ],
)
def test_the_fastest_setting_as_accurate_as_exact_is_compared(more, seconds):
    # The slower, the more accurate.
    close = [("heyoka", time, 4e-16 - 1e-18 * time, True) for time in more]
    columns = ["method", "seconds", "time_error_s", "is_right"]
    table = pd.DataFrame([*SETTINGS, *close], columns=columns)
    right = table.pop("is_right").map({True: 216, False: 215})
    table = table.assign(
        transitions_right=right, transitions_found=216, transitions_true=216
    )
    assert fastest_as_accurate(table, "heyoka")["seconds"] == seconds
