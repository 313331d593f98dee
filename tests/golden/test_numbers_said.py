"""The results that README, docs/ and captions tell are those of the tables, to the last
digit told."""

import math
import re
from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise

import pandas as pd
import pytest
from places import ROOT, made

from precursors import Chain, simulate, summarise
from precursors.benchmark.compare import compare
from precursors.benchmark.score import problems, solution
from precursors.proof import Certificate, ExactChain

SCENES = ["fig11", "fig10", "fig12"]
THETAS = ["-5/6", "0", "+5/6"]  # of these scenes, as pages write them
CHAINS = ["trailing", "uniform", "leading"]
# Draws near a jump fall on other sides on other processors, exponents differ.
DRAWS = 1.5  # [%]
EXPONENT = 0.1  # [1/s]
NOISE = 2e-3

NUMBER = r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"


def table(name: str, *index: str) -> pd.DataFrame:
    found = made(name)
    return found.set_index(list(index)).sort_index() if index else found


def told(page: str, sentence: str) -> list[str]:
    """The numbers of a page that stand where a sentence has {}."""
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    found = re.search(re.escape(sentence).replace(r"\{\}", NUMBER), text)
    assert found, f"{page} does not say: {sentence}"
    return list(found.groups())


def assert_told(
    page: str, sentence: str, values: Iterable[float], beyond: float = 0.0
) -> None:
    """Each number is right to half a unit of its last digit, and what is allowed
    beyond."""
    for number, value in zip(told(page, sentence), values, strict=True):
        digits, _, exponent = number.partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
        right = pytest.approx(value, rel=0, abs=0.5005 * unit + beyond)
        assert float(number) == right, sentence


def assert_limits(page: str, limits: dict[str, float]) -> None:
    """No value is above the number that is told for it."""
    for sentence, value in limits.items():
        assert value <= float(*told(page, sentence)), sentence


def reproduced(quantity: str) -> list[float]:
    found = table("reproduction", "quantity", "scene")["reproduced"]
    return found[quantity][SCENES].tolist()


def medians(quantity: str, n_blocks: int) -> list[float]:
    """With noise in the loads, at the three loadings."""
    found = table("resolution", "quantity", "n_blocks", "scene")["q50"]
    return found[quantity, n_blocks][SCENES].tolist()


def near_the_papers() -> pd.Series:
    """Shares of the sliders with the same printed inputs [%]."""
    found = 100 * table("digits", "quantity", "question", "scene")["share"]
    return found["mu_sapp", "as_printed"][SCENES]


def with_the_count(counts: list[float]) -> list[float]:
    """Shares of the runs with noise that have so many events [%]."""
    found = table("noise_members", "draw").loc[1:].groupby("scene")["events_counted"]
    of_scene = dict(zip(SCENES, counts, strict=True))
    return [100 * (found.get_group(scene) == n).mean() for scene, n in of_scene.items()]


def worst_error(column: str) -> float:
    return table("solver_vs_proof", "chain")[column][CHAINS].max()


def test_readme_tells_the_numbers_of_the_tables():
    page = "README.md"
    counted = reproduced("events_counted")
    friction = reproduced("mu_sapp")
    sliders = table("digits")["n"].max()
    means = table("balance_runs").query("varied != 'mu_k'")
    lowest = means.min(numeric_only=True)
    highest = means.max(numeric_only=True)
    ends = [end[name] for name in ("mean", "largest") for end in (lowest, highest)]
    assert_told(
        page,
        "In {} runs with {} to {} blocks it is {} to {} of F_Z, while the largest loads "
        "lie between {} and {} of it",
        [len(means), lowest["n_blocks"], highest["n_blocks"], *ends],
    )
    assert_told(
        page,
        "{}, {} and {} events, and coefficients of {}, {} and {}",
        counted + friction,
    )
    leading = [counted[2], friction[2]]
    assert_told(page, "{} events counted in Fig. 13; mu_sapp = {}", leading)
    assert_told(page, "Of {} sliders whose inputs", [sliders])
    fine = medians("mu_sapp", 320)
    sentence = "With 320 blocks every loading gives the kinetic coefficient, {} to {}:"
    assert_told(page, sentence, [min(fine), max(fine)])
    assert_told(page, "with {}, {} and {} events. Right: noise", counted)
    sentence = "keeps these counts in {}, {} and {} % of runs; of {} sliders"
    assert_told(page, sentence, [*with_the_count(counted), sliders], DRAWS)
    onsets = reproduced("global_slip_s")
    rows = zip(SCENES, THETAS, counted, friction, onsets, strict=True)
    for scene, theta, n, mu_sapp, onset in rows:
        row = f"| {scene} | {theta} | {{}} | {{}} | 0.49 | {{}} | {{}} |"
        assert_told(page, row, [n, n, mu_sapp, onset])


