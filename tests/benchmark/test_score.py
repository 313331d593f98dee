"""Result files are scored against the proved lists; wrong ones are refused in one line."""

import re
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

from precursors.analysis.slips import find_slips
from precursors.benchmark.score import problems, score, solution

HEADER = "time_s,block,mode,tangential_load_N"
# Largest rounding errors of doubles below 16 s and 512 N.
ROUNDING_S = 2.0**-50
ROUNDING_N = 2.0**-45


@cache
def true_rows(problem: str = "uniform") -> tuple[str, ...]:
    """Return the rows of a result file with the proved list, rounded to doubles."""
    rows = solution(problem).run.transitions.tolist()
    return tuple(",".join(map(repr, row)) for row in rows)


@pytest.fixture
def scored(tmp_path: Path):
    """Write the lines of a result file and score it."""

    def of(*lines: str, problem: str = "uniform", ties: float = 0.0):
        path = tmp_path / "mine.csv"
        path.write_text("\n".join(lines), encoding="utf-8")
        return score(path, problem, ties)

    return of


@pytest.mark.parametrize("problem", problems())
def test_proved_list_scores_right_to_rounding(scored, problem):
    rows = true_rows(problem)
    result = scored(HEADER, *rows, problem=problem)
    assert result["transitions_right"] == result["transitions_true"] == len(rows)
    assert result["first_wrong"] == result["should_be"] == "none"
    assert result["time_error_s"] <= ROUNDING_S
    assert result["load_error_N"] <= ROUNDING_N
    assert result["mu_sapp"] == result["mu_sapp_true"]
    assert result["events_counted"] == result["events_counted_true"]


def test_score_ends_with_the_first_wrong_transition(scored):
    rows = [*true_rows()]
    rows[700] = rows[700].replace(",1,", ",3,", 1).replace(",0,", ",-1,")
    time, block, mode, _ = true_rows()[700].split(",")
    result = scored(HEADER, *rows)
    assert result["transitions_right"] == 700
    truth = f"block {block} to mode {mode} at {float(time):.12g} s"
    assert result["should_be"] == truth != result["first_wrong"]


def test_errors_stop_at_the_first_wrong_transition(scored):
    rows = [row.split(",") for row in true_rows()]
    end = solution("uniform").until_global_slip().run.duration
    later = next(k for k, row in enumerate(rows) if float(row[0]) > end)
    onset = find_slips(solution("uniform").run)["onset"]
    for k, shift in ((3, 2.0**-30), (later + 5, 2.0**-20)):
        rows[k][0] = repr(float(rows[k][0]) + shift)
    for row in rows:
        if float(row[0]) == onset[2]:
            row[3] = repr(float(row[3]) + 0.5)
    rows[later + 50][2] = "-1"
    rows[later + 60][0] = repr(float(rows[later + 60][0]) + 1e-9)
    result = scored(HEADER, *[",".join(row) for row in rows])
    assert result["transitions_right"] == later + 50
    assert result["time_error_s"] == pytest.approx(2.0**-20, abs=ROUNDING_S)
    assert result["time_error_to_global_slip_s"] == pytest.approx(
        2.0**-30, abs=ROUNDING_S
    )
    assert result["load_error_to_global_slip_N"] == pytest.approx(0.5, abs=ROUNDING_N)


def test_ties_may_be_in_any_order_only_within_the_tolerance(scored):
    rows = [*true_rows("trailing")]
    times = [float(row.split(",")[0]) for row in rows]
    gaps = [b - a for a, b in pairwise(times)]
    k = gaps.index(min(gaps))  # the closest two: 0.47 ns
    middle = repr(times[k])
    swapped = [row.split(",", 1)[1] for row in (rows[k + 1], rows[k])]
    rows[k : k + 2] = [f"{middle},{row}" for row in swapped]
    ask = {"problem": "trailing"}
    assert scored(HEADER, *rows, **ask)["transitions_right"] == len(rows)
    rows[k + 1] = f"{times[k + 1]!r},{swapped[1]}"
    assert scored(HEADER, *rows, **ask)["transitions_right"] == k
    assert scored(HEADER, *rows, **ask, ties=1e-10)["transitions_right"] == k
    assert scored(HEADER, *rows, **ask, ties=1e-9)["transitions_right"] == len(rows)


