"""The explorer solves chains as the kernel does, and in a browser it does what it says, with no network."""

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from figures.explorer_sessions import GOLDEN, SOURCE, THETAS

from precursors import Chain, cli, find_precursors, find_slips, simulate
from precursors.figures.explorer.page import counted_events, proved_slider
from precursors.model.scenes import SLIDER, scene_slider
from precursors.solver.simulate import TransitionLimitError

ROOT = Path(__file__).parents[2]

MOST_BYTES = 120e3
# Errors of times [s] up to the end of the first global slip; later they grow with the chaos of the motion.
UP_TO_GLOBAL_SLIP = 1e-10
# Largest relative error of a time of the random chains, in their first 200 transitions.
OF_RANDOM_CHAINS = 1e-9
TARGET = 44  # px, smallest width and height of what a finger meets
DESKTOP, PHONE = (1400, 900), (390, 844)
TEXT_CONTRAST, MARK_CONTRAST = 4.5, 3.0  # WCAG 2.2 AA

COUNTED = {0: 9, -5 / 6: 6, 5 / 6: 14}  # events, as in the paper
SETTLED = (
    "!playing && runs[0] && runs.every(run => run.isFinal && run.id === asked)"
    " && document.body.dataset.drawn == asked"
)
SOLVE = """(() => {
  %s
  return %s.map(([slider, duration, most]) => {
    const run = newRun(chainOf(slider), duration);
    for (const _ of solve(run)) if (run.time.length >= most) break;
    return [run.time, run.block, run.mode, run.load];
  });
})()"""

# Pixels in the middle of each block's line at times, and the colours of bars.
PIXELS_OF_BARS = """((times) => {
  const draw = slideBars, canvas = element("slips"), ratio = canvas.width / canvas.clientWidth;
  let figure;
  slideBars = (...given) => { figure = given[1]; draw(...given); };
  showSlips();
  slideBars = draw;
  const copy = new OffscreenCanvas(canvas.width, canvas.height);
  const picture = copy.getContext("2d", { willReadFrequently: true });
  picture.drawImage(canvas, 0, 0);
  const at = (x, y) => [...picture.getImageData(x * ratio, y * ratio, 1, 1).data.slice(0, 3)];
  const colour = (kind) => [1, 3, 5].map((i) => parseInt(palette[kind].slice(i, i + 2), 16));
  const blocks = Array.from({ length: runs[0].n }, (_, i) => i + 1);
  return [blocks.map((b) => times.map((t) => at(figure.x(t), figure.y(b)))),
    Object.fromEntries(KINDS.map((kind) => [kind, colour(kind)]))];
})(%s)"""
# Names and rectangles of the row, in their order, the net forces and the limits.
RECTANGLES_OF_ROW = """(() => {
  const made = [], { fillText, strokeRect, fillRect } = CanvasRenderingContext2D.prototype;
  const noted = (kind) => (...given) => made.push([kind, ...given]);
  Object.assign(CanvasRenderingContext2D.prototype,
    { fillText: noted("name"), strokeRect: noted("limit"), fillRect: noted("force") });
  DRAW.row();
  Object.assign(CanvasRenderingContext2D.prototype, { fillText, strokeRect, fillRect });
  const { net, strength } = frameAt(state.time);
  return [made, Array.from(net), Array.from(strength)];
})()"""


def of_page(slider):
    """A slider as solver.js takes it."""
    s = SLIDER | slider
    return {
        "blocks": s["n_blocks"],
        "theta": s["theta"],
        "normalLoad": s["normal_load"],
        "muS": s["mu_s"],
        "muK": s["mu_k"],
        "driveStiffness": s["drive_stiffness"],
        "driveVelocity": s["drive_velocity"],
        "mass": s["slider_mass"],
        "stiffness": s["youngs_modulus"] * s["cross_section"] / s["length"],
    }


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


def first_transitions(chain, duration, most):
    try:
        return simulate(chain, duration, max_transitions=most).transitions
    except TransitionLimitError as error:
        return error.run.transitions


def run_in(page, cases):
    """Transitions of (slider, duration, most transitions) as solver.js finds them."""
    asked = json.dumps([[of_page(slider), duration, most] for slider, duration, most in cases])
    solver = (SOURCE / "solver.js").read_text(encoding="utf-8").replace('"use strict";', "")
    return page.evaluate(SOLVE % (solver, asked))


@pytest.fixture
def page(opened, file):
    """The page as it opens on a desktop; it must not complain, and ask the network for nothing."""
    yield show(opened, file)
    opened.prefer()
    assert opened.complaints == []
    asked = {request.split("#")[0] for request in opened.requests if not request.startswith("blob:")}
    assert asked == {file.as_uri()}


