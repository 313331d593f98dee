"""The explorer solves chains as the library does, says and draws what is kept, and
serves every reader."""

import json
import re
import shlex
from itertools import chain, combinations
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from colorspacious import cspace_convert
from explorer.explorer_sessions import (
    KEPT,
    LAPTOP,
    SESSIONS,
    SETTLED,
    TOLERANCE,
    assert_same_page,
    record,
    states,
)
from matplotlib.colors import to_rgb

from precursors import Chain, cli, find_slips, simulate
from precursors.analysis.horizon import horizon
from precursors.analysis.slips import first_global_slip, slip_table
from precursors.figures import style

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src/maegawa2010/explorer"

MOST_BYTES = 120e3
# Predictability times of the page, which has one twin, and of the library, which has
# sixteen, agree within a factor.
OF_PREDICTABILITY = 2.0
DISTANCE_IN_CIELAB = 20.0  # told apart by all readers
PHONE = (390, 844)  # px
ZOOMED = (640, 400)  # px, the laptop at 200 %
SHIFT = 0.02  # of the layout, largest sum over the steps and over a drag
TARGET = 44  # px, smallest width and height of what a finger meets
TEXT_CONTRAST, MARK_CONTRAST = 4.5, 3.0  # WCAG 2.2 AA


# In the last step, whose 40 blocks take seconds.
SHORTER_CHAIN = "STEPS.at(-1).blocks = 12"


def open_explorer(page, file, *size):
    page.open(file.as_uri(), *size)
    page.wait_for(SETTLED)


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
    return {
        command: said
        for command, said in of.items()
        if not re.search("until then|grey", said)
    }


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
        time = told["global_slip_s"]
        when = f"{time:.3f} s" if time >= 1 else f"{1e3 * time:.1f} ms"
        friction = f"μsapp = {told['mu_sapp']:.4f}"
        assert f"{friction} · first global slip at {when}" in said
    assert kept_answers()[command].startswith(expected)


def test_the_row_of_blocks_moves_as_the_library_says(page, file):
    run = simulate(Chain.from_slider(), 3.0)
    slip = find_slips(run).query("is_global").iloc[0]
    open_explorer(page, file)
    page.prefer(prefers_reduced_motion="reduce")  # which plays no film
    page.evaluate("goToStep(3)")
    page.wait_for(SETTLED)
    for share in (0.0, 0.25, 0.8):
        time = slip.onset + share * (slip.end - slip.onset)
        page.evaluate(f"state.time = {time}; redraw('row')")
        page.wait_for("motions.has(state.event)")
        shifts = np.array(page.evaluate(f"frameAt({time}).shifts"))
        positions = run.at([time])[0][0]
        assert shifts - shifts[-1] == pytest.approx(positions - positions[-1], abs=2e-7)


def predictability_settings():
    """Sliders of the paper and others; many of them are not predictable up to the first
    global slip."""
    rng = np.random.default_rng(32)
    settings = [{"n_blocks": n, "theta": 5 / 6} for n in (10, 20)]
    settings += [{"n_blocks": 40, "theta": 0.83}]
    for _ in range(6):
        mu_s = rng.uniform(0.3, 1.2)
        setting = {"n_blocks": int(rng.integers(5, 26)), "theta": rng.uniform(-1, 1)}
        friction = {"mu_s": mu_s, "mu_k": mu_s * rng.uniform(0.1, 0.9)}
        settings.append(setting | friction)
    return settings


def test_from_where_the_library_calls_a_run_unpredictable_the_page_is_grey(page, file):
    open_explorer(page, file)
    grey = 0
    for setting in predictability_settings():
        page.evaluate(
            f"Object.assign(state.slider, UNIFORM.slider, {json.dumps(setting)}),"
            "solve()"
        )
        page.wait_for(SETTLED)
        known, answer, trust = page.evaluate(
            "[Math.min(run.known, DURATION), element('answers').className,"
            " element('trust').textContent]"
        )
        run = simulate(Chain.from_slider(**setting), 10.0)
        ratio = known / horizon(run, TOLERANCE)
        assert 1 / OF_PREDICTABILITY < ratio < OF_PREDICTABILITY, setting
        friction = first_global_slip(slip_table(run))
        is_grey = answer == "lost"
        assert is_grey == ("one draw" in trust)
        assert is_grey == (known < (friction.time if friction else run.duration))
        grey += is_grey
        if not is_grey and friction:
            expected = [friction.events_counted, f"{friction.mu_sapp:.4f}"]
            assert page.evaluate("[run.counted.length, ratio()]") == expected
    assert 2 <= grey <= 7


