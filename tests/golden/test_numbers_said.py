"""Every number that a reader meets in a page is one of a table, to its last digit; what
is left are inputs, definitions and names."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
import pytest

from precursors import (
    Chain,
    apparent_friction,
    find_precursors,
    find_slips,
    simulate,
)

ROOT = Path(__file__).parents[2]
SCENES = ("fig11", "fig10", "fig12")
CHAINS = ("trailing", "uniform", "leading")
# Draws near a jump fall on other sides on other processors, exponents differ.
DRAWS = 1.5  # [%]
EXPONENT = 0.1  # [1/s]
NOISE = 2e-3

NUMBER = r"[-+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?"
# Lists, sections, loadings, time of the runs and confidence of the intervals.
NAMES = re.compile(
    r"^ *\d\. |(?:Figs?|Eqs?)\. [\d-]+|theta = 0\b|[-+]?5/6|theta = -5/6, 0, \+5/6"
    r"|(?<!-)\b10 s\b|95 % interval|\b[A-Za-z_]+-?\d\w*",
    flags=re.MULTILINE,
)
CODE = re.compile(
    r"^\[paper\].*$|^```.*?^```|^ {4}\S.*?$|`[^`]*`|\]\([^)]*\)|<img src=\S+ width=\S+",
    flags=re.MULTILINE | re.DOTALL,
)


def table(name: str, *index: str) -> pd.DataFrame:
    folder = (
        "paper/tables"
        if name.endswith(("_full", "heyoka", "mean_load"))
        else "results/tables"
    )
    found = pd.read_csv(ROOT / folder / f"{name}.csv")
    return found.set_index(list(index)) if index else found


def reproduced(quantity: str) -> list[float]:
    found = table("reproduction", "scene", "quantity")["reproduced"]
    return [found[scene, quantity] for scene in SCENES]


def medians(quantity: str, n_blocks: int) -> list[float]:
    """With noise in the loads, at the three loadings."""
    found = table("resolution_full", "scene", "n_blocks", "quantity")["q50"]
    return [found[scene, n_blocks, quantity] for scene in SCENES]


def share(scene: str, quantity: str, question: str) -> list[float]:
    """Of the sliders with the same printed inputs, and its interval [%]."""
    found = table("digits", "scene", "quantity", "question")
    return (
        100 * found.loc[(scene, quantity, question), ["share", "low", "high"]]
    ).tolist()


def near_the_papers() -> list[float]:
    return [share(scene, "mu_sapp", "as_printed")[0] for scene in SCENES]


def sliders_drawn() -> float:
    return table("digits")["n"].max()


def noise_medians() -> list[float]:
    found = table("noise", "scene", "quantity")["q50"]
    return [found[scene, "mu_sapp"] for scene in SCENES]


def excess_with_noise() -> list[float]:
    """Of mu_sapp at +5/6 over the other loadings, with its intervals."""
    found = table("noise_differences").query("quantity == 'mu_sapp'")
    of_far = found[found["scene"] == "fig12"]
    return [of_far["low"].min(), of_far["high"].max()]


def finest_that_differ() -> float:
    """The least number of blocks from which all three loadings agree."""
    verdicts = table("resolution_differences").query("quantity == 'mu_sapp'")
    differ = verdicts[verdicts["verdict"] != "same"]["n_blocks"]
    return verdicts[verdicts["n_blocks"] > differ.max()]["n_blocks"].min()


def more_counted(n_blocks: int) -> float:
    """At +5/6 than at theta = 0 [%]."""
    _, uniform, leading = medians("events_counted", n_blocks)
    return 100 * (leading / uniform - 1)


def exponents() -> list[float]:
    return table("lyapunov", "scene")["exponent_per_s"][list(SCENES)].tolist()


def tenfold() -> list[float]:
    """Least and longest time in which an error grows tenfold [s]."""
    return [math.log(10) / max(exponents()), math.log(10) / min(exponents())]


def proved(column: str) -> list[float]:
    return table("certificates", "chain")[column][list(CHAINS)].tolist()


def worst(column: str) -> float:
    return table("solver_vs_proof", "chain")[column][list(CHAINS)].max()


def beside_heyoka(theta: str, run: str) -> list[float]:
    found = table("beside_heyoka", "benchmark", "case", "quantity").loc["heyoka"]
    case = f"theta = {theta}, {run}"
    ratio = found.loc[(case, "processor time of heyoka / exact")]
    errors = [
        found.loc[(case, f"largest error of their times, {solver}"), "value"]
        for solver in ("exact", "heyoka")
    ]
    return [ratio["value"], ratio["least"], ratio["largest"], *errors]


def one_method(method: str, value: float) -> list[float]:
    """Evaluations, time [ms], time of an evaluation [us], error [s]."""
    rows = table("work_precision_full").query("method == @method")
    row = rows.loc[(rows["value"] - value).abs().idxmin()]
    each = row["seconds"] / row["evaluations"]
    return [row["evaluations"], 1e3 * row["seconds"], 1e6 * each, row["time_error_s"]]


def published_factor() -> list[float]:
    _, exact, _, _ = one_method("exact", 0.0)
    _, heyoka, _, _ = one_method("heyoka", 2.2e-16)
    return [heyoka / exact]


def run_of(theta: str) -> list[float]:
    """Events counted, mu_sapp and the end of the first global slip [s]."""
    run = simulate(Chain.from_slider(theta=theta), until="global slip")
    counted = find_precursors(find_slips(run))
    return [len(counted), apparent_friction(run), run.duration]


@dataclass(frozen=True)
class Said:
    """A sentence with {} for each number, and the numbers; `beyond` is allowed beside
    half a unit of the last digit; a limit is only at least as large."""

    sentence: str
    values: Sequence[float]
    beyond: float = 0.0
    is_limit: bool = False

    def check(self, text: str) -> str:
        """The text without the sentence."""
        pattern = re.escape(plain(self.sentence)).replace(r"\{\}", f"({NUMBER})")
        found = re.search(pattern, text)
        assert found, self.sentence
        for said, value in zip(found.groups(), self.values, strict=True):
            if self.is_limit:
                assert value <= float(said), self.sentence
            else:
                off = abs(float(said) - value)
                assert off <= 1.001 * half_a_unit(said) + self.beyond, (said, value)
        return text[: found.start()] + text[found.end() :]


def plain(text: str) -> str:
    """Without code and names, on one line."""
    return " ".join(NAMES.sub("", CODE.sub("", text)).split())


def half_a_unit(said: str) -> float:
    """Half a unit of the last digit."""
    digits, _, exponent = said.partition("e")
    return 0.5 * 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))


def readme() -> list[Said]:
    counted, friction = reproduced("events_counted"), reproduced("mu_sapp")
    fine = medians("mu_sapp", 320)
    onsets = reproduced("global_slip_s")
    scenes = [
        Said(f"| {scene} | {theta} | {{}} | {{}} | 0.49 | {{}} | {{}} |", row)
        for scene, theta, *row in zip(
            SCENES,
            ("-5/6", "0", "+5/6"),
            counted,
            counted,
            friction,
            onsets,
            strict=True,
        )
    ]
    means = table("mean_load")
    return [
        Said(
            "In {} runs with {} to {} blocks it is {} to {} of F_Z, while the largest loads "
            "lie between {} and {} of it",
            [
                len(means),
                means["n_blocks"].min(),
                means["n_blocks"].max(),
                means["mean"].min(),
                means["mean"].max(),
                means["largest"].min(),
                means["largest"].max(),
            ],
        ),
        Said(
            "{}, {} and {} events, and coefficients of {}, {} and {}",
            counted + friction,
        ),
        Said("Of {} sliders whose inputs", [sliders_drawn()]),
        Said(
            "With 320 blocks every loading gives the kinetic coefficient, {} to {}:",
            [min(fine), max(fine)],
        ),
        Said(
            "with {}, {} and {} events. Right: mu_sapp of {} sliders",
            [*counted, sliders_drawn()],
        ),
        Said("for each loading; {}, {} and {} % lie", near_the_papers(), DRAWS),
        *scenes,
    ]


def numbers() -> list[Said]:
    thetas = ("0.833", "5/6", "0.8333343", "-5/6")
    runs = {theta: run_of(theta) for theta in thetas}
    fragile = [runs["5/6"][1], runs["0.8333343"][1]]
    return [
        *(Said(f"| {x} | {{}} | {{}} | {{}} |", run) for x, run in runs.items()),
        Said("by 1e-6 changes mu_sapp from {} to {}", fragile),
        Said("All {}, {} and {} transitions", proved("transitions")),
        Said(
            "times within {} s up to the first global slip",
            [worst("time_error_to_global_slip_s")],
            is_limit=True,
        ),
        Said("and {} s at 10 s", [worst("time_error_while_agreeing_s")], is_limit=True),
        Said("exponents are {}, {} and {} per second", exponents(), EXPONENT),
        Said("at most +-{}:", [table("lyapunov")["uncertainty_per_s"].max()], EXPONENT),
        Said("tenfold in {} to {} s", tenfold(), EXPONENT),
        Said(
            "with 320 blocks it is within {} of it",
            [max(medians("mu_sapp", 320)) - 0.45],
            is_limit=True,
        ),
        Said("from {} blocks on", [finest_that_differ()]),
        Said(
            "counts {} % more than at theta = 0 with ten blocks, and {} % more with 320",
            [more_counted(10), more_counted(320)],
        ),
        Said("We drew {} sliders", [sliders_drawn()]),
        Said("Of these, {}, {} and {} % have mu_sapp", near_the_papers(), DRAWS),
        Said(
            "In {} % (95 % interval: {} to {} %) the three",
            share("all", "mu_sapp", "same_mu_sapp"),
            DRAWS,
        ),
        Said("In none (below {} %)", share("all", "all", "all_six")[2:], DRAWS),
        Said(
            "the median of mu_sapp is {}, {} and {} (1000 runs each)",
            noise_medians(),
            NOISE,
        ),
        Said("is larger by {} to {}.", excess_with_noise(), NOISE),
    ]


def performance() -> list[Said]:
    sessions = [
        Said(
            f"| {shown} | {run} | {{}} ({{}} to {{}}) | {{}} s | {{}} s |",
            beside_heyoka(theta, case),
        )
        for shown, theta in (("-5/6", "-5/6"), ("0", "0"), ("+5/6", "5/6"))
        for run, case in (
            ("first global slip", "to the first global slip"),
            ("10 s", "10 s"),
        )
    ]
    methods = [
        Said(
            f"| {row} | {{}} | {{}} ms | {{}} us | {{}} s |", one_method(method, value)
        )
        for row, method, value in (
            ("exact", "exact", 0.0),
            ("heyoka.py, 2.2e-16", "heyoka", 2.2e-16),
            ("RK4, compiled, 30 ns", "rk4_located", 3e-8),
            ("DOP853, SciPy, 1e-11", "scipy_dop853", 1e-11),
        )
    ]
    return [*methods, *sessions, Said("heyoka takes {} times", published_factor())]


def proof() -> list[Said]:
    error = worst("time_error_to_global_slip_s")
    return [Said("times within {} s up", [error], is_limit=True)]


def hero() -> list[Said]:
    return [Said("coefficient of {} sliders", [sliders_drawn()])]


def wave() -> list[Said]:
    slips = pd.read_csv(ROOT / "results/tables/fig10_slips.csv")
    first = slips["is_global"].idxmax()
    precursors = slips["front"][:first]
    return [Said("stop after blocks {} and {}", [4, precursors.max()])]


RESULTS = {
    "README.md": readme,
    "docs/numbers.md": numbers,
    "docs/performance.md": performance,
    "docs/proof.md": proof,
    "workflow/report/hero.rst": hero,
    "workflow/report/wave.rst": wave,
}
# Inputs, definitions, limits and references: no results.
GIVEN = {
    "README.md": [
        "after block 4 and block 9",
        "Tribology Letters 38 (2010) 313-323, doi:10.1007/s11249-010-9611-7",
        "for the printed 0.49",
        "0.49 belongs to the ten blocks",
        "within 0.01 of 0.49",
        "Python 3.11",
        "1.3 GB",
        "(1 + (2i - N - 1)/(N - 1) theta)",
        "Eq. 7); with theta > 0",
        "CC BY 4.0",
    ],
    "docs/numbers.md": [
        "accurate to 1e-9 s",
        "0.49 is the value of ten blocks",
        "agree to 0.01, interval included",
        "mu_k N / ((mu_s - mu_k)(1 - theta))",
        "interpretation of the printed 0.833",
        "mu_s = 0.70 is 0.695 to 0.705; V, printed as 0.1 mm/s, is 0.05 to 0.15",
        "within 0.01 of the paper's 0.49",
        "coefficients agree to 0.01",
        "With 0.1 % noise",
        "Those at -5/6 and 0 are the same to 0.01",
        "with 160 the three agree",
    ],
    "docs/performance.md": [
        "(Zen 4)",
        "at most 1.5 tau long, where 1/tau",
        "up to 64 chains",
        "of order 100 N",
        "100,000 random chains",
        "order 2 d + 1",
        "4 k v in a second (4 K v where K > k)",
        "w/(4 k v)",
        "14 s",
    ],
    "docs/proof.md": ["from 256 to 4096", "within 1e-40 s", "13 to 20 s"],
    "docs/reliability.md": [
        "60 to 150 us a transition at 10 to 200 blocks, 70 to 105 times",
        "in 13 s",
        "(400 MB)",
        "16 roundings of 2^-53",
        "20,000 random chains no run needed more than 12",
    ],
    "docs/customise.md": ["60 mm apart", "20 s longer", "(1 or )", "12.3 s", "1.8 N"],
    "docs/models.md": ["with K above 2 MN/m"],
    "docs/troubleshooting.md": ["20,50 may be", "below 1e-4 of the mean load"],
    "CONTRIBUTING.md": [
        "below 400 lines, functions below 80",
        "within 200 s",
        "1 MB",
    ],
    "workflow/report/fig09.rst": ["pushes block 1"],
    "workflow/report/grid.rst": ["the paper's 0.49", "the 1st and the 99th percentile"],
    "workflow/report/hero.rst": ["from 5 to 95 %", "within 0.01 of the paper's 0.49"],
    "workflow/report/resolution.rst": ["5 and 95 %"],
    "workflow/report/wave.rst": ["from block 1 to block 10 in 0.07 ms"],
    "workflow/report/workflow.rst": ["Tribology Letters 38 (2010) 313-323"],
}


# Their tables are made or run by other tests.
HELD_THERE = {
    "docs/adding.md": "test_docs",
    "docs/benchmark.md": "test_benchmark",
}
PAGES = [
    path.relative_to(ROOT).as_posix()
    for pattern in (
        "README.md",
        "CONTRIBUTING.md",
        "docs/*.md",
        "workflow/report/*.rst",
    )
    for path in sorted(ROOT.glob(pattern))
]


@pytest.mark.parametrize("page", [page for page in PAGES if page not in HELD_THERE])
def test_a_number_is_that_of_a_table_or_is_given(page):
    text = plain((ROOT / page).read_text(encoding="utf-8"))
    for said in RESULTS.get(page, list)():
        text = said.check(text)
    for given in map(plain, GIVEN.get(page, [])):
        assert given in text
        text = text.replace(given, "")
    left = [
        text[max(0, number.start() - 40) : number.end() + 40]
        for number in re.finditer(NUMBER, text)
    ]
    assert left == []
