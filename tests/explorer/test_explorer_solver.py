"""The page's solver finds the transitions that the library finds."""

import json
from pathlib import Path

import numpy as np
import pytest
from explorer.explorer_sessions import THETAS
from settings import CONFIG

from maegawa2010.explorer.page import proved_slider
from maegawa2010.scenes import scene_slider
from precursors import Chain, simulate
from precursors.benchmark.score import solution
from precursors.model.chain import SLIDER
from precursors.solver.simulate import TransitionLimitError

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src/maegawa2010/explorer"

# Errors of times [s] up to the end of the first global slip; later they grow with the
# chaos of the motion.
UP_TO_GLOBAL_SLIP = 1e-10
# Largest relative error of a time of the random chains, in their first 200 transitions.
OF_RANDOM_CHAINS = 1e-9

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
    problem = {"fig10": "uniform", "fig11": "trailing", "fig12": "leading"}[scene]
    true = solution(problem).run.transitions
    ((time, block, mode, load),) = run_in(
        page, [({"theta": THETAS[scene]}, 10.0, 10**6)]
    )
    assert block == true["block"].tolist()
    assert mode == true["mode"].tolist()
    run = simulate(Chain.from_slider(theta=THETAS[scene]), until="global slip")
    first = slice(len(run.transitions))
    assert np.abs(np.array(time) - true["time"])[first].max() < UP_TO_GLOBAL_SLIP
    assert (
        np.abs(np.array(load) - true["tangential_load"])[first].max()
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
    sliders = [proved_slider(values) for values in CONFIG["horizon"]["proved"].values()]
    assert all(scene_slider(CONFIG, scene) in sliders for scene in THETAS)
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
