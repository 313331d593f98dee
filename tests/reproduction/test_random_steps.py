"""How often random steps of RK4 give the paper's six numbers."""

import numpy as np
import pandas as pd
import pytest
import yaml
from golden.regenerate import GOLDEN

from precursors import Chain
from precursors.methods.columns import SWITCHING_RULES, resting_mode, sliding_forward, system_of
from precursors.methods.fixed_step import march
from precursors.methods.rk4_located import run_located
from precursors.model.switching import COULOMB
from precursors.reproduction.random_steps import SIX, draws_table, random_steps_table, six_of_readings

SLIDER = yaml.safe_load((GOLDEN.parents[1] / "config.yaml").read_text(encoding="utf-8"))["chain"]
PAPERS = [6, 9, 14, 0.49, 0.49, 0.49]
READING = dict.fromkeys(("degree", "switching", "global_slip", "short", "front"), "one")


@pytest.mark.parametrize(
    ("rule", "stops", "is_released"),
    list(zip(SWITCHING_RULES, [[0, 0, -1], [0, -1, -1], [0, 0, 0]], [-1, -1, 0], strict=True)),
)
def test_what_a_force_backward_does_to_a_block_is_the_rule(rule, stops, is_released):
    """Forces below mu_k w, between mu_k w and mu_s w, and above mu_s w."""
    chain = Chain.from_slider(n_blocks=1, theta=0)
    state = sliding_forward(system_of(chain, rule), np.zeros(1))
    for force, mode in zip([-100.0, -200.0, -300.0], stops, strict=True):
        state.spring_force[1] = force
        assert resting_mode(system_of(chain, rule), state, 1) == mode
    state.mode[1] = 0
    assert resting_mode(system_of(chain, rule), state, 1) == is_released


@pytest.mark.parametrize("rule", SWITCHING_RULES)
def test_a_block_stops_as_the_rule_has_it(rule):
    """After a stop the block sticks or turns round; the force decides, with the limit of the rule."""
    chain = Chain.from_slider(theta="5/6")
    run = march(run_located, (), chain, 10.0, 1e-7, "global slip", rule=rule).run
    modes = np.zeros(chain.n_blocks + 2, int)
    turned = stuck = 0
    for block, mode in zip(run.transitions["block"], run.transitions["mode"], strict=True):
        turned += modes[block] * mode < 0
        stuck += mode == 0
        modes[block] = mode
    assert stuck > 0
    backward = (run.transitions["mode"] < 0).any()
    assert backward == (rule != "slides forward only")
    assert (turned > 0) == backward


def test_the_rule_of_the_solver_is_the_same_forward_and_backward():
    system = system_of(Chain.from_slider(), COULOMB)
    assert (system.backward == system.strength).all()
    assert (system.turning == system.strength).all()


def test_draws_that_are_the_papers_are_counted_with_an_interval():
    draws = pd.DataFrame([PAPERS, PAPERS, [6, 9, 15, 0.49, 0.47, 0.4999]], columns=SIX)
    definitions = pd.DataFrame(
        [{**READING, "theta": t, "events_counted": n, "mu_sapp": 0.48} for t, n in ((-1, 6), (0, 9), (1, 15))]
    )
    assert six_of_readings(definitions).to_numpy().tolist() == [[6, 9, 15, 0.48, 0.48, 0.48]]
    table = random_steps_table(draws.assign(degree="5/6", switching=COULOMB), definitions, PAPERS)
    found = table.set_index("question")
    assert found["k"].to_dict() == {
        **dict.fromkeys(SIX, 3),
        "events_leading": 2,
        "mu_sapp_uniform": 2,
        "all six": 2,
        "all six as printed": 2,
        "any reading": 0,
    }
    # Two of three: Clopper and Pearson's tables.
    assert found.loc["all six", ["low", "high"]].tolist() == pytest.approx([0.0943, 0.9916], abs=1e-4)


def test_the_same_seed_gives_the_same_steps_within_their_range():
    settings = {"seed": 1, "steps": [3e-8, 3e-7]}
    one, more = (draws_table(SLIDER, 10.0, ["5/6"], settings, n) for n in (1, 2))
    steps = more.groupby("switching", sort=False)["step_s"].agg(list)
    assert all(found == steps.iloc[0] for found in steps)
    assert all(3e-8 <= step <= 3e-7 for step in steps.iloc[0])
    assert set(more["switching"]) == set(SWITCHING_RULES)
    pd.testing.assert_frame_equal(one, more[::2].reset_index(drop=True))


def test_the_printed_theta_is_a_reading_not_a_misprint():
    """Of 200 steps, about as many give the six numbers at 0.833 as at 5/6: the intervals meet."""
    full = pd.read_csv(GOLDEN.parents[1] / "paper/tables/random_steps_full.csv")
    ours = full[(full["switching"] == COULOMB) & (full["question"] == "all six")].set_index("degree")
    assert (ours["n"] == 200).all()
    assert ours["low"].max() < ours["high"].min()
    assert (ours["k"] > 0).all()
