"""The page has the numbers, motion and colours of the library, and is accessible."""

import json
import re
import shlex
from time import perf_counter

import numpy as np
import pytest
from colours import DISTINCT, SIGHTS, alike, in_cielab
from explorer.example import (
    LAPTOP,
    PICTURE,
    SETTLED,
    SOURCE,
    TOLERANCE,
    drawn_from,
)
from places import made

from precursors import Chain, apparent_friction, cli, simulate, slip_table, summarise
from precursors.analysis.horizon import horizon
from precursors.figures import style

SCENES = ["fig11", "fig10", "fig12"]
MOST_BYTES = 120e3
# Factor between the predictability times of the page, which has one twin, and of the
# library, which has sixteen.
PREDICTABILITY_FACTOR = 2.0
# An animated motion has discrete times, between which it changes by less than
FORCE_STEP = 2.0  # N
SHIFT_STEP = 2e-7  # m
# Error of a mean of F_X/F_Z: the page interpolates linearly between transitions.
MEAN_ERROR = 2e-5
FILM = 3.0  # s, shortest film of an event that is shown alone
WATCHED = 0.3  # s, the part of it that the test plays
PHONE = (390, 844)  # px
LANDSCAPE = (844, 390)  # px, the phone turned
ZOOMED = (640, 400)  # px, the laptop at 200 %
LAYOUT_SHIFT = 0.02  # largest sum over the steps and over a drag
TARGET = 44  # px, smallest width and height of a control for a finger
TEXT_CONTRAST = 4.5  # WCAG 2.2 AA
MARK_CONTRAST = 3.0  # WCAG 2.2 AA

# Actions of a reader.
TOOLS = """
  var press = (query) => document.querySelector(query).click();
  var set = (query, ...values) => values.forEach((value) => {
    const e = document.querySelector(query);
    e.value = value;
    for (const kind of ["input", "change"]) e.dispatchEvent(new Event(kind, { bubbles: true }));
  });
  var tap = (id, x, y = 50) => {
    const box = element(id).getBoundingClientRect();
    const at = { clientX: box.left + x, clientY: box.top + y, bubbles: true };
    element(id).dispatchEvent(new MouseEvent("click", at));
  };
"""


def open_explorer(page, file, *size, address=""):
    page.open(file.as_uri() + address, *size)
    page.prefer(prefers_reduced_motion="reduce")  # no film plays
    page.evaluate(f"{TOOLS} state.isToPlay = false, stop()")
    page.wait_for(SETTLED)


def do(page, action):
    page.evaluate(action)
    page.wait_for(SETTLED)


# Numbers, motion and figures

CHANGES = {
    "step 5": "press('[data-step=\"5\"]')",
    "its tilt": "press('.seen [data-theta=\"0.01\"]')",
    "theta": "set('#theta', 0.9, -0.25)",
    "one block": "set('#n_blocks', 1)",
    "blocks": "set('#n_blocks', 4)",
    "mu_k comes back": "set('#mu_k', 0.8), set('#mu_s', 0.3, 0.9)",
    "K": "set('#drive_stiffness', 7.1)",
    "V": "set('#drive_velocity', -4.2)",
    "too slow": "set('#drive_velocity', -6)",
}


