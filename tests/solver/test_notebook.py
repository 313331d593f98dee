"""What a notebook shows of a run: its numbers, and the load as a small picture."""

import re
import xml.etree.ElementTree as ET

from precursors import Chain, LargerChain, simulate
from precursors.solver.notebook import HEIGHT, WIDTH


def test_a_run_shows_its_numbers_and_its_load():
    run = simulate(Chain.from_slider(theta="-5/6"))
    page = ET.fromstring(run._repr_html_())
    text = "".join(page.itertext())
    largest = run.transitions["tangential_load"].max()
    assert "Run of 10 s: 1871 transitions of 10 blocks under F_Z = 400 N" in text
    assert f"largest F_X = {largest:.1f} N" in text
    points = page.find(".//polyline").get("points")
    x = WIDTH * run.transitions["time"] / 10
    y = HEIGHT * (1 - run.transitions["tangential_load"] / largest)
    drawn = {f"{a:.1f},{b:.1f}" for a, b in zip(x.round(1), y.round(1), strict=True)}
    assert drawn | {f"0.0,{HEIGHT}.0"} == set(points.split())


def test_a_calm_run_and_a_larger_one_have_a_page_as_well():
    calm = simulate(Chain.from_slider(), 0.1)._repr_html_()
    assert ET.fromstring(calm).find(".//polyline").get("points") == f"0.0,{HEIGHT}.0"
    larger = simulate(LargerChain(Chain.from_slider(), 0.02), 1.0)
    assert re.search(r"SteppedRun of 1 s: \d+ transitions", larger._repr_html_())
