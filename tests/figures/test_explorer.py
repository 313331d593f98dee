"""The explorer holds exact data, and a browser shows it: loads, zooms, points and jumps, with no network."""

import json
import re

import numpy as np
import pytest
import write_explorer as script
from browser import browser, find_browser

from precursors import Chain, find_slips, simulate

pytest.importorskip("bokeh", reason="Bokeh (the extra explorer) is not installed")

from precursors.analysis.load_curve import TOLERANCE_N
from precursors.figures.explorer import Scene, write_explorer
from precursors.figures.explorer.detail import find_slides

MOST_BYTES = 6e6
# Next to the tolerance of the points: what interpolation between doubles at 3 s may add to 200 N.
ROUNDING_N = 1e-9
SHORTEST_WINDOW = 20e-6  # s

READY = "document.body.dataset.ready"
WINDOW = "(r => [r.start, r.end])(Bokeh.documents[0].get_model_by_name('window'))"
CURVE = "(d => [Array.from(d.time), Array.from(d.load)])(Bokeh.documents[0].get_model_by_name('curve').data)"
PIXEL_OF = """((name, x, y) => {
  const view = Bokeh.index.find_one(Bokeh.documents[0].get_model_by_name(name));
  const box = view.canvas_view.el.getBoundingClientRect();
  return [box.left + view.frame.x_scale.compute(x), box.top + view.frame.y_scale.compute(y)];
})"""
ALL_TEXT = """(() => {
  const texts = [];
  const walk = (node) => {
    if (node.nodeType === Node.TEXT_NODE) texts.push(node.textContent);
    if (node.nodeName === "STYLE" || node.nodeName === "SCRIPT") return;
    for (const child of [...(node.shadowRoot?.childNodes ?? []), ...node.childNodes]) walk(child);
  };
  walk(document.body);
  return texts.join(" ").replace(/\\s+/g, " ");
})()"""


@pytest.fixture(scope="module")
def scenes():
    thetas = {"even": 0.0, "leading": 5 / 6}
    return [
        Scene(name, f"{name} <loading>", theta, simulate(Chain.from_slider(theta=theta), 3.0))
        for name, theta in thetas.items()
    ]


@pytest.fixture(scope="module")
def file(scenes, tmp_path_factory):
    path = tmp_path_factory.mktemp("explorer") / "explorer.html"
    write_explorer(scenes, path)
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
    """The page as it is when it has loaded."""
    loaded.move(1, 1)
    loaded.evaluate("document.querySelector('[data-scene=even]').click()")
    loaded.settle()
    yield loaded
    assert loaded.complaints == []


def pixel(page, panel, x, y):
    return page.evaluate(f"{PIXEL_OF}({json.dumps([panel, float(x), float(y)])[1:-1]})")


def click_in(page, panel, x, y):
    page.click(*pixel(page, panel, x, y))
    page.settle()


def drawn_deviation(page, run):
    """Largest deviation of the drawn curve from the run, inside the window [N]."""
    start, end = page.evaluate(WINDOW)
    times, loads = page.evaluate(CURVE)
    assert times[0] <= start < end <= times[-1]
    inside = np.linspace(start, end, 2001)
    return np.abs(np.interp(inside, times, loads) - run.tangential_load(inside)).max()


def test_slides_are_what_lies_between_the_transitions_of_a_block(scenes):
    run = scenes[1].run
    slides = find_slides(run, find_slips(run)["onset"].to_numpy())
    assert len(slides) == (run.transitions["mode"] != 0).sum()
    middle = (slides["start"] + slides["end"]).to_numpy() / 2
    _, velocities = run.at(middle)
    moving = velocities[np.arange(len(slides)), slides["block"] - 1]
    assert (np.sign(moving) == slides["mode"]).all()
    assert (slides["mode"] == -1).any()


def test_the_page_is_one_small_file_that_names_no_other(file):
    text = file.read_text(encoding="utf-8")
    assert len(text.encode()) < MOST_BYTES
    assert "src=" not in text.replace("script-src", "").split("<script>")[0]
    assert "even &lt;loading&gt;" in text


def test_the_same_runs_give_the_same_bytes(scenes, file, tmp_path):
    write_explorer(scenes, tmp_path / "again.html")
    assert (tmp_path / "again.html").read_bytes() == file.read_bytes()


def test_the_workflows_script_writes_the_same_page(scenes, file, tmp_path):
    for scene in scenes:
        scene.run.save(tmp_path / f"{scene.name}.h5")
    script.main(
        [tmp_path / f"{scene.name}.h5" for scene in scenes],
        {scene.name: scene.title for scene in scenes},
        {scene.name: scene.theta for scene in scenes},
        tmp_path / "explorer.html",
    )
    assert (tmp_path / "explorer.html").read_bytes() == file.read_bytes()


