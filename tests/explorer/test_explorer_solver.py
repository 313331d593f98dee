"""The page's solver gives the transitions of the library."""

import json

import numpy as np
import pytest
from explorer.example import SOURCE, THETAS
from settings import CONFIG

from maegawa2010.explorer.data import proved_slider
from maegawa2010.scenes import scene_slider
from precursors import Chain, find_slips, simulate
from precursors.model.chain import SLIDER
from precursors.solver.simulate import TransitionLimitError

# Largest relative error of a time.
TIME = 1e-9
# Of random chains; errors grow with the chaos of the motion.
MOST_TRANSITIONS = 200

SOLVE = """(() => {
  %s
  return %s.map(([slider, most]) => {
    const run = newRun(chainOf(slider), 1e9);
    for (const _ of solve(run)) if (run.time.length >= most) break;
    const fronts = run.events.map((event) => event.front);
    return [run.time, run.block, run.mode, fronts].map((list) => list.slice(0, most));
  });
})()"""


def random_slider(rng):
    """A slider with values from the whole ranges of the page."""
    mu_s = rng.uniform(0.2, 1.5)
    return {
        "n_blocks": int(rng.integers(1, 41)),
        "theta": rng.uniform(-0.98, 0.98),
        "mu_s": mu_s,
        "mu_k": mu_s * rng.choice([0.0, rng.uniform(0, 0.98)]),
        "drive_stiffness": 10 ** rng.uniform(4, 8),
        "drive_velocity": 10 ** rng.uniform(-6, -1),
    }


def first_transitions(slider):
    """A run of the library with at most `MOST_TRANSITIONS`."""
    try:
        chain = Chain.from_slider(**slider)
        return simulate(chain, 1e9, max_transitions=MOST_TRANSITIONS)
    except TransitionLimitError as error:
        return error.run


def test_random_and_proved_sliders_move_as_in_the_library(page):
    rng = np.random.default_rng(2010)
    random = [random_slider(rng) for _ in range(50)]
    proved = [proved_slider(values) for values in CONFIG["horizon"]["proved"].values()]
    assert all(scene_slider(CONFIG, scene) in proved for scene in THETAS)
    runs = [first_transitions(slider) for slider in random]
    for slider in proved:
        runs.append(simulate(Chain.from_slider(**slider), until="global slip"))
    asked = [
        (SLIDER | slider, len(run.transitions))
        for slider, run in zip(random + proved, runs, strict=True)
    ]
    solver = (SOURCE / "solver.js").read_text(encoding="utf-8")
    columns = page.evaluate(
        SOLVE % (solver.replace('"use strict";', ""), json.dumps(asked))
    )
    for run, (time, block, mode, fronts) in zip(runs, columns, strict=True):
        assert block == run.transitions["block"].tolist()
        assert mode == run.transitions["mode"].tolist()
        assert time == pytest.approx(run.transitions["time"], rel=TIME)
        assert fronts == find_slips(run).dropna()["front"].tolist()