@pytest.fixture(params=[DESKTOP, PHONE], ids=["desktop", "phone"])
def any_page(request, page, file):
    """The same on a desktop and on a phone."""
    return show(page, file, *request.param)


def show(page, file, width=DESKTOP[0], height=DESKTOP[1], address=""):
    page.open(f"{file.as_uri()}{address}", width, height)
    page.wait_for(SETTLED)
    return page


def text(page, name):
    return page.evaluate(f"document.getElementById({name!r}).innerText").replace("\n", "")


def click(page, selector):
    page.evaluate(f"document.querySelector({selector!r}).click()")
    page.wait_for(SETTLED)
    page.settle()


def set_slider(page, selector, position, release=True):
    kinds = ["input", "change"] if release else ["input"]
    page.evaluate(
        f"(e => {{ e.value = {position}; for (const kind of {kinds}) "
        f"e.dispatchEvent(new Event(kind, {{bubbles: true}})); }})(document.querySelector({selector!r}))"
    )
    if release:
        page.wait_for(SETTLED)


def open_all(page):
    page.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    page.wait_for("element('loads').children.length")


# The solver


@pytest.mark.parametrize("scene", THETAS)
def test_every_transition_is_the_proved_one(opened, scene):
    reference = pd.read_csv(GOLDEN / f"reference_{scene}.csv")
    ((time, block, mode, load),) = run_in(opened, [({"theta": THETAS[scene]}, 10.0, 10**6)])
    assert block == reference["block"].tolist()
    assert mode == reference["mode"].tolist()
    run = simulate(Chain.from_slider(theta=THETAS[scene]), until="global slip")
    first = slice(len(run.transitions))
    assert np.abs(np.array(time) - reference["time_s"])[first].max() < UP_TO_GLOBAL_SLIP
    assert np.abs(np.array(load) - reference["tangential_load_N"])[first].max() < 80 * UP_TO_GLOBAL_SLIP


def test_fifty_random_sliders_move_as_in_the_kernel(opened):
    rng = np.random.default_rng(2010)
    sliders = [random_slider(rng) for _ in range(50)]
    chains = [Chain.from_slider(**slider) for slider in sliders]
    durations = [5 * chain.normal_load / chain.loading_rate for chain in chains]
    found = run_in(opened, [(s, duration, 200) for s, duration in zip(sliders, durations, strict=True)])
    for chain, duration, (time, block, mode, _) in zip(chains, durations, found, strict=True):
        run = first_transitions(chain, duration, 200)
        assert block[:200] == run["block"].tolist()
        assert mode[:200] == run["mode"].tolist()
        assert time[:200] == pytest.approx(run["time"], rel=OF_RANDOM_CHAINS)


def test_the_chains_that_are_called_proved_move_as_in_the_kernel_up_to_the_first_global_slip(opened):
    config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    sliders = [proved_slider(values) for values in config["accuracy"]["proved"].values()]
    assert all(scene_slider(config, scene) in sliders for scene in THETAS)
    runs = [simulate(Chain.from_slider(**slider), until="global slip").transitions for slider in sliders]
    found = run_in(opened, [(slider, 10.0, len(run)) for slider, run in zip(sliders, runs, strict=True)])
    assert len(found) == 8
    for run, (time, block, mode, _) in zip(runs, found, strict=True):
        assert (block, mode) == (run["block"].tolist(), run["mode"].tolist())
        assert np.abs(np.array(time) - run["time"]).max() < UP_TO_GLOBAL_SLIP


# The file


def test_the_page_is_one_small_file_that_names_no_other_and_holds_the_sliders(file):
    page = file.read_text(encoding="utf-8")
    assert len(page.encode()) < MOST_BYTES
    assert "src=" not in page.replace("script-src", "").replace("worker-src", "")
    assert "a <!--<script>" not in page
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page)
    thetas = [scene["slider"]["theta"] for scene in json.loads(data)["scenes"]]
    assert (thetas, json.loads(data)["duration"]) == (list(THETAS.values()), 10.0)


def test_the_events_of_fig_13_are_the_counted_rows_of_the_slip_table():
    events = counted_events(pd.read_csv(GOLDEN / "fig10_slips.csv"))
    assert (len(events), events[0], events[-1][2]) == (9, [0.35, 28.0, 0.1], 1.0)


# Numbers, steps, sliders