def test_two_transitions_of_one_block_are_not_a_tie(scored):
    rows = true_rows()[:2]  # block 1 begins to slide, and stops
    turned = [rows[0].replace(",1,1,", ",1,-1,"), rows[1]]
    assert scored(HEADER, *turned, ties=1.0)["transitions_right"] == 0


def test_result_files_are_read_in_each_format(scored):
    rows = true_rows()[:60]
    plain = scored(HEADER, *rows)
    assert plain["transitions_right"] == 60
    assert plain["first_wrong"] == "none"
    columns = [row.split(",") for row in rows]
    zero = [f"{t},{int(b) - 1},{m},{load}" for t, b, m, load in columns]
    others = {
        "blocks from 0": (HEADER.replace("block", "block_from_0"), *zero),
        "decimal commas": [
            row.replace(",", ";").replace(".", ",") for row in (HEADER, *rows)
        ],
        "tabs": [*(row.replace(",", "\t") for row in (HEADER, *rows)), "\t\t\t"],
        "another order": (
            'mode, time_s, "remark", tangential_load_N, block',
            *[f"{m}, {t}, mine, {load}, {b}" for t, b, m, load in columns],
        ),
        "comments, empty lines, byte order mark": (
            f"\ufeff# mine; all of it\n{HEADER}",
            *[f"{row}\n\n#" for row in rows],
        ),
    }
    for lines in others.values():
        assert str(scored(*lines)) == str(plain)


def test_rows_after_the_duration_are_ignored(scored):
    result = scored(HEADER, *true_rows(), "10.5,1,1,200")
    assert result["first_wrong"] == "none"
    assert result["ends_s"] == 10.5


@pytest.mark.parametrize(
    ("column", "factor"), [(0, 1e3), (0, 1e-6), (0, 1 / 60), (3, 1e-3)]
)
def test_times_or_loads_in_other_units_are_refused(scored, column, factor):
    rows = [row.split(",") for row in true_rows()[:9]]
    for row in rows:
        row[column] = repr(float(row[column]) * factor)
    with pytest.raises(ValueError, match="times what it must be"):
        scored(HEADER, *map(",".join, rows))


def test_score_reports_where_a_short_list_ends(scored):
    assert scored(HEADER, *true_rows()[:90])["ends_s"] == float(
        true_rows()[89].split(",")[0]
    )
    with pytest.raises(ValueError, match="ties must be between 0 and"):
        scored(HEADER, *true_rows()[:90], ties=-1.0)


ROW = "0.35,1,1,28"
WRONG = {
    "no rows": ([HEADER], "mine.csv: there is no transition below the header"),
    "no modes": (
        ["time_s,block,tangential_load_N"],
        "mode must occur once in the header, not 0 times",
    ),
    "a short row": (
        [HEADER, ROW, "0.4,1,0"],
        "line 3: it must have 4 cells",
    ),
    "no number": (
        [HEADER, "# t", "soon,1,1,28"],
        "line 3: time_s must be a finite number, but is",
    ),
    "block 0": ([HEADER, "0.35,0,1,28"], "line 2: block must be 1 to 10"),
    "mode 2": ([HEADER, "0.35,1,2,28"], "line 2: mode must be -1, 0 or 1, but is 2"),
    "mode twice": ([HEADER, ROW, ROW], "line 3: block 1 is in mode 1 already"),
    "back in time": (
        [HEADER, ROW, "0.34,1,0,27"],
        "line 3: time_s must not fall",
    ),
}


@pytest.mark.parametrize(("lines", "message"), WRONG.values(), ids=WRONG)
def test_malformed_result_file_is_refused_in_one_line(scored, lines, message):
    with pytest.raises(ValueError, match=re.escape(message)) as caught:
        scored(*lines)
    assert "\n" not in str(caught.value)


def test_unknown_problem_is_refused_with_the_list_of_problems(scored):
    with pytest.raises(ValueError, match=r"unifrom: the problems are .*, uniform"):
        scored(HEADER, problem="unifrom")
