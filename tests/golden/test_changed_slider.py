"""With another slider the paper, the captions and the explorer say nothing that their tables contradict."""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path
from typing import Any

import evaluate_claims
import pytest
import simulate_scene
import tabulate_measures
import tabulate_mu_sapp
import tabulate_slips
import tabulate_trace
from pdf_text import pages_of
from test_written_paper import CONFIG, ROOT, change, here, write  # noqa: F401

from precursors import find_precursors, find_slips, simulate
from precursors.figures.explorer.page import Scene, write_explorer
from precursors.model.scenes import scene_chain, scene_slider

SCENES = ("fig11", "fig10", "fig12")
# Another value for each parameter.
CHANGES = {
    "n_blocks": 12,
    "mu_s": 0.72,
    "mu_k": 0.46,
    "normal_load": 440.0,  # of scenes without load cells: those of the paper stay as they are
    "drive_stiffness": 1e6,
    "drive_velocity": 2e-4,
    "slider_mass": 0.02,
    "youngs_modulus": 3e9,
    "cross_section": 120e-6,
    "length": 0.09,
}
# Words that only the paper's slider makes true.
OF_THE_PAPER = (
    "those of the paper (Sect. 4)",
    "prove the order",
    "confirms the transitions",
    "of the three scenes up to",
    "The order of all transitions is proved",
)
# A conclusion of the text, and a change of a table that contradicts it: table, column, value, rows.
CONCLUSIONS: tuple[tuple[str, tuple[str, str, object, dict[str, object]]], ...] = (
    ("rests on one draw", ("robustness", "class", "robust", {"scene": "fig12"})),
    ("of the three scenes up to", ("certificates", "proved_until_s", 9.0, {"chain": "uniform"})),
    ("does not round to", ("mu_sapp", "mu_sapp", 0.491, {"scene": "fig11", "is_papers": True})),
    ("sequence is right at the finest", ("step_sweep", "transitions_right", 3, {"scene": "fig10"})),
    ("So it may be luck", ("step_sweep", "transitions_right", 338, {"scene": "fig12"})),
    ("does not mean a right run", ("step_sweep", "events_counted", 1, {"method": "rk4_skip"})),
    ("no wave is needed", ("model_comparison", "error", 0.2, {"model": "overdamped"})),
    ("has no single value", ("spread", "q95", 0.48, {"scene": "fig12", "question": "theta"})),
    ("is a low draw", ("spread", "q50", 0.48, {"scene": "fig12", "question": "theta"})),
    ("To half a unit", ("resolution_limits", "a", 0.46, {"quantity": "mu_sapp"})),
    ("becomes the same", ("resolution_limits", "a", 0.46, {"quantity": "mu_sapp"})),
    ("comes out with some number", ("resolution", "q50", 1, {"quantity": "events_counted"})),
    ("below the speed of sound", ("resolution_limits", "a", 9e9, {"quantity": "front_speed_m_per_s"})),
    ("These means do depend", ("long_runs_statistics", "mean", 0.5, {})),
    ("which is all of them", ("solver_vs_proof", "agreeing_transitions", 5, {"chain": "uniform"})),
)


def text_of(config: dict[str, Any]) -> str:
    for figure in Path("results/figures").glob("*.svg"):  # nobody looks at them here
        figure.write_text('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 16 9"/>', encoding="utf-8")
    return " ".join(pages_of(write(config))).replace("\xad", "")


def changed(**values: float) -> dict[str, Any]:
    config = copy.deepcopy(CONFIG)
    config["chain"] |= values
    return config


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("name", CONFIG["chain"])
def test_the_paper_says_what_another_slider_gives_and_that_it_is_another(name):
    config = changed(**{name: CHANGES[name]})
    for scene in SCENES:
        run = f"{scene}.h5"
        simulate_scene.main(scene_slider(config, scene), config["duration"], run)
        tabulate_slips.main(run, f"results/tables/{scene}_slips.csv")
        tabulate_trace.main(run, f"results/tables/{scene}_trace.csv")
    runs = {scene: f"{scene}.h5" for scene in SCENES}
    tabulate_measures.main(runs, "results/tables/measures.csv")
    tabulate_mu_sapp.main(runs, "results/tables/mu_sapp.csv")
    evaluate_claims.main("results/tables", "results/tables/claims.csv")
    text = text_of(config)

    found = [simulate(scene_chain(config, scene), config["duration"]) for scene in SCENES]
    slips = [find_slips(run) for run in found]
    counts = [len(find_precursors(own)) for own in slips]
    assert "Not the paper\N{RIGHT SINGLE QUOTATION MARK}s slider. The configuration has" in text
    said = json.loads(Path("results/numbers.json").read_text(encoding="utf-8"))["changed"]["value"]
    assert said.startswith(f"{name} = {CHANGES[name]:g} (paper: {CONFIG['chain'][name]:g})")
    assert "we find {}, {} and {}. It gives".format(*counts) in text
    assert "have {}, {} and {} transitions".format(*(len(run.transitions) for run in found)) in text
    if name != "normal_load":
        assert [words for words in OF_THE_PAPER[1:] if words in text] == []
        assert "They are not the scenes of this configuration" in text
    assert OF_THE_PAPER[0] not in text


@pytest.mark.usefixtures("here")
def test_a_conclusion_goes_when_a_table_contradicts_it():
    text = text_of(CONFIG)
    assert [words for words, _ in CONCLUSIONS if words not in text] == []
    assert [words for words in OF_THE_PAPER if words not in text] == []
    assert "Not the paper\N{RIGHT SINGLE QUOTATION MARK}s slider" not in text
    for _, (table, column, value, rows) in CONCLUSIONS:
        change(table, column, value, **rows)
    text = text_of(CONFIG)
    assert [words for words, _ in CONCLUSIONS if words in text] == []


def test_the_captions_of_the_report_have_no_number_of_the_slider():
    """0.49 is the experiment's; the picture of the mission is no words."""
    captions = [path.read_text(encoding="utf-8") for path in (ROOT / "workflow/report").glob("*.rst")]
    words = re.sub(r"<svg.*</svg>", "", "".join(captions), flags=re.DOTALL)
    assert set(re.findall(r"\d+\.\d+", words)) <= {"0.49"}


def test_the_explorer_starts_from_the_slider_of_the_configuration(tmp_path):
    config = changed(**CHANGES)
    sliders = [scene_slider(config, scene) for scene in SCENES]
    write_explorer([Scene("", slider, []) for slider in sliders], [], 10.0, tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page, flags=re.DOTALL)
    assert [scene["slider"] for scene in json.loads(data)["scenes"]] == sliders
