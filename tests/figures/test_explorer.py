"""The explorer solves chains as the library does, says and draws what is kept, and
serves every reader."""

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from browser import browser, find_browser
from figures.explorer_sessions import (
    GOLDEN,
    KEPT,
    SESSIONS,
    SETTLED,
    THETAS,
    assert_same_page,
    record,
    states,
    write_example,
)

from precursors import Chain, cli, find_slips, simulate
from precursors.figures.explorer.page import proved_slider
from precursors.model.scenes import SLIDER, scene_slider
from precursors.solver.simulate import TransitionLimitError

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src/precursors/figures/explorer"

MOST_BYTES = 120e3
# Errors of times [s] up to the end of the first global slip; later they grow with the
# chaos of the motion.
UP_TO_GLOBAL_SLIP = 1e-10
# Largest relative error of a time of the random chains, in their first 200 transitions.
OF_RANDOM_CHAINS = 1e-9
PHONE = (390, 844)  # px
TARGET = 44  # px, smallest width and height of what a finger meets
TEXT_CONTRAST, MARK_CONTRAST = 4.5, 3.0  # WCAG 2.2 AA


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("explorer") / "explorer.html"
    write_example(path)
    return path


@pytest.fixture(scope="module")
def page():
    path = find_browser()
    if path is None:
        pytest.skip(
            "no Chromium or Chrome here: the explorer is not tried in a browser"
        )
    with browser(path) as new_page:
        page = new_page()
        page.open("about:blank")
        yield page


def open_explorer(page, file, *size):
    page.open(file.as_uri(), *size)
    page.wait_for(SETTLED)


# The solver

SOLVE = """(() => {
  %s
  return %s.map(([slider, duration, most]) => {
    const run = newRun(chainOf(slider), duration);
    for (const _ of solve(run)) if (run.time.length >= most) break;
    return [run.time, run.block, run.mode, run.load];
  });
})()"""


def run_in(page, cases):
    """Transitions of (slider, duration, most transitions) as solver.js finds them."""
    asked = json.dumps(
        [[SLIDER | slider, duration, most] for slider, duration, most in cases]
    )
    solver = (
        (SOURCE / "solver.js").read_text(encoding="utf-8").replace('"use strict";', "")
    )
    return page.evaluate(SOLVE % (solver, asked))


@pytest.mark.parametrize("scene", THETAS)
def test_every_transition_is_the_proved_one(page, scene):
    reference = pd.read_csv(GOLDEN / f"reference_{scene}.csv")
    ((time, block, mode, load),) = run_in(
        page, [({"theta": THETAS[scene]}, 10.0, 10**6)]
    )
    assert block == reference["block"].tolist()
    assert mode == reference["mode"].tolist()
    run = simulate(Chain.from_slider(theta=THETAS[scene]), until="global slip")
    first = slice(len(run.transitions))
    assert np.abs(np.array(time) - reference["time_s"])[first].max() < UP_TO_GLOBAL_SLIP
    assert (
        np.abs(np.array(load) - reference["tangential_load_N"])[first].max()
        < 80 * UP_TO_GLOBAL_SLIP
    )


def random_slider(rng):
    """A slider from all that the page can be set to, but for loads of zero."""
    mu_s = rng.uniform(0.2, 1.5)
    return {
        "n_blocks": int(rng.integers(1, 41)),
        "theta": rng.uniform(-0.98, 0.98),
        "mu_s": mu_s,
        "mu_k": mu_s * rng.uniform(0, 0.98),
        "drive_stiffness": 10 ** rng.uniform(4, 8),
        "drive_velocity": 10 ** rng.uniform(-6, -1),
    }