def test_the_page_opens_with_the_papers_numbers(any_page):
    assert text(any_page, "answers").startswith("9 events counted in Fig. 13 · μsapp = 0.4858")
    assert "first global slip at 2.739 s · ✓ proved" in text(any_page, "answers")


def test_each_step_shows_what_it_speaks_of(any_page):
    shown = {}
    for step in range(1, 6):
        click(any_page, f'[data-step="{step}"]')
        assert any_page.evaluate("document.querySelector('[data-step][aria-pressed=true]').innerText") == str(
            step
        )
        shown[step] = any_page.evaluate("[event().front, event().isGlobal, state.slider.theta, runs.length]")
        # At theta = -5/6 all blocks slide in an event that is no global slip: never all at the same instant.
        assert text(any_page, "answers").startswith(
            f"{COUNTED[any_page.evaluate('state.slider.theta')]} events"
        )
    assert shown[1] == [4, False, 0, 1]
    assert shown[2][0] > shown[1][0]
    assert shown[3] == [10, True, 0, 1]
    assert shown[4][2] == THETAS["fig11"]
    assert shown[5][1:] == [True, THETAS["fig12"], 2]


def test_the_second_run_leaves_the_first_where_two_runs_of_the_library_part(page):
    click(page, '[data-step="5"]')
    chain = Chain.from_slider(theta=THETAS["fig12"])
    loads = np.array(chain.weights) * np.r_[1 + 1e-6, np.ones(9)]
    other = Chain.from_slider(weights=loads)
    a, b = (find_slips(simulate(c, 10.0)) for c in (chain, other))
    rows = range(min(len(a), len(b)))
    apart = next(i for i in rows if a.front[i] != b.front[i] or abs(a.load_after[i] - b.load_after[i]) > 1.0)
    assert f"Until {a.onset[apart]:.2f} s you cannot tell" in text(page, "step")


@pytest.mark.parametrize(
    ("slider", "position", "changed"),
    [
        ("#mu_k", 0.3, {"mu_k": 0.3}),
        *(("#n_blocks", n, {"n_blocks": n}) for n in (1, 2, 20)),
        ("[data-load]", 80, {"weights": [80.0] + 9 * [40.0]}),
    ],
)
def test_a_slider_solves_as_the_library_does(page, slider, position, changed):
    click(page, "#loads-part summary")
    set_slider(page, slider, position)
    chain = Chain.from_slider(**changed)
    slips = find_slips(simulate(chain, until="global slip"))
    told = text(page, "answers")
    assert f"{len(find_precursors(slips))} events counted" in told
    assert f"μsapp = {slips.load_before.max() / chain.normal_load:.4f}" in told
    assert f"first global slip at {slips.onset.iloc[-1]:.3f} s" in told
    assert "proved" not in told
    assert text(page, "theta-value") == ("by hand" if "weights" in changed else "0")


def test_kinetic_friction_pushes_static_friction_only_as_long_as_it_is_above(page):
    for position, mu_s in ((0.9, "0.90"), (0.3, "0.70")):
        set_slider(page, "#mu_k", position, release=False)
        assert text(page, "mu_s-value") == mu_s


def test_a_run_that_meets_the_limit_of_transitions_says_so_and_ends_there(page):
    set_slider(page, "#mu_k", 0.7)
    end = page.evaluate("runs[0].end")
    assert end < 1.0
    assert f"Stopped after 200,000 transitions at {end:.3f} s. No global slip until then" in text(
        page, "answers"
    )
    assert page.evaluate("runs[0].arrays.time.at(-1)") == end
    assert page.evaluate("view().end") < 1.1 * end


def test_a_drag_at_forty_blocks_drops_what_is_outdated(page):
    set_slider(page, "#n_blocks", 40)
    drawn = page.evaluate(
        "new Promise(done => { const seen = new Set(); let moves = 0; const move = () => {"
        "seen.add(document.body.dataset.drawn); if (++moves > 60) return done(seen.size);"
        "const e = document.getElementById('theta'); e.value = (moves % 9) / 50;"
        "e.dispatchEvent(new Event('input', {bubbles: true})); setTimeout(move, 16); }; move(); })"
    )
    set_slider(page, "#theta", 0)
    assert 1 < drawn < 60


# Looking closer


def test_a_click_in_fig_13_looks_into_the_event(any_page):
    any_page.evaluate("document.getElementById('lengths').scrollIntoView({block: 'center'})")
    x, y = any_page.evaluate(
        "(box => [box.left + marks[15][0], box.top + marks[15][1]])"
        "(element('lengths').getBoundingClientRect())"
    )
    any_page.click(x, y)
    any_page.wait_for("motions.has(15)")
    assert "global slip: blocks 1 to 10 slide for" in text(any_page, "readout")
    start, end = any_page.evaluate("[view().start, view().end]")
    assert 2.739 < start < end < 2.741