def test_docs_tell_how_far_the_numbers_can_be_trusted():
    page = "docs/numbers.md"
    assert_told(
        page,
        "All {}, {} and {} transitions",
        table("certificates", "chain")["transitions"][CHAINS],
    )
    to_slip = worst_error("time_error_to_global_slip_s")
    assert_limits(
        page,
        {
            "times within {} s up to the first global slip": to_slip,
            "and {} s at 10 s": worst_error("time_error_while_agreeing_s"),
            "with 320 blocks it is within {} of it": max(medians("mu_sapp", 320))
            - 0.45,
        },
    )
    assert_limits("docs/proof.md", {"times within {} s up": to_slip})
    lyapunov = table("lyapunov", "scene").loc[SCENES]
    exponents = lyapunov["exponent_per_s"]
    assert_told(page, "exponents are {}, {} and {} per second", exponents, EXPONENT)
    widest = [lyapunov["uncertainty_per_s"].max()]
    assert_told(page, "at most +-{}:", widest, EXPONENT)
    tenfold = [math.log(10) / exponents.max(), math.log(10) / exponents.min()]
    assert_told(page, "tenfold in {} to {} s", tenfold, EXPONENT)
    verdicts = table("resolution_differences").query("quantity == 'mu_sapp'")
    differ = verdicts.query("verdict != 'same'")["n_blocks"].max()
    agree = verdicts["n_blocks"][verdicts["n_blocks"] > differ].min()
    assert_told(page, "from {} blocks on", [agree])
    events = [medians("events_counted", n_blocks) for n_blocks in (10, 320)]
    sentence = "{} % more than at theta = 0 with ten blocks, and {} % more with 320"
    assert_told(page, sentence, [100 * (far / even - 1) for _, even, far in events])
    noise = table("noise", "quantity", "scene")["q50"]["mu_sapp"][SCENES]
    sentence = "the median of mu_sapp is {}, {} and {} (1000 runs each)"
    assert_told(page, sentence, noise, NOISE)
    larger = table("noise_differences").query("quantity=='mu_sapp' and scene=='fig12'")
    ends = [larger["low"].min(), larger["high"].max()]
    assert_told(page, "is larger by {} to {}.", ends, NOISE)


def test_docs_tell_how_fragile_the_numbers_are():
    page = "docs/numbers.md"
    thetas = ["0.833", "5/6", "0.8333343", "-5/6"]
    runs = [simulate(Chain.from_slider(theta=theta)) for theta in thetas]
    found = summarise(runs)[["events_counted", "mu_sapp", "global_slip_end_s"]]
    for theta, numbers in zip(thetas, found.to_numpy(), strict=True):
        assert_told(page, f"| {theta} | {{}} | {{}} | {{}} |", numbers)
    fragile = found["mu_sapp"][1:3]
    assert_told(page, "by 1e-6 changes mu_sapp from {} to {}", fragile)
    digits = table("digits", "question").assign(n=table("digits")["n"].max())
    share = 100 * digits[["share", "low", "high"]]
    assert_told(page, "We drew {} sliders", digits["n"][:1])
    sentence = "Of these, {}, {} and {} % have mu_sapp"
    assert_told(page, sentence, near_the_papers(), DRAWS)
    sentence = "In {} % (95 % interval: {} to {} %) the three"
    assert_told(page, sentence, share.loc["same_mu_sapp"], DRAWS)
    sentence = "In none (below {} %) all six"
    assert_told(page, sentence, [share["high"]["all_six"]], DRAWS)
    caption = "workflow/studies/printed_digits/caption.rst"
    assert_told(caption, "of {} sliders", digits["n"][:1])