def test_fifty_random_sliders_move_as_in_the_kernel(page):
    rng = np.random.default_rng(2010)
    sliders = [random_slider(rng) for _ in range(50)]
    chains = [Chain.from_slider(**slider) for slider in sliders]
    durations = [5 * chain.normal_load / chain.loading_rate for chain in chains]
    found = run_in(
        page,
        [(s, duration, 200) for s, duration in zip(sliders, durations, strict=True)],
    )
    for chain, duration, (time, block, mode, _) in zip(
        chains, durations, found, strict=True
    ):
        try:
            run = simulate(chain, duration, max_transitions=200)
        except TransitionLimitError as error:
            run = error.run
        assert block[:200] == run.transitions["block"].tolist()
        assert mode[:200] == run.transitions["mode"].tolist()
        assert time[:200] == pytest.approx(
            run.transitions["time"], rel=OF_RANDOM_CHAINS
        )


def test_the_chains_that_are_called_proved_move_as_in_the_kernel_up_to_the_first_global_slip(
    page,
):
    config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    sliders = [
        proved_slider(values) for values in config["accuracy"]["proved"].values()
    ]
    assert all(scene_slider(config, scene) in sliders for scene in THETAS)
    runs = [
        simulate(Chain.from_slider(**slider), until="global slip").transitions
        for slider in sliders
    ]
    found = run_in(
        page,
        [(slider, 10.0, len(run)) for slider, run in zip(sliders, runs, strict=True)],
    )
    for run, (time, block, mode, _) in zip(runs, found, strict=True):
        assert (block, mode) == (run["block"].tolist(), run["mode"].tolist())
        assert np.abs(np.array(time) - run["time"]).max() < UP_TO_GLOBAL_SLIP


# The page


@pytest.mark.parametrize("session", SESSIONS)
def test_the_page_says_and_draws_what_is_kept_and_asks_the_network_for_nothing(
    page, file, session
):
    kept = pd.read_csv(KEPT, keep_default_na=False)
    assert_same_page(
        record(page, file.as_uri(), session), kept[kept["session"] == session]
    )
    assert page.complaints == []
    asked = {
        request.split("#")[0]
        for request in page.requests
        if not request.startswith("blob:")
    }
    assert asked == {file.as_uri()}


def kept_answers():
    """What the page says of every run to its end, by the command that it gives for the
    run."""
    kept = pd.read_csv(KEPT, keep_default_na=False)
    of = {one["command"]: one["answers"] for one in states(kept) if "film" not in one}
    return {command: said for command, said in of.items() if "Stopped" not in said}