def test_the_row_of_blocks_moves_as_the_library_says(page):
    run = simulate(Chain.from_slider(), 3.0)
    slip = find_slips(run).query("is_global").iloc[0]
    click(page, '[data-step="3"]')
    for share in (0.0, 0.25, 0.8):
        time = slip.onset + share * (slip.end - slip.onset)
        page.evaluate(f"state.time = {time}; redraw('row')")
        page.wait_for("motions.has(state.event)")
        page.settle()
        shifts = np.array(page.evaluate(f"frameAt({time}).shifts"))
        positions = run.at([time])[0][0]
        assert shifts - shifts[-1] == pytest.approx(positions - positions[-1], abs=2e-7)


def test_in_the_slips_over_time_a_block_has_a_bar_while_it_slides(page):
    run = simulate(Chain.from_slider(), 3.0)
    for step, forward in ((1, "partial"), (3, "global")):
        click(page, f'[data-step="{step}"]')
        page.evaluate("state.view = 'event'")
        start, end = page.evaluate("[view().start, view().end]")
        times = np.linspace(start, end, 202)[1:-1]
        # A bar is wider than its slide by a pixel or two: times next to a transition do not count.
        apart = abs(times[:, None] - run.transitions["time"]).min(axis=1)
        times = times[apart > (end - start) / 300]
        seen, colours = page.evaluate(PIXELS_OF_BARS % times.tolist())
        names = {tuple(colour): kind for kind, colour in colours.items()}
        for block, pixels in enumerate(seen, start=1):
            rows = run.transitions[run.transitions["block"] == block]
            modes = np.append(0, rows["mode"])[np.searchsorted(rows["time"], times)]
            expected = [{0: None, 1: forward, -1: "backward"}[mode] for mode in modes]
            assert [names.get(tuple(pixel)) for pixel in pixels] == expected
            assert block > 4 or forward in expected


def test_the_bars_of_the_row_are_net_forces_within_their_limits(page):
    click(page, '[data-step="1"]')
    drawn, net, strength = page.evaluate(RECTANGLES_OF_ROW)
    limits = [k for k, (kind, *_) in enumerate(drawn) if kind == "limit"]
    assert len(limits) == 10
    for k, force, limit in zip(limits, net, strength, strict=True):
        (_, x, y, width, height), (_, *bar) = drawn[k], drawn[k + 1]
        share = force / limit * height / 2
        assert bar == pytest.approx([x, y + height / 2 - max(share, 0.0), width, abs(share)])
        assert height / drawn[limits[0]][4] == pytest.approx(limit / strength[0])
    places = np.array([drawn[k][1] + drawn[k][3] / 2 for k in limits])
    pitch = places[1] - places[0]
    assert np.diff(places) == pytest.approx(pitch)
    names = {text: x for kind, text, x, *_ in drawn if kind == "name"}
    assert max(abs(names[k + 1] - place) for k, place in enumerate(places)) < pitch / 2
    assert max(abs(force) for force in net) > 1.0


# Measurements


def test_a_measurement_with_decimal_commas_is_laid_over_the_curve(page, tmp_path):
    own = tmp_path / "own.csv"
    own.write_text("Zeit;Kraft\n0,0;0,0\n1,5;120,5\n", encoding="utf-8")
    before = page.evaluate("element('load').toDataURL()")
    page.choose_file("#own", own)
    page.wait_for("own")
    page.settle()
    assert page.evaluate("own.load") == [0, 120.5]
    assert text(page, "told") == "2 points from 0 s to 1.5 s."
    assert page.evaluate("element('load').toDataURL()") != before
    own.write_text("0;1\n1;x<b>\n", encoding="utf-8")
    page.choose_file("#own", own)
    page.wait_for("element('told').innerText.includes('Line')")
    assert text(page, "told") == "Line 2: “x<b>” is not a number."
    assert page.evaluate("own.load") == [0, 120.5]


# Address, command, picture


@pytest.mark.parametrize(
    "address",
    [
        "#theta=<img src=x onerror=alert(1)>&step=<b>&view=<script>,2&event=<i>&loads=<u>,1",
        "#theta=7&n_blocks=4000&mu_s=-1&drive_velocity=NaN&event=1e99&step=9&view=5,1",
        "#%%%",
    ],
)
def test_what_makes_no_sense_in_the_address_is_ignored(opened, file, address):
    show(opened, file, address=address)
    assert opened.evaluate("state.slider.theta") == 0
    assert opened.evaluate("document.querySelectorAll('img, #step b, #step i').length") == 0
    assert opened.complaints == []


