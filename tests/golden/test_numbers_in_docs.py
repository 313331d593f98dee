"""Numbers in README, docs/ and captions are those of the tables, to their last digit."""

import math
import re
from collections.abc import Iterable
from fractions import Fraction

import pandas as pd
import pytest
from places import ROOT, made

from precursors import Chain, simulate, summarise
from precursors.benchmark.compare import compare
from precursors.benchmark.score import problems, solution
from precursors.proof import Certificate, ExactChain

SCENES = ["fig11", "fig10", "fig12"]
FIGURES = ["Fig. 11", "Fig. 10", "Fig. 12"]
THETAS = ["-5/6", "0", "+5/6"]  # of these scenes, as pages write them
EDGES = ["trailing edge", "neither edge", "leading edge"]  # with more normal load
CHAINS = ["trailing", "uniform", "leading"]
# Samples near a discontinuity, and exponents, differ between processors.
DRAWS = 1.5  # [%]
EXPONENT = 0.1  # [1/s]
NOISE = 2e-3

NUMBER = r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"


def table(name: str, *index: str) -> pd.DataFrame:
    rows = made(name)
    return rows.set_index(list(index)).sort_index() if index else rows


def numbers_in(page: str, sentence: str) -> list[str]:
    """The numbers at the places marked {} of a sentence in a page."""
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    match = re.search(re.escape(sentence).replace(r"\{\}", NUMBER), text)
    assert match, f"{page} does not say: {sentence}"
    return list(match.groups())


def assert_states(
    page: str, sentence: str, values: Iterable[float], beyond: float = 0.0
) -> None:
    """Each number of a sentence is right to half a unit of its last digit plus
    `beyond`."""
    for number, value in zip(numbers_in(page, sentence), values, strict=True):
        digits, _, exponent = number.partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
        right = pytest.approx(value, rel=0, abs=0.5005 * unit + beyond)
        assert float(number) == right, sentence


def assert_limits(page: str, limits: dict[str, float]) -> None:
    """No value exceeds the number in its sentence."""
    for sentence, value in limits.items():
        assert value <= float(*numbers_in(page, sentence)), sentence


def reproduced(quantity: str) -> list[float]:
    values = table("reproduction", "quantity", "scene")["reproduced"]
    return values[quantity][SCENES].tolist()


def medians(quantity: str, n_blocks: int) -> list[float]:
    """Medians over noise in the loads, for the three loadings."""
    values = table("resolution", "quantity", "n_blocks", "scene")["q50"]
    return values[quantity, n_blocks][SCENES].tolist()


def near_the_papers() -> pd.Series:
    """Shares of sliders with the same printed inputs that have the paper's mu_sapp [%]."""
    shares = 100 * table("digits", "quantity", "question", "scene")["share"]
    return shares["mu_sapp", "as_printed"][SCENES]


def with_the_count(counts: list[float]) -> list[float]:
    """Shares of the runs with noise that have these counts of events [%]."""
    runs = table("noise_members", "draw").loc[1:].groupby("scene")["events_counted"]
    of_scene = dict(zip(SCENES, counts, strict=True))
    return [100 * (runs.get_group(scene) == n).mean() for scene, n in of_scene.items()]


def worst_error(column: str) -> float:
    return table("solver_vs_proof", "chain")[column][CHAINS].max()


def test_readme_has_the_numbers_of_the_table_of_scenes():
    page = "README.md"
    counted = reproduced("events_counted")
    friction = reproduced("mu_sapp")
    onsets = reproduced("global_slip_s")
    rows = zip(FIGURES, EDGES, THETAS, counted, friction, onsets, strict=True)
    for figure, edge, theta, n, mu_sapp, onset in rows:
        row = f"| {figure} | {edge} | {theta} | {{}} | {{}} | 0.49 | {{}} | {{}} |"
        assert_states(page, row, [n, n, mu_sapp, onset])
    apart = max(abs(mu_sapp - 0.49) for mu_sapp in friction)
    assert_limits(page, {"lie within {} of its 0.49": apart})