@pytest.mark.parametrize("command", kept_answers())
def test_what_is_kept_is_what_the_library_says_of_the_pages_command(
    command, tmp_path, capsys, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    loads, _, options = command.rpartition(" > loads.txt && ")
    (tmp_path / "loads.txt").write_text(loads.removeprefix('echo "').removesuffix('"'))
    assert (
        cli.main(
            ["simulate", *shlex.split(options)[2:], "--until-global-slip", "--json"]
        )
        == 0
    )
    told = json.loads(capsys.readouterr().out)
    expected = "No global slip in 10 s"
    if told["global_slip_s"]:
        counted = told["events_counted"]
        expected = f"{counted} event{'s' * (counted > 1)} counted in Fig. 13"
        said = re.sub(
            r"(Fig. 13|μsapp)[^·=]*(?=[·=]|$)", r"\1 ", kept_answers()[command]
        )
        assert (
            f"μsapp = {told['mu_sapp']:.4f} · first global slip at {told['global_slip_s']:.3f} s"
            in said
        )
    assert kept_answers()[command].startswith(expected)


def test_the_row_of_blocks_moves_as_the_library_says(page, file):
    run = simulate(Chain.from_slider(), 3.0)
    slip = find_slips(run).query("is_global").iloc[0]
    open_explorer(page, file)
    page.evaluate("goToStep(3)")
    page.wait_for(SETTLED)
    for share in (0.0, 0.25, 0.8):
        time = slip.onset + share * (slip.end - slip.onset)
        page.evaluate(f"state.time = {time}; redraw('row')")
        page.wait_for("motions.has(state.event)")
        shifts = np.array(page.evaluate(f"frameAt({time}).shifts"))
        positions = run.at([time])[0][0]
        assert shifts - shifts[-1] == pytest.approx(positions - positions[-1], abs=2e-7)


READ = (
    "(new Function('postMessage', 'onmessage', %s + '; return readMeasurement;')()(%s))"
)


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
def test_a_measurement_is_read_or_the_wrong_line_is_named(page, lines, points):
    source = "".join(
        (SOURCE / f"{name}.js").read_text("utf-8") for name in ("solver", "worker")
    )
    found = page.evaluate(READ % (json.dumps(source), json.dumps(lines)))
    assert found == (
        {"problem": points}
        if isinstance(points, str)
        else dict(zip(("time", "load"), points, strict=True))
    )


# Everybody


def test_the_page_is_one_small_file_that_names_no_other(file):
    page = file.read_text(encoding="utf-8")
    assert len(page.encode()) < MOST_BYTES
    assert "src=" not in page.replace("script-src", "").replace("worker-src", "")
    assert "a <!--<script>" not in page


def test_a_phone_shows_the_row_and_the_sliders_together_and_a_finger_meets_everything(
    page, file
):
    open_explorer(page, file, *PHONE)
    boxes = page.evaluate(
        "['row', 'play', 'sliders'].map(name => element(name).getBoundingClientRect())"
        ".map(box => [box.top, box.bottom])"
    )
    (row_top, row), (play_top, play), (sliders_top, sliders) = boxes
    assert 0 <= row_top < row <= play_top < play <= sliders_top < sliders <= PHONE[1]
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE[0]
    small = page.evaluate(
        "document.querySelectorAll('details').forEach(d => d.open = true),"
        "[...document.querySelectorAll('button, input:not([type=file]), summary, .file')]"
        # words in a sentence may be smaller
        ".filter(e => e.offsetParent && !e.closest('p .word'))"
        f".filter(e => e.offsetWidth < {TARGET} || e.offsetHeight < {TARGET}).map(e => e.outerHTML)"
    )
    assert small == []


CONTRASTS = """(() => {
  const channels = (colour) => colour.startsWith("#")
    ? [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)) : colour.match(/[\\d.]+/g).map(Number);
  const linear = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const light = (colour) => channels(colour).slice(0, 3)
    .reduce((sum, v, i) => sum + linear(v / 255) * [0.2126, 0.7152, 0.0722][i], 0.05);
  const ratio = (a, b) => Math.max(light(a) / light(b), light(b) / light(a));
  const behind = (e) => {
    const colour = getComputedStyle(e).backgroundColor;
    return channels(colour)[3] === 0 ? behind(e.parentElement) : colour;
  };
  const isText = (node) => node.nodeType === 3 && node.data.trim();
  const texts = [...document.querySelectorAll("body *")]
    .filter((e) => e.checkVisibility() && !e.disabled && [...e.childNodes].some(isText))
    .map((e) => [ratio(getComputedStyle(e).color, behind(e)), e.outerHTML.slice(0, 90)]);
  const against = (other) => (name) => [ratio(palette[name], palette[other]), name];
  const kinds = ["stuck", "partial", "global", "backward"];
  return [
    [...texts, ...kinds.map(against("on")), against("paper")("soft")],
    [...kinds, "second", "own", "ghost", "line", "ink", "strong"].map(against("paper")),
  ];
})()"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_contrast_is_that_of_wcag_aa_and_every_control_has_a_name(
    page, file, scheme
):
    open_explorer(page, file)
    page.prefer(prefers_color_scheme=scheme)
    page.settle()
    texts, marks = page.evaluate(CONTRASTS)
    page.prefer()
    assert len(texts) > 30
    assert [found for found in texts if found[0] < TEXT_CONTRAST] == []
    assert [found for found in marks if found[0] < MARK_CONTRAST] == []
    nameless = page.evaluate(
        "[...document.querySelectorAll('canvas, button, input')].filter(e =>"
        "!(e.getAttribute('aria-label') || e.textContent || e.closest('label')?.textContent))"
        ".map(e => e.outerHTML)"
    )
    assert nameless == []
