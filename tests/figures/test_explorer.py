"""The explorer solves the paper's scenes as they are proved, and a browser shows it, with no network."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from browser import browser, find_browser

pytest.importorskip("bokeh", reason="Bokeh (the extra explorer) is not installed")

from precursors import Chain, simulate
from precursors.figures.explorer.page import Scene, write_explorer
from precursors.model.scenes import SLIDER

GOLDEN = Path(__file__).parents[1] / "golden"
MOST_BYTES = 1.5e6
# Errors of times [s] up to the end of the first global slip; later they grow with the chaos of the motion.
UP_TO_GLOBAL_SLIP = 1e-10
NARROW = 390  # px, a telephone

THETAS = {"fig10": 0.0, "fig11": -5 / 6, "fig12": 5 / 6}
READY = "document.body.dataset.ready"
WINDOW = "(r => [r.start, r.end])(Bokeh.documents[0].get_model_by_name('window'))"
PIXEL_OF = """((name, x, y) => {
  const view = Bokeh.index.find_one(Bokeh.documents[0].get_model_by_name(name));
  const box = view.canvas_view.el.getBoundingClientRect();
  return [box.left + view.frame.x_scale.compute(x), box.top + view.frame.y_scale.compute(y)];
})"""
RUN = """(() => {
  const p = %s;
  const run = simulate(chainOf({blocks: p.n_blocks, theta: p.theta, normalLoad: p.normal_load, muS: p.mu_s,
    muK: p.mu_k, driveStiffness: p.drive_stiffness, driveVelocity: p.drive_velocity, mass: p.slider_mass,
    stiffness: p.youngs_modulus * p.cross_section / p.length}), 10);
  return [run.time, run.block, run.mode, run.load, run.events.find((e) => e.isGlobal).end];
})()"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("explorer") / "explorer.html"
    scenes = [Scene(name, "a <!--<script>", SLIDER | {"theta": theta}) for name, theta in THETAS.items()]
    write_explorer(scenes, 10.0, path)
    return path


@pytest.fixture(scope="module")
def loaded(file):
    path = find_browser()
    if path is None:
        pytest.skip("no Chromium or Chrome here: the explorer is not tried in a browser")
    with browser(path) as new_page:
        page = new_page()
        page.open(file.as_uri())
        page.wait_for(READY)
        yield page


@pytest.fixture
def page(loaded):
    """The page with the first scene and the whole run in view; it must not complain."""
    loaded.evaluate("document.querySelector('[data-scene=fig10]').click()")
    loaded.evaluate("document.getElementById('whole').click()")
    loaded.settle()
    yield loaded
    assert loaded.complaints == []


def answers(page):
    return page.evaluate("document.getElementById('answers').textContent")


def readout(page):
    return page.evaluate("document.getElementById('readout').textContent")


def move_slider(page, name, value):
    page.evaluate(f"document.getElementById('{name}').value = {value}")
    page.evaluate(f"document.getElementById('{name}').dispatchEvent(new Event('input'))")
    page.settle()


@pytest.mark.parametrize("scene", THETAS)
def test_every_transition_is_the_proved_one(page, scene):
    reference = pd.read_csv(GOLDEN / f"reference_{scene}.csv")
    slider = json.dumps(SLIDER | {"theta": THETAS[scene]})
    time, block, mode, load, end = page.evaluate(RUN % slider)
    assert block == reference["block"].tolist()
    assert mode == reference["mode"].tolist()
    first = reference["time_s"] <= end
    assert np.abs(np.array(time) - reference["time_s"])[first].max() < UP_TO_GLOBAL_SLIP
    assert np.abs(np.array(load) - reference["tangential_load_N"])[first].max() < 80 * UP_TO_GLOBAL_SLIP


def test_the_page_is_one_small_file_that_names_no_other(file):
    text = file.read_text(encoding="utf-8")
    assert len(text.encode()) < MOST_BYTES
    assert "src=" not in text.replace("script-src", "").split("<script>")[0]
    assert "a &lt;!--&lt;script&gt;" in text
    assert "<!--" not in text.split("</style>")[-1].replace("&lt;!--", "")


def test_the_page_asks_the_network_for_nothing(page, file):
    assert {request.split("#")[0] for request in page.requests} == {file.as_uri()}


def test_the_page_opens_with_the_papers_numbers_and_a_scene_changes_them(page):
    assert answers(page).startswith("9 events counted in Fig. 13, \u03bcsapp = 0.4858")
    page.evaluate("document.querySelector('[data-scene=fig12]').click()")
    page.settle()
    assert answers(page).startswith("14 events counted in Fig. 13, \u03bcsapp = 0.4883")
    assert page.evaluate("document.querySelector('[aria-pressed=true]').dataset.scene") == "fig12"


def test_a_slider_solves_anew_as_the_library_does(page):
    move_slider(page, "mu_k", 0.3)
    run = simulate(Chain.from_slider(mu_k=0.3), 10.0)
    assert page.evaluate("document.getElementById('mu_k-value').textContent") == "0.3"
    time = page.evaluate("Bokeh.documents[0].get_model_by_name('onsets').data.onset")
    assert time[0] == pytest.approx(run.transitions["time"][0], abs=UP_TO_GLOBAL_SLIP)
    assert page.evaluate("document.querySelector('[aria-pressed=true]')") is None


@pytest.mark.parametrize("n_blocks", [1, 2, 20])
def test_any_number_of_blocks_can_be_chosen(page, n_blocks):
    move_slider(page, "n_blocks", n_blocks)
    run = simulate(Chain.from_slider(n_blocks=n_blocks), until="global slip")
    assert f"first global slip at {run.transitions['time'][-1]:.2f}"[:-1] in answers(page)


def test_the_buttons_begin_with_the_first_event_and_go_on(page):
    for button, expected in (("next", 1), ("next", 2), ("previous", 1)):
        page.evaluate(f"document.getElementById({button!r}).click()")
        page.settle()
        assert readout(page).startswith(f"Event {expected} of 60")


def test_a_click_in_fig_13_looks_into_the_event(page):
    page.click(*page.evaluate(f"{PIXEL_OF}('lengths', 194.31, 1)"))
    page.settle()
    assert "global slip: onset 2.739" in readout(page)
    start, end = page.evaluate(WINDOW)
    assert 2.73 < start < end < 2.75
    velocities = page.evaluate("Bokeh.documents[0].get_model_by_name('profile source').data.velocity")
    assert len(velocities) == 10


def test_a_change_of_scene_keeps_the_zoom(page):
    page.evaluate("document.getElementById('first').click()")
    page.settle()
    before = page.evaluate(WINDOW)
    page.evaluate("document.querySelector('[data-scene=fig11]').click()")
    page.settle()
    assert page.evaluate(WINDOW) == before


def test_the_address_holds_the_state(page, file):
    move_slider(page, "theta", 0.25)
    page.evaluate("document.getElementById('next').click()")
    page.settle()
    told, address = (answers(page), readout(page)), page.evaluate("location.href")
    page.open(address)
    page.wait_for(READY)
    assert (answers(page), readout(page)) == told


def test_the_page_fits_a_telephone(page, file):
    page.open(file.as_uri(), NARROW, 844)
    page.wait_for(READY)
    assert page.evaluate("document.documentElement.scrollWidth") <= NARROW
    page.open(file.as_uri())
    page.wait_for(READY)