def test_the_answer_turns_grey_while_the_slider_is_held(page, file):
    open_explorer(page, file)
    assert page.evaluate("element('answers').className") == ""
    page.evaluate("setSlider('theta', 0.83), setSlider('n_blocks', 40), solve(true)")
    page.wait_for("element('answers').className === 'lost'")
    assert page.evaluate("[run.slider.n_blocks, run.isFinal]") == [40, False]


@pytest.mark.parametrize("name", ["digits", "blocks"])
def test_a_study_finds_what_the_library_finds(page, file, name):
    open_explorer(page, file)
    step = {"digits": 5, "blocks": 6}[name]
    page.evaluate(SHORTER_CHAIN)
    page.evaluate(f"STUDIES.{name}.count = 12, goToStep({step})")
    page.wait_for(SETTLED)
    found = page.evaluate(
        f"found.{name}.map(({{ value }}, i) => [value, STUDIES.{name}.sliderOf(i)])"
    )
    assert len(found) == 12
    if name == "digits":  # which are printed as 0.70, and are not alike
        friction = [slider["mu_s"] for _, slider in found]
        assert len(set(friction)) == 4
        assert {f"{mu_s:.2f}" for mu_s in friction} == {"0.70"}
    told = page.evaluate("element('lengths').ariaLabel")
    assert {"digits": "of 4 in the band", "blocks": "0 of 12 values"}[name] in told
    for value, slider in found:
        run = simulate(Chain.from_slider(**slider), 20.0, until="global slip")
        assert value == pytest.approx(first_global_slip(slip_table(run)).mu_sapp, 1e-9)


# Everybody


def test_the_page_is_one_small_file_that_names_no_other(file):
    page = file.read_text(encoding="utf-8")
    assert len(page.encode()) < MOST_BYTES
    assert "src=" not in page.replace("script-src", "").replace("worker-src", "")


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
        "[...document.querySelectorAll('button, input, summary')]"
        # words in a sentence may be smaller
        ".filter(e => e.offsetParent && !e.closest('p .word'))"
        f".filter(e => e.offsetWidth < {TARGET} || e.offsetHeight < {TARGET}).map(e => e.outerHTML)"
    )
    assert small == []


WATCH_SHIFTS = """(() => {
  window.shift = 0;
  new PerformanceObserver((list) => list.getEntries().forEach((one) => (shift += one.value)))
    .observe({ type: "layout-shift", buffered: true });
})()"""
DRAG = """(async () => {
  const values = { theta: [-0.9, 0.3, 0.95], n_blocks: [3, 40, 12], mu_k: [0.1, 0.6] };
  for (const id in values) {
    for (const value of values[id]) {
      element(id).value = value;
      element(id).dispatchEvent(new Event("input", { bubbles: true }));
      await new Promise((done) => setTimeout(done, 50));
    }
  }
  element("mu_k").dispatchEvent(new Event("change", { bubbles: true }));
})()"""


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_nothing_jumps_between_steps_and_in_a_drag(page, file, size):
    open_explorer(page, file, *size)
    page.prefer(prefers_reduced_motion="reduce")  # which plays no film
    page.evaluate(WATCH_SHIFTS)
    page.evaluate("STUDIES.digits.count = STUDIES.blocks.count = 2")
    page.evaluate(SHORTER_CHAIN)
    for step in range(1, 7):
        page.evaluate(f"goToStep({step})")
        page.wait_for(SETTLED)
    page.evaluate(DRAG)
    page.wait_for(SETTLED)
    page.settle()
    assert page.evaluate("shift") < SHIFT
    if size == LAPTOP:
        assert page.evaluate("document.documentElement.scrollHeight") <= size[1]