def test_the_page_has_the_numbers_of_the_library(
    page, file, tmp_path, capsys, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    open_explorer(page, file)
    commands = {}
    for name, action in CHANGES.items():
        do(page, action)
        commands[name] = page.evaluate("command()")
        how = [*shlex.split(commands[name])[2:], "--until-global-slip", "--json"]
        assert cli.main(["simulate", *how]) == 0
        summary = json.loads(capsys.readouterr().out)
        expected = "No global slip in 10 s"
        if time := summary["global_slip_s"]:
            n = summary["events_counted"]
            expected = (
                f"{n} event{'s' * (n > 1)}, counted as in Fig. 13 · "
                f"μsapp = {summary['mu_sapp']:.4f} · first global slip at "
            ) + (f"{time:.3f} s" if time >= 1 else f"{1e3 * time:.1f} ms")
        answers = page.evaluate("plain(shown.answers)")
        assert answers.startswith(expected), name
        assert ("proved" in answers) == (name == "step 5")
    assert len(set(commands.values())) == len(CHANGES)
    assert "--mu-s 0.9 --mu-k 0.8" in commands["mu_k comes back"]


def test_the_row_has_the_displacements_and_forces_of_the_library(page, file):
    run = simulate(Chain.from_slider(theta=0.9), until="global slip")
    slip = slip_table(run).query("counted").iloc[-3]
    open_explorer(page, file)
    do(page, "set('#theta', 0.9)")
    do(page, f"choose({slip.name})")
    for share in (0.01, 0.4, 0.8, 1.5):
        time = slip.onset_s + share * (slip.end_s - slip.onset_s)
        page.evaluate(f"state.time = {time}, redraw('row')")
        page.wait_for(f"run.motions.has({slip.name}) && {SETTLED}")
        frame = f"frameAt({time})"
        shifts = np.array(page.evaluate(f"{frame}.shifts"))
        forces = page.evaluate(f"[...{frame}.forces].slice(0, -1)")
        positions = run.at([time])[0][0]
        moved = positions - positions[-1]
        assert shifts - shifts[-1] == pytest.approx(moved, abs=SHIFT_STEP)
        assert forces == pytest.approx(run.spring_forces([time])[0], abs=FORCE_STEP)
        assert page.evaluate(f"{frame}.modes.some(Boolean)") == (share < 1)


def test_an_event_plays_for_three_seconds_and_stops_at_its_end(page, file):
    open_explorer(page, file)
    page.prefer(prefers_reduced_motion="no-preference")
    page.evaluate("goToStep(1)")
    page.wait_for("state.playing")
    first, last = page.evaluate("[event().onset, event().end].map(inFilm)")
    assert last - first == pytest.approx(FILM)
    began = perf_counter()
    page.evaluate(f"stop(), state.time = inRun({last - WATCHED}), play()")
    page.wait_for("!state.playing")
    assert perf_counter() - began > WATCHED
    assert page.evaluate("[state.view, state.time - event().end]") == ["event", 0]


def press_key(page, key, text="", code=0):
    keys = {"key": key, "text": text, "windowsVirtualKeyCode": code}
    for kind in ("keyDown", "keyUp"):
        page.call("Input.dispatchKeyEvent", type=kind, **keys)


def test_the_keyboard_reaches_the_six_steps_and_every_event(page, file):
    slips = slip_table(simulate(Chain.from_slider(), until="global slip"))
    open_explorer(page, file)
    for step in range(1, 7):
        while page.evaluate("document.activeElement.dataset.step") != str(step):
            press_key(page, "Tab", code=9)
        press_key(page, "Enter", "\r", 13)
        page.wait_for(f"state.step === {step} && {SETTLED}")
        assert page.evaluate("document.querySelectorAll('.seen').length") == 1
    do(page, "document.activeElement.blur(), goToStep(1)")
    do(page, "choose(0)")
    for slip in slips.itertuples():
        page.settle()
        kind = "precursor" if slip.counted else "shorter precursor"
        kind = "global slip" if slip.is_global else kind
        readout = " ".join(page.evaluate("element('readout').textContent").split())
        assert readout.startswith(f"Event {slip.Index + 1} of 60, {kind}: block")
        assert (
            f"FX: {slip.load_before_N:#.4g} N → {slip.load_after_N:#.4g} N" in readout
        )
        press_key(page, "ArrowRight", code=39)
    for is_playing in (True, False):
        press_key(page, " ", " ", 32)
        assert page.evaluate("Boolean(state.playing)") == is_playing


def test_a_click_opens_the_nearest_event_or_goes_to_that_time(page, file):
    open_explorer(page, file)
    for event, place in {
        4: "'load', chart.time.x(run.events[4].onset) + 9",
        8: "'slips', chart.time.x(run.events[8].onset) - 9",
        11: "'lengths', chart.marks[11][0] + 9, chart.marks[11][1]",
    }.items():
        do(page, "setView('first')")
        page.evaluate(f"tap({place})")
        assert page.evaluate("[state.event, state.view]") == [event, "event"]
        assert page.evaluate("state.time === event().onset")
    do(page, "setView('first')")
    page.evaluate("tap('slips', chart.time.x(0.1))")
    assert page.evaluate("state.time") == pytest.approx(0.1, abs=0.005)


@pytest.mark.parametrize(
    ("setting", "is_grey"),
    [
        ({"n_blocks": 40, "theta": 0.83}, True),
        ({"n_blocks": 25, "theta": -0.3, "mu_s": 1.1, "mu_k": 0.2}, False),
    ],
)
def test_a_run_is_grey_where_the_library_cannot_predict_it(
    page, file, setting, is_grey
):
    """The same holds while a slider is dragged."""
    open_explorer(page, file)
    assert page.evaluate("element('answers').className") == ""
    page.evaluate(f"Object.assign(state.slider, {json.dumps(setting)}), solve(true)")
    if is_grey:
        page.wait_for("element('answers').className === 'lost'")
        assert page.evaluate("[run.slider.n_blocks, run.isFinal]") == [40, False]
    do(page, "solve()")
    known, answer, trust = page.evaluate(
        "[Math.min(run.known, DURATION), element('answers').className,"
        " element('trust').textContent]"
    )
    run = simulate(Chain.from_slider(**setting), 10.0)
    ratio = known / horizon(run, TOLERANCE)
    assert 1 / PREDICTABILITY_FACTOR < ratio < PREDICTABILITY_FACTOR
    assert is_grey == (known < summarise([run])["global_slip_s"].item())
    assert is_grey == (answer == "lost") == ("one draw" in trust)


def test_the_steps_have_the_numbers_of_the_tables(page, file):
    open_explorer(page, file)
    text = " ".join(
        page.evaluate(f"goToStep({step}), plain(shown['step-{step}'])")
        for step in range(1, 7)
    )
    studies = made("digits").set_index(["scene", "quantity", "question"])["share"]
    in_band = [100 * studies[scene, "mu_sapp", "as_printed"] for scene in SCENES]
    full = made("resolution")
    medians = full.query("quantity == 'mu_sapp'").pivot_table(
        index="scene", columns="n_blocks", values="q50"
    )
    for values, digits, end in (
        (in_band, 0, " % have the printed"),
        (medians.loc[SCENES, 320], 3, " with 320 blocks (medians with 0.1 % noise"),
    ):
        first, second, third = (f"{value:.{digits}f}" for value in values)
        assert f"{first}, {second} and {third}{end}" in text
    tilted = page.evaluate("DATA.tilted")
    run = simulate(Chain.from_slider(theta=tilted["theta"]), until="global slip")
    assert f"{apparent_friction(run):.4f}" in text


def test_the_means_of_three_loadings_are_those_of_the_table(page, file):
    table = made("balance").query("n_blocks == 10").set_index("scene").loc[SCENES]
    open_explorer(page, file)
    do(page, "goToStep(3)")
    loadings = "run.loadings.sort((a, b) => a.slider.theta - b.slider.theta)"
    means = page.evaluate(f"{loadings}.map(meanOf)")
    for name, column in {"mean": "mean", "peak": "largest"}.items():
        values = [mean[name] for mean in means]
        assert values == pytest.approx(table[column].tolist(), abs=MEAN_ERROR)
    words = page.evaluate("element('study').getAttribute('aria-label')")
    for row in table.itertuples():
        assert f"peak {row.largest:.3f}, mean {row.mean:.4f}" in words
    do(page, "set('#n_blocks', 24)")
    finer = page.evaluate(f"{loadings}.map(meanOf)")
    for coarse, fine in zip(means, finer, strict=True):
        assert fine["peak"] < coarse["peak"]


@pytest.mark.parametrize("theta", [0, 0.9])
def test_each_slip_has_the_reason_where_it_ends(page, file, theta):
    run = simulate(Chain.from_slider(theta=theta), until="global slip")
    slips = slip_table(run)
    chain = run.chain
    friction = chain.mu_k * np.append(0.0, np.cumsum(chain.weights))
    open_explorer(page, file)
    do(page, f"goToStep(2), set('#theta', {theta})")
    reasons = set()
    for slip in slips.itertuples():
        page.evaluate(f"choose({slip.Index})")
        page.settle()
        end = np.interp(slip.load_before_N, friction, np.arange(11))
        if slip.front == 10:
            spare = slip.load_before_N - friction[-1]
            expected = f", the last, and {spare:.4g} N of the push are left."
        elif slip.front < end - 1:
            after = run.spring_forces([slip.end_s])[0]
            net = after[slip.front] - np.append(after, 0)[slip.front + 1]
            most = chain.mu_s * chain.weights[slip.front]
            numbers = f"{abs(net):.4g} N, below its limit of {most:.4g} N."
            expected = f"the net force on block {slip.front + 1} is then {numbers}"
        else:
            expected = ", where the line ends."
            assert slip.front <= end + 1
        words = " ".join(page.evaluate("element('step-2').textContent").split())
        assert f"reaches block {slip.front}" in words
        assert expected in words
        reasons.add(expected[:9])
    assert len(reasons) > 2


def test_the_line_of_the_onset_stays_while_the_row_slips(page, file):
    open_explorer(page, file)
    do(page, "goToStep(4)")
    before = page.evaluate("[...event().force].slice(1)")
    for share in (0, 0.5, 1):
        time = f"event().onset + {share} * (event().end - event().onset)"
        page.evaluate(f"state.time = Math.min({time}, event().end), redraw('row')")
        page.wait_for(f"run.motions.has(state.event) && {SETTLED}")
        assert page.evaluate("[...frameAt(state.time).before]") == before
    assert page.evaluate("frameAt(state.time).load") < before[0]


def test_the_address_restores_a_state(page, file):
    open_explorer(page, file)
    do(page, "goToStep(3)")
    do(page, "set('#theta', 0.4), set('#n_blocks', 7)")
    address = page.evaluate("location.hash")
    assert address == "#step=mean&theta=0.4&blocks=7"
    length = page.evaluate("history.length")
    do(page, "goToStep(2)")
    do(page, "move(2)")
    event = page.evaluate("state.event")
    assert page.evaluate("location.hash") == f"#step=push&event={event + 1}"
    assert page.evaluate("history.length") == length
    open_explorer(page, file, address="#step=push&event=9&mu-k=0.4")
    assert page.evaluate("[state.step, state.event, run.slider.mu_k]") == [2, 8, 0.4]
    assert page.evaluate("element('refused').textContent") == ""
    wrong = {
        "step=9": "must be one of slip, push, mean, peak, tilt, digits",
        "blocks=2.5": "must be a whole number from 1 to 40",
        "theta=x": "must be from -0.99 to 0.99",
        "mu-k=0.9": "must not be above mu-s",
        "tilt=1": "the name must be step, event, theta,",
    }
    open_explorer(page, file, address="#" + "&".join(wrong))
    refused = page.evaluate("element('refused').textContent")
    for part, rule in wrong.items():
        assert f"Left out of the address: {part}: {rule}" in refused
    assert page.evaluate("state.slider") == page.evaluate("STEPS[0].scene.slider")


def test_a_key_pressed_before_the_run_is_there_waits_for_it(page, file):
    open_explorer(page, file)
    do(page, "goToStep(2)")
    shown = page.evaluate("state.event")
    do(page, "goToStep(5)")
    do(page, "goToStep(2), move(1), move(1)")
    assert page.evaluate("state.event") == shown + 2


@pytest.mark.parametrize("part", ["bars", "frames", "line", "blocks"])
def test_a_word_highlights_its_part_of_the_picture(page, file, part):
    open_explorer(page, file)
    do(page, "goToStep(2)")
    before = page.evaluate("element('row').toDataURL()")
    page.evaluate(f"document.body.dataset.lit = '{part}', redraw('row')")
    page.settle()
    assert page.evaluate("element('row').toDataURL()") != before


# Size, network, accessibility and colours


def test_the_picture_in_readme_was_drawn_from_this_page():
    png = PICTURE.read_bytes()
    assert drawn_from().encode() in png, "older than the page: make golden"
    assert len(png) < MOST_BYTES


def test_the_page_is_one_small_file_without_network_requests(page, file):
    open_explorer(page, file)
    assert file.stat().st_size < MOST_BYTES
    assert page.complaints == []
    asked = {url.split("#")[0] for url in page.requests if not url.startswith("blob:")}
    assert asked == {file.as_uri()}


def test_every_control_is_large_enough_and_not_covered(page, file):
    open_explorer(page, file)
    page.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    for size in (LAPTOP, PHONE, ZOOMED, LANDSCAPE):
        page.resize(*size)
        page.settle()
        assert_within_reach(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= size[0]


def assert_within_reach(page):
    """Every control is large enough, and visible when it has the focus."""
    controls = page.evaluate(
        "[...document.querySelectorAll('button, input, summary')]"
        ".filter(e => e.checkVisibility({ visibilityProperty: true }) && !e.disabled)"
        ".map(e => { e.focus(); const box = e.getBoundingClientRect();"
        " const last = e.closest('#sliders') ? innerHeight : element('sliders').getBoundingClientRect().top;"
        # Words in a sentence may be smaller.
        " const least = e.closest('p .word') ? 0 : Math.min(box.width, box.height);"
        " return [e.outerHTML, least, box.top, last - box.bottom] })"
    )
    assert len(controls) > 20
    for html, least, above, below in controls:
        assert least >= TARGET or "word" in html or least == 0, html
        assert above >= 0 <= below, html


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
def test_the_layout_does_not_shift_between_steps_or_in_a_drag(page, file, size):
    open_explorer(page, file, *size)
    page.evaluate(WATCH_SHIFTS)
    for step in range(1, 7):
        page.evaluate(f"goToStep({step})")
        page.wait_for(SETTLED)
    page.evaluate(DRAG)
    page.wait_for(SETTLED)
    page.settle()
    assert page.evaluate("shift") < LAYOUT_SHIFT
    if size == LAPTOP:
        assert page.evaluate("document.documentElement.scrollHeight") <= size[1]


def test_screen_readers_announce_a_slider_when_it_is_released(page, file):
    open_explorer(page, file)
    live = "['answers', 'readout', 'step'].map(id => element(id).getAttribute('aria-live'))"
    page.evaluate("setSlider('theta', 0.2), solve(true)")
    assert page.evaluate(live) == ["off"] * 3
    do(page, "solve()")
    assert page.evaluate(live) == ["polite"] * 3


def test_printing_uses_the_light_colours(page, file):
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
  const numbers = kinds.map((kind) => [ratio(palette[kind], inkOn(kind)), kind]);
  return [
    [...texts, ...numbers, against("paper")("soft")],
    [...kinds, "unsure", ...TILT_COLOURS, "line", "ink", "strong"].map(against("paper")),
  ];
})()"""


def test_contrasts_meet_wcag_aa_and_every_control_has_a_name(page, file):
    open_explorer(page, file)
    for scheme in ("light", "dark"):
        page.prefer(prefers_color_scheme=scheme)
        page.settle()
        texts, marks = page.evaluate(CONTRASTS)
        assert len(texts) > 30
        assert [text for text in texts if text[0] < TEXT_CONTRAST] == []
        assert [mark for mark in marks if mark[0] < MARK_CONTRAST] == []
    page.prefer()
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
    "trailing": style.TRAILING,
    "uniform": style.UNIFORM,
    "leading": style.LEADING,
    "unsure": style.GREY,
}
# Marks that stand side by side. A backward slip differs by its height, too.
SIDE_BY_SIDE = [
    ("partial", "global", "unsure"),
    ("trailing", "uniform", "leading", "unsure"),
]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_are_those_of_the_figures_and_differ(scheme):
    sheet = (SOURCE / "page.css").read_text(encoding="utf-8")
    light, dark = (
        dict(re.findall(r"--(\w+): (#\w+);", block))
        for block in re.findall(r":root[^{]*{([^}]*)}", sheet)[:2]
    )
    colors = light | (dark if scheme == "dark" else {})
    figures = in_cielab(FIGURES)
    places = in_cielab(colors)
    for name in FIGURES:
        assert np.linalg.norm(places[name] - figures[name]) < DISTINCT, name
    for sight in SIGHTS:
        for names in SIDE_BY_SIDE:
            assert alike({name: colors[name] for name in names}, sight) == []