def test_readme_has_the_findings_of_the_tables():
    page = "README.md"
    runs = table("balance_runs")
    means = pd.concat([runs, table("balance")]).query("mu_k == 0.45")
    lowest = means.min(numeric_only=True)
    highest = means.max(numeric_only=True)
    ends = [
        end[name]
        for name in ("mean", "n_blocks", "largest")
        for end in (lowest, highest)
    ]
    assert_states(
        page,
        "In all our runs with {} to {} blocks and a kinetic coefficient of {}, the mean "
        "push is {} to {} of the normal load, while the largest push is {} to {} of it",
        [*ends[2:4], highest["mu_k"], *ends[:2], *ends[4:]],
    )
    weak = runs.query("varied == 'mu_k' and mu_k == 0.1")
    above = 100 * (weak["mean"] / weak["mu_k"] - 1)
    assert_states(
        page,
        "With a kinetic coefficient of {}, blocks do slide backward, and the mean push is "
        "{} to {} % above the kinetic friction",
        [weak["mu_k"].iloc[0], above.min(), above.max()],
    )
    counted = reproduced("events_counted")
    assert_states(page, "with {}, {} and {} events. Right: the counts", counted)
    sentence = "{} and {} % of the runs keep the count at theta = -5/6 and 0, but only {} % keep"
    assert_states(page, sentence, with_the_count(counted), DRAWS)
    digits = table("digits", "question").loc["all_six"]
    sentence = "We drew {} sliders whose inputs round to the printed digits. None of"
    assert_states(page, sentence, [digits["n"]])
    assert digits["share"] == 0
    fine = medians("mu_sapp", 320)
    sentence = "runs with 320 blocks and noise, the medians of mu_sapp are {} to {}."
    assert_states(page, sentence, [min(fine), max(fine)])


def test_readme_has_the_largest_speed_of_eq_15():
    page = "README.md"
    checks = table("eq15", "case", "check")["computed"]["fig10"].astype(float)
    assert_states(page, "faster than about {} m/s", [checks["fast"]])


def test_docs_have_the_accuracy_and_the_medians_of_the_tables():
    page = "docs/numbers.md"
    assert_states(
        page,
        "In 10 s there are {}, {} and {} transitions",
        table("certificates", "chain")["transitions"][CHAINS],
    )
    to_slip = worst_error("time_error_to_global_slip_s")
    assert_limits(
        page,
        {
            "wrong by at most {} s up to the first global slip": to_slip,
            "and by at most {} s at 10 s": worst_error("time_error_while_agreeing_s"),
        },
    )
    assert_limits("docs/proof.md", {"times within {} s up": to_slip})
    lyapunov = table("lyapunov", "scene").loc[SCENES]
    exponents = lyapunov["exponent_per_s"]
    assert_states(page, "exponents are {}, {} and {} per second", exponents, EXPONENT)
    widest = [lyapunov["uncertainty_per_s"].max()]
    assert_states(page, "at most +-{}. Small", widest, EXPONENT)
    tenfold = [math.log(10) / exponents.max(), math.log(10) / exponents.min()]
    assert_states(page, "tenfold in {} to {} s", tenfold, EXPONENT)
    verdicts = table("resolution_differences").query("quantity == 'mu_sapp'")
    differ = verdicts.query("verdict != 'same'")["n_blocks"].max()
    fine = table("resolution").query("quantity == 'mu_sapp' and n_blocks == 320")
    assert_states(
        page,
        "are {} to {}, and nine tenths of the runs lie between {} and {}.",
        [fine["q50"].min(), fine["q50"].max(), fine["q05"].min(), fine["q95"].max()],
    )
    heavy = table("balance_loads", "load", "n_blocks").loc["heavy last", 320]
    assert_states(page, "on the last of 320 blocks, the median is {}.", [heavy["q50"]])
    agree = verdicts["n_blocks"][verdicts["n_blocks"] > differ].min()
    assert_states(page, "From {} blocks on", [agree])
    events = [medians("events_counted", n_blocks) for n_blocks in (10, 320)]
    sentence = "is {} % higher than at theta = 0. With 320 blocks it is {} % higher"
    assert_states(page, sentence, [100 * (far / even - 1) for _, even, far in events])
    noise = table("noise", "quantity", "scene")["q50"]["mu_sapp"][SCENES]
    sentence = "medians of mu_sapp of {}, {} and {} (1000 runs each)"
    assert_states(page, sentence, noise, NOISE)
    larger = table("noise_differences").query("quantity=='mu_sapp' and scene=='fig12'")
    ends = [larger["low"].min(), larger["high"].max()]
    assert_states(page, "exceeds the other two by {} to {} (", ends, NOISE)