@pytest.mark.parametrize("size", [LAPTOP, PHONE, ZOOMED])
def test_no_control_takes_the_focus_under_the_sliders(page, file, size):
    open_explorer(page, file, *size)
    hidden = page.evaluate(
        "[...document.querySelectorAll('main button, main input, main summary')]"
        ".filter(e => e.checkVisibility({ visibilityProperty: true }) && !e.disabled)"
        ".filter(e => { e.focus(); const box = e.getBoundingClientRect(); return"
        " box.top < 0 || box.bottom > element('sliders').getBoundingClientRect().top })"
        ".map(e => e.outerHTML)"
    )
    assert hidden == []
    page.evaluate("scrollTo(0, 0)")
    row, bar = page.evaluate(
        "['row', 'sliders'].map(id => element(id).getBoundingClientRect().toJSON())"
    )
    assert 0 <= row["top"] < row["bottom"] <= bar["top"]


def test_a_reader_who_listens_hears_words_and_only_when_a_slider_is_let_go(page, file):
    open_explorer(page, file)
    live = "['answers', 'readout', 'step'].map(id => element(id).getAttribute('aria-live'))"
    page.evaluate("setSlider('theta', 0.2), solve(true)")
    assert page.evaluate(live) == ["off"] * 3
    page.evaluate("solve()")
    page.wait_for(SETTLED)
    assert page.evaluate(live) == ["polite"] * 3
    names = page.evaluate(
        "[...document.querySelectorAll('#sliders input')].map(e => e.ariaLabel)"
    )
    assert names[0] == "tilt of the load, theta"
    tips = page.evaluate("Object.values(WORDS).map(([, about]) => plain(about))")
    told = page.evaluate(
        "[...document.querySelectorAll('canvas')].map(e => e.ariaLabel).join(' ')"
    )
    assert [tip for tip in tips if tip in told] == []
    assert (
        page.evaluate("element('scrubber').getAttribute('aria-valuetext')")[-1] != "0"
    )


def test_paper_has_the_colours_of_the_light_page(page, file):
    open_explorer(page, file)
    page.prefer(prefers_color_scheme="dark")
    dark = page.evaluate("readPalette(), palette.paper")
    during = page.evaluate("dispatchEvent(new Event('beforeprint')), palette.paper")
    after = page.evaluate("dispatchEvent(new Event('afterprint')), palette.paper")
    page.prefer()
    assert during == "#ffffff"
    assert dark == after != during


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
  const numbers = kinds.map((kind) => [ratio(palette[kind], inkOn(palette[kind])), kind]);
  return [
    [...texts, ...numbers, against("paper")("soft")],
    [...kinds, "unsure", "pushed", "even", "far", "line", "ink", "strong"].map(against("paper")),
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


FIGURES = {
    "partial": style.PARTIAL,
    "global": style.GLOBAL,
    "backward": style.BACKWARD,
    "pushed": style.PUSHED_END,
    "even": style.EVEN,
    "far": style.FAR_END,
    "unsure": style.GREY,
}
# Marks that stand side by side in a figure. A backward slip is half as high besides.
TOLD_APART = [("partial", "global", "unsure"), ("pushed", "even", "far", "unsure")]


def places_in_cielab(colors, sight=None):
    seen = np.array([to_rgb(color) for color in colors.values()])
    if sight:
        space = {"name": "sRGB1+CVD", "cvd_type": sight, "severity": 100}
        seen = np.clip(cspace_convert(seen, space, "sRGB1"), 0.0, 1.0)
    return dict(zip(colors, cspace_convert(seen, "sRGB1", "CIELab"), strict=True))


def palette(scheme):
    """Colours of the style sheet."""
    sheet = (SOURCE / "explorer.css").read_text(encoding="utf-8")
    light, dark = (
        dict(re.findall(r"--(\w+): (#\w+);", block))
        for block in re.findall(r":root[^{]*{([^}]*)}", sheet)[:2]
    )
    return light if scheme == "light" else light | dark


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_colour_means_the_same_as_in_the_figures(scheme):
    figures = places_in_cielab(FIGURES)
    colors = palette(scheme)
    places = places_in_cielab({name: colors[name] for name in FIGURES})
    for name, place in places.items():
        assert np.linalg.norm(place - figures[name]) < DISTANCE_IN_CIELAB, name


@pytest.mark.parametrize("sight", [None, "protanomaly", "deuteranomaly"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_marks_side_by_side_are_told_apart_by_all_readers(scheme, sight):
    places = places_in_cielab(palette(scheme), sight)
    for one, other in chain.from_iterable(combinations(of, 2) for of in TOLD_APART):
        distance = np.linalg.norm(places[one] - places[other])
        assert distance >= DISTANCE_IN_CIELAB, (one, other)