def test_no_scene_is_refused(tmp_path):
    with pytest.raises(ValueError, match="at least one"):
        write_explorer([], tmp_path / "explorer.html")


def test_the_page_loads_and_asks_the_network_for_nothing(page, file):
    assert page.requests[-1] == file.as_uri()
    assert set(page.requests) == {file.as_uri()}
    assert page.evaluate(WINDOW) == [0, 3]


def test_the_wheel_zooms_from_the_whole_run_into_a_slip_and_the_curve_stays_exact(page, scenes):
    run = scenes[0].run
    slip = find_slips(run).query("is_global").iloc[0]
    middle = (slip.onset + slip.end) / 2
    load = run.tangential_load([middle])[0]
    page.evaluate("document.getElementById('growth').click()")
    widths = []
    for turns in range(100):
        page.settle()
        start, end = page.evaluate(WINDOW)
        widths.append(end - start)
        if end - start <= SHORTEST_WINDOW:
            break
        if turns % 10 == 0:
            assert drawn_deviation(page, run) <= TOLERANCE_N + ROUNDING_N
        # The pointer follows the slip, as a user's does: at first a pixel is longer than the slip.
        page.wheel(*pixel(page, "load", middle, load), -400)
    assert widths[-1] <= SHORTEST_WINDOW
    assert all(np.diff(widths) < 0)
    assert slip.onset < start < end < slip.end
    assert drawn_deviation(page, run) <= TOLERANCE_N + ROUNDING_N


def test_pointing_at_the_curve_tells_time_and_load(page, scenes):
    run = scenes[0].run
    page.move(*pixel(page, "load", 0.2, 20.0))
    page.wait_for(f"{ALL_TEXT}.includes('F_X')")
    told = re.search(r"t ?: ?([\d.]+) s F_X ?: ?([\d.]+) N", page.evaluate(ALL_TEXT))
    time, load = float(told[1]), float(told[2])
    assert time == pytest.approx(0.2, abs=3.0 / 500)
    assert load == pytest.approx(run.tangential_load([time])[0], abs=1e-4)


def test_a_click_on_an_event_of_fig_13_jumps_to_it_in_its_scene(page, scenes):
    slips = find_slips(scenes[1].run)
    number = int(slips["is_global"].argmax())
    event = slips.iloc[number]
    click_in(page, "lengths", event["load_before"], event["front"] / 10)
    start, end = page.evaluate(WINDOW)
    assert start < event["onset"] < event["end"] < end
    assert end - start < 2 * (event["end"] - event["onset"])
    readout = page.evaluate("document.getElementById('readout').textContent")
    assert f"Event {number + 1} of {len(slips)}, global slip" in readout
    assert page.evaluate("document.querySelector('[aria-pressed=true]').dataset.scene") == "leading"
    assert drawn_deviation(page, scenes[1].run) <= TOLERANCE_N + ROUNDING_N


def test_a_click_beside_every_event_of_fig_13_changes_nothing(page):
    click_in(page, "lengths", 20.0, 0.95)
    assert page.evaluate(WINDOW) == [0, 3]


@pytest.mark.parametrize("panel", ["load", "raster"])
def test_a_click_over_time_jumps_to_the_nearest_event(page, scenes, panel):
    event = find_slips(scenes[0].run).iloc[4]
    click_in(page, panel, event["onset"], {"load": event["load_before"], "raster": 3.0}[panel])
    start, end = page.evaluate(WINDOW)
    assert start < event["onset"] < event["end"] < end < start + 1e-3


def test_pointing_at_a_slide_tells_block_mode_load_and_length(page, scenes):
    run = scenes[1].run
    slips = find_slips(run)
    slides = find_slides(run, slips["onset"].to_numpy())
    slide = slides[slides["mode"] == -1].iloc[0]
    page.evaluate("document.querySelector('[data-scene=leading]').click()")
    page.settle()
    event = slips.iloc[int(slide["event"]) - 1]
    click_in(page, "raster", event["onset"], 5.0)
    page.move(*pixel(page, "raster", (slide["start"] + slide["end"]) / 2, float(slide["block"])))
    page.wait_for(f"{ALL_TEXT}.includes('backward')")
    text = page.evaluate(ALL_TEXT)
    assert f"block {int(slide['block'])} slides backward" in text.replace(": ", " ")
    assert f"{slide['load']:.4f} N" in text
    assert f"{event['front'] * 10:.1f} mm" in text


def test_the_buttons_step_from_event_to_event(page, scenes):
    onsets = find_slips(scenes[0].run)["onset"]
    first = int(np.searchsorted(onsets, 1.5))  # the middle of the window
    for button, expected in (("next", first), ("next", first + 1), ("previous", first)):
        page.evaluate(f"document.getElementById({button!r}).click()")
        page.settle()
        start, end = page.evaluate(WINDOW)
        inside = onsets[(onsets > start) & (onsets < end)]
        assert inside.index.tolist() == [expected]