def test_docs_have_the_numbers_of_other_digits():
    page = "docs/numbers.md"
    thetas = ["0.833", "5/6", "0.8333343"]
    runs = [simulate(Chain.from_slider(theta=theta)) for theta in thetas]
    rows = summarise(runs)[["events_counted", "mu_sapp", "global_slip_end_s"]]
    for theta, numbers in zip(thetas, rows.to_numpy(), strict=True):
        assert_states(page, f"| {theta} | {{}} | {{}} | {{}} |", numbers)
    digits = table("digits", "question").assign(n=table("digits")["n"].max())
    share = 100 * digits[["share", "low", "high"]]
    assert_states(page, "We drew {} sliders", digits["n"][:1])
    sentence = "{}, {} and {} % of the sliders have a mu_sapp within"
    assert_states(page, sentence, near_the_papers(), DRAWS)
    sentence = "In {} % of the sliders (95 % interval: {} to {} %), the three values"
    assert_states(page, sentence, share.loc["same_mu_sapp"], DRAWS)
    sentence = "all six numbers of the paper (95 % interval: {} to {} %)"
    assert_states(page, sentence, share.loc["all_six", ["low", "high"]], DRAWS)
    caption = "workflow/studies/printed_digits/caption.rst"
    assert_states(caption, "of {} sliders", digits["n"][:1])


def test_the_caption_of_the_wave_names_where_precursors_stop():
    first = table("fig10_slips").query("is_global").index[0]
    precursors = table("fig10_slips")["front"][:first]
    sentence = "The precursors stop after blocks 4 and {}."
    assert_states("workflow/report/wave.rst", sentence, [precursors.max()])
    assert_states("README.md", "after block 4 and block {};", [precursors.max()])


def test_docs_have_the_published_times():
    page = "docs/performance.md"
    heyoka = table("beside_heyoka").query("measurement == 'heyoka'")
    of = heyoka.set_index(["quantity", "case"])
    ratios = of.loc["processor time of heyoka / exact"]
    error, errors = (
        of["value"][f"largest error of their times, {solver}"]
        for solver in ("exact", "heyoka")
    )
    every = table("speed", "method", "value")
    seconds = []
    for method, value, shown in (
        ("exact", 0.0, "exact | none"),
        ("heyoka", 1e-14, "heyoka.py | 1e-14"),
        ("rk4_located", 3e-8, "RK4 | 3e-8 s"),
        ("scipy_dop853", 1e-11, "SciPy DOP853 | 1e-11"),
    ):
        one = every.loc[method, value]
        seconds.append(one["seconds"])
        each = 1e6 * one["seconds"] / one["evaluations"]
        assert_states(page, f"| {shown} | {{}} | {{}} |", [one["evaluations"], each])
    ends = [
        min(ratios["least"].min(), seconds[1] / seconds[0]),
        ratios["largest"].max(),
    ]
    assert_states(page, "It takes {} to {} times as long as exact", ends)
    larger = errors / error
    assert_states(page, "is {} to {} times that of exact", [larger.min(), larger.max()])


PROBLEMS = "docs/benchmark.md"


def test_the_page_states_the_problems_that_are_proved():
    text = (ROOT / PROBLEMS).read_text(encoding="utf-8")
    rows = text[text.index("| problem | N |") :].split("\n\n")[0].splitlines()[2:]
    stated = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    assert {name for name, *_ in stated} == set(problems())
    for row in stated:
        name, n, theta, mu_k, drive, speed, duration, *_ = row
        proved = Certificate.load(problems()[name])
        chain = ExactChain.from_slider(
            int(n), theta=theta, mu_k=mu_k, drive_stiffness=drive, drive_velocity=speed
        )
        assert chain == proved.chain
        assert Fraction(duration) == proved.duration
        sentence = f"| {' | '.join(row[:-1])} | {{}} |"
        assert_states(PROBLEMS, sentence, [len(proved.transitions)])


def test_the_page_of_problems_shows_the_start_of_a_solution():
    transitions = solution("uniform").run.transitions
    assert (transitions["mode"] >= 0).all()  # the simplest problem
    for transition in transitions[:3].tolist():
        row = ",".join(map(repr, transition))
        assert f"    {row}\n" in (ROOT / PROBLEMS).read_text(encoding="utf-8")


def test_the_page_of_problems_has_the_published_methods():
    truth = solution("fast_drive")
    compared = compare(simulate(truth.run.chain, truth.run.duration), truth)
    (right_until,) = numbers_in(PROBLEMS, "is right up to {} s.")
    assert compared.first_difference >= float(right_until)
    every = table("speed")
    assert_states(PROBLEMS, "right, of {} |", every["transitions_true"][:1])
    for _, settings in every.groupby("method"):
        best = settings.loc[settings["time_error_s"].idxmin()]
        value = [best["value"]] if best["value"] else []
        setting = "{}" if value else "none"
        row = f"| {best['label']} | {setting} | {{}} | {{}} | {{}} |"
        right, error = best[["transitions_right", "time_error_s"]]
        assert_states(PROBLEMS, row, [*value, right, error, 1e3 * best["seconds"]])