def test_a_title_with_markup_stays_text(page):
    click(page, '[data-step="4"]')
    titles = page.evaluate("[...document.querySelectorAll('[data-scene]')].map(b => b.title)")
    assert sorted(titles) == [f"{name} a <!--<script>\"'" for name in sorted(THETAS)]


def test_the_command_draws_the_run_of_the_page(page, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    set_slider(page, "#theta", -0.4)
    set_slider(page, "#drive_velocity", -3)
    command = shlex.split(page.evaluate("command()"))
    assert command[:2] == ["precursors", "plot"]
    assert cli.main(["simulate", *command[2:], "--until-global-slip", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert f"μsapp = {told['mu_sapp']:.4f}" in text(page, "answers")


def test_save_picture_makes_one_png_of_all_figures(page):
    page.evaluate("HTMLAnchorElement.prototype.click = function () { window.saved = this.href; }")
    click(page, "#picture")
    size = page.evaluate(
        "new Promise(done => { const image = new Image(); image.src = saved;"
        "image.onload = () => done([image.width, image.height]); })"
    )
    heights = page.evaluate("['row', 'load', 'slips', 'lengths'].map(n => element(n).height)")
    assert size[1] == sum(heights)


# Everybody


def test_the_phone_shows_the_row_and_the_sliders_together(opened, file):
    show(opened, file, *PHONE)
    boxes = opened.evaluate(
        "['row', 'play', 'sliders'].map(name => element(name).getBoundingClientRect())"
        ".map(box => [box.top, box.bottom])"
    )
    (row_top, row), (play_top, play), (sliders_top, sliders) = boxes
    assert 0 <= row_top < row <= play_top < play <= sliders_top < sliders <= PHONE[1]
    assert opened.evaluate("document.documentElement.scrollWidth") <= PHONE[0]


def test_whatever_a_finger_meets_is_large_enough(opened, file):
    show(opened, file, *PHONE)
    open_all(opened)
    small = opened.evaluate(
        "[...document.querySelectorAll('button, input:not([type=file]), summary, .file')]"
        ".filter(e => e.offsetParent && !e.closest('p .word'))"  # words in a sentence may be smaller
        f".filter(e => e.offsetWidth < {TARGET} || e.offsetHeight < {TARGET}).map(e => e.outerHTML)"
    )
    assert small == []


def test_the_keyboard_reaches_everything_in_the_order_of_the_page(page):
    everything = page.evaluate(
        "[...document.querySelectorAll('button, input, summary')]"
        ".filter(e => e.checkVisibility() && !e.disabled).length"
    )
    order = []
    for _ in range(everything):
        page.press("Tab")
        order.append(page.evaluate("[...document.querySelectorAll('*')].indexOf(document.activeElement)"))
    assert order == sorted(set(order))
    assert len(order) >= everything - 1  # the file is hidden in a closed part


def test_arrow_keys_go_from_event_to_event_and_space_plays(page):
    for key, expected in (("ArrowRight", 5), ("ArrowRight", 6), ("ArrowLeft", 5)):
        page.press(key)
        page.settle()
        assert text(page, "readout").startswith(f"Event {expected} of 60")
    page.press(" ")
    assert page.evaluate("playing !== null")
    page.press(" ")
    assert page.evaluate("playing === null")


def test_a_symbol_explains_itself_on_focus_and_escape_hides_that(page):
    tip = "document.querySelector('#tip-theta').checkVisibility()"
    assert not page.evaluate(tip)
    page.evaluate("document.querySelector('[aria-describedby=tip-theta]').focus()")
    assert page.evaluate(tip)
    page.press("Escape")
    assert not page.evaluate(tip)


def test_every_figure_and_control_has_a_name(page):
    open_all(page)
    nameless = page.evaluate(
        "[...document.querySelectorAll('canvas, button, input')].filter(e =>"
        "!(e.getAttribute('aria-label') || e.innerText || e.closest('label')?.innerText))"
        ".map(e => e.outerHTML)"
    )
    assert nameless == []


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
def test_the_contrast_is_that_of_wcag_aa(page, scheme):
    page.prefer(prefers_color_scheme=scheme)
    page.settle()
    texts, marks = page.evaluate(CONTRASTS)
    assert len(texts) > 30
    assert [found for found in texts if found[0] < TEXT_CONTRAST] == []
    assert [found for found in marks if found[0] < MARK_CONTRAST] == []