def test_the_caption_of_the_wave_tells_where_precursors_stop():
    first = table("fig10_slips").query("is_global").index[0]
    precursors = table("fig10_slips")["front"][:first]
    sentence = "The precursors stop after blocks 4 and {}."
    assert_told("workflow/report/wave.rst", sentence, [precursors.max()])
    assert_told("README.md", "after block 4 and block {};", [precursors.max()])


def test_docs_tell_the_published_times():
    page = "docs/performance.md"
    heyoka = table("beside_heyoka", "case", "quantity", "measurement").xs(
        "heyoka", level=2
    )
    for theta in THETAS:
        for run in ("to the first global slip", "10 s"):
            of = heyoka.loc[f"theta = {theta.removeprefix('+')}, {run}"]
            ratio = of.loc["processor time of heyoka / exact"]
            errors = [
                of["value"][f"largest error of their times, {solver}"]
                for solver in ("exact", "heyoka")
            ]
            row = f"| {theta} | {run.removeprefix('to the ')} | {{}} ({{}} to {{}}) | {{}} s | {{}} s |"
            ratios = ratio[["value", "least", "largest"]]
            assert_told(page, row, [*ratios, *errors])
    every = table("speed", "method", "value")
    seconds = []
    for method, value, shown in (
        ("exact", 0.0, "exact"),
        ("heyoka", 1e-14, "heyoka.py, 1e-14"),
        ("rk4_located", 3e-8, "RK4, compiled, 30 ns"),
        ("scipy_dop853", 1e-11, "DOP853, SciPy, 1e-11"),
    ):
        one = every.loc[method, value]
        seconds.append(one["seconds"])
        each = 1e6 * one["seconds"] / one["evaluations"]
        numbers = [one["evaluations"], 1e3 * one["seconds"], each, one["time_error_s"]]
        row = f"| {shown} | {{}} | {{}} ms | {{}} us | {{}} s |"
        assert_told(page, row, numbers)
    assert_told(
        page,
        "heyoka, at its most accurate setting, takes {} times",
        [seconds[1] / seconds[0]],
    )


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
        times = [transition.time.midpoint for transition in proved.transitions]
        closest = 1e9 * float(min(b - a for a, b in pairwise(times)))
        sentence = f"| {' | '.join(row[:-2])} | {{}} | {{}} |"
        assert_told(PROBLEMS, sentence, [len(times), closest])


def test_the_page_of_problems_begins_the_file_of_one_as_it_is_proved():
    transitions = solution("uniform").run.transitions
    assert (transitions["mode"] >= 0).all()  # the plainest
    for transition in transitions[:3].tolist():
        row = ",".join(map(repr, transition))
        assert f"    {row}\n" in (ROOT / PROBLEMS).read_text(encoding="utf-8")


def test_the_page_of_problems_tells_where_methods_stand():
    truth = solution("fast_drive")
    compared = compare(simulate(truth.run.chain, truth.run.duration), truth)
    (right_until,) = told(PROBLEMS, "in the right order up to {} s only")
    assert compared.first_difference >= float(right_until)
    every = table("speed")
    assert_told(PROBLEMS, "right, of {} |", every["transitions_true"][:1])
    for _, settings in every.groupby("method"):
        best = settings.loc[settings["time_error_s"].idxmin()]
        value = [best["value"]] if best["value"] else []
        setting = "{}" if value else "none"
        row = f"| {best['label']} | {setting} | {{}} | {{}} s | {{}} ms |"
        right, error = best[["transitions_right", "time_error_s"]]
        assert_told(PROBLEMS, row, [*value, right, error, 1e3 * best["seconds"]])
