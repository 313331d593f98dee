"""Eq. 15: a chain at rest carries at most mu_s F_Z, whatever its weights; and how the paper gets there."""

import csv
import json
from dataclasses import replace

import check_eq15 as script
import numpy as np
import pytest
import sympy

from precursors.model import statics as bound
from precursors.model.chain import Chain
from precursors.reproduction import derivation, eq15

# Sums of up to 500 terms, each rounded to 1e-16 of the whole.
ROUNDING = 1e-12
# The linear program is asked for 1e-10 of F_Z.
LP = 1e-9
# Force of a spring from positions: k x carries 1e-16 of the largest k x, up to 1e3 times the strengths here.
FROM_POSITIONS = 1e-10
# mu_sapp of the paper's scenes is known with four decimals.
FOUR_DECIMALS = 5e-5

SCENES = {"fig11": "-5/6", "fig10": 0.0, "fig12": "5/6"}
EVERY_N = range(1, 13)
SEVERAL_BLOCKS = range(2, 13)


@pytest.fixture(scope="module")
def scenes():
    return {name: Chain.from_slider(theta=theta) for name, theta in SCENES.items()}


@pytest.fixture(scope="module")
def written(tmp_path_factory, scenes):
    json_path, csv_path = (tmp_path_factory.mktemp("tables") / name for name in ("eq15.json", "eq15.csv"))
    script.main(scenes, 10.0, json_path, csv_path)
    with csv_path.open(newline="") as file:
        return json.loads(json_path.read_text()), list(csv.DictReader(file))


@pytest.fixture(scope="module")
def motion(written):
    return {(check["case"], check["start"]): check["mu_sapp"] for check in written[0]["motion"]}


@pytest.fixture
def underived():
    """Forget what was derived, before and after the test breaks an equation."""
    derivation.derive.cache_clear()
    yield
    derivation.derive.cache_clear()


def random_chains():
    rng = np.random.default_rng(2010)
    return [eq15.random_chain(n, rng) for n in (1, 2, 3, 4, 7, 30, 300)]


class TestInSymbols:
    @pytest.mark.parametrize("n", EVERY_N)
    def test_balance_of_every_block_gives_mu_s_F_Z_exactly(self, n):
        w = derivation.weights(n)
        assert sympy.expand(derivation.derive(n).load - derivation.mu_s * sympy.Add(*w)) == 0

    @pytest.mark.parametrize("n", EVERY_N)
    def test_each_spring_carries_the_strength_of_the_blocks_ahead_of_it(self, n):
        w = derivation.weights(n)
        for i, compression in enumerate(derivation.derive(n).compressions):
            stiffness = derivation.K if i == 0 else derivation.k
            assert sympy.expand(stiffness * compression - derivation.mu_s * sympy.Add(*w[i:])) == 0

    @pytest.mark.parametrize("n", EVERY_N)
    def test_the_load_depends_on_the_weights_through_their_sum_only(self, n):
        load = derivation.derive(n).load
        assert derivation.depends_on_sum_only(load, n)
        assert derivation.is_symmetric(load, n)
        assert derivation.in_normal_load(load, n) == derivation.mu_s * derivation.F_Z

    @pytest.mark.parametrize("n", SEVERAL_BLOCKS)
    def test_a_load_that_depends_on_more_than_the_sum_is_told_apart(self, n):
        as_printed = derivation.derive(n).load_as_printed
        assert not derivation.depends_on_sum_only(as_printed, n)
        assert not derivation.is_symmetric(as_printed, n)
        assert derivation.weights(n)[-1] in derivation.in_normal_load(as_printed, n).free_symbols

    @pytest.mark.parametrize("n", EVERY_N)
    def test_in_any_state_the_net_forces_on_the_blocks_add_up_to_the_load(self, n):
        assert derivation.sum_of_forces_is_load(n)

    @pytest.mark.parametrize("n", SEVERAL_BLOCKS)
    def test_eq_12_is_misprinted_in_its_last_line_and_in_no_other(self, n):
        true, printed = derivation.balances(n), derivation.balances_as_printed(n)
        wrong = [i for i in range(n) if sympy.expand(true[i] - printed[i]) != 0]
        assert wrong == [n - 1]
        y_last = derivation.springs(n)[-1]
        assert sympy.expand(true[-1] - printed[-1] - (derivation.k - derivation.K) * y_last) == 0

    @pytest.mark.parametrize("n", SEVERAL_BLOCKS)
    def test_as_printed_eq_12_misses_mu_s_F_Z_by_k_over_K_less_1_times_the_last_strength(self, n):
        excess = derivation.derive(n).load_as_printed - derivation.bound(n)
        assert excess != 0
        assert sympy.expand(excess - derivation.excess_formula(n)) == 0

    @pytest.mark.parametrize("n", SEVERAL_BLOCKS)
    def test_as_printed_the_last_block_is_pushed_with_k_over_K_times_its_strength(self, n):
        assert derivation.overload_as_printed(n) == derivation.k / derivation.K

    def test_one_block_has_no_misprint(self):
        assert derivation.derive(1).load_as_printed == derivation.derive(1).load
        assert derivation.excess_formula(1) == 0
        assert derivation.overload_as_printed(1) == 1

    @pytest.mark.parametrize("n", [0, -1, 2.0, True])
    def test_a_number_of_blocks_that_is_none_is_refused(self, n):
        with pytest.raises(ValueError, match=r"n_blocks = .*allowed is a whole number >= 1"):
            derivation.derive(n)


class TestMisprintInNumbers:
    @pytest.mark.parametrize(
        ("scene", "load"), [("fig10", 1127.0), ("fig11", 2527 / 6), ("fig12", 10997 / 6)]
    )
    def test_as_printed_the_paper_s_chain_would_carry(self, scenes, scene, load):
        check = eq15.check_misprint(scene, scenes[scene])
        assert check.tangential_load_as_printed_N == pytest.approx(load, rel=ROUNDING)
        assert check.formula_as_printed_N == pytest.approx(load, rel=ROUNDING)
        assert check.bound_N == pytest.approx(280.0, rel=ROUNDING)

    def test_as_printed_the_last_block_of_fig10_would_feel_875_N_where_friction_holds_28_N(self, scenes):
        check = eq15.check_misprint("fig10", scenes["fig10"])
        assert check.last_block_force_as_printed_N == pytest.approx(875.0, rel=FROM_POSITIONS)
        assert check.last_block_strength_N == pytest.approx(28.0, rel=ROUNDING)


class TestStateOfMaximalStrain:
    def test_every_block_is_at_its_positive_limit(self, scenes):
        for chain in scenes.values():
            forces = bound.net_spring_forces(chain, bound.maximal_strain_positions(chain))
            np.testing.assert_allclose(forces, chain.strength, rtol=FROM_POSITIONS)

    def test_the_drive_at_0_pushes_with_mu_s_F_Z(self, scenes):
        for chain in (*scenes.values(), *random_chains()):
            load = chain.drive_stiffness * (0 - bound.maximal_strain_positions(chain)[0])
            assert load == pytest.approx(bound.load_bound(chain), rel=ROUNDING)

    def test_numbers_and_symbols_agree(self, scenes):
        for chain in scenes.values():
            expected = [derivation.value(y, chain) for y in derivation.derive(10).compressions]
            np.testing.assert_allclose(bound.maximal_compressions(chain), expected, rtol=ROUNDING)


class TestStatesOfRest:
    @pytest.mark.parametrize("chain", random_chains(), ids=lambda chain: f"N={chain.n_blocks}")
    def test_the_load_spans_plus_and_minus_mu_s_F_Z(self, chain):
        found = bound.loads_at_rest(chain)
        assert found.largest == pytest.approx(chain.mu_s * chain.weights.sum(), rel=LP)
        assert found.smallest == pytest.approx(-chain.mu_s * chain.weights.sum(), rel=LP)

    @pytest.mark.parametrize("chain", random_chains(), ids=lambda chain: f"N={chain.n_blocks}")
    def test_the_largest_load_is_reached_in_the_state_of_eq_12_only(self, chain):
        found = bound.loads_at_rest(chain)
        np.testing.assert_allclose(found.compressions_at_largest, bound.maximal_compressions(chain), rtol=LP)
        np.testing.assert_allclose(
            found.compressions_at_smallest, -bound.maximal_compressions(chain), rtol=LP
        )

    def test_both_extremes_are_states_of_rest_of_eq_2(self, scenes):
        for chain in scenes.values():
            found = bound.loads_at_rest(chain)
            for compressions in (found.compressions_at_largest, found.compressions_at_smallest):
                forces = bound.net_spring_forces(chain, bound.positions_from_compressions(compressions))
                assert np.all(np.abs(forces) <= chain.strength * (1 + FROM_POSITIONS))

    def test_the_strength_of_every_block_counts_equally(self, scenes):
        for chain in scenes.values():
            np.testing.assert_allclose(bound.loads_at_rest(chain).sensitivity, 1.0, atol=LP)

    def test_no_state_of_rest_drawn_at_random_carries_more(self, scenes):
        rng = np.random.default_rng(5)
        chain = scenes["fig12"]
        unit_moves = np.eye(chain.n_blocks)
        stiffness = np.array([bound.net_spring_forces(chain, move) for move in unit_moves]).T
        for _ in range(200):
            friction = rng.uniform(-1, 1, chain.n_blocks) * chain.strength
            positions = np.linalg.solve(stiffness, friction)
            assert abs(chain.drive_stiffness * positions[0]) <= bound.load_bound(chain)

    def test_the_program_sees_the_weight_of_each_block(self, scenes):
        chain = scenes["fig10"]
        for i in range(chain.n_blocks):
            weights = chain.weights.copy()
            weights[i] += 10.0
            heavier = bound.loads_at_rest(replace(chain, weights=weights))
            assert heavier.largest == pytest.approx(287.0, rel=LP)

    @pytest.mark.parametrize("theta", [-1, 1])
    def test_a_weightless_block_changes_nothing(self, theta):
        assert bound.loads_at_rest(Chain.from_slider(theta=theta)).largest == pytest.approx(280.0, rel=LP)


class TestMotion:
    @pytest.mark.parametrize("scene", SCENES)
    def test_a_start_at_maximal_residual_strain_reaches_mu_s(self, motion, scene):
        assert motion[scene, "maximal residual strain"] == pytest.approx(0.7, abs=ROUNDING)

    @pytest.mark.parametrize(
        ("scene", "mu_sapp"),
        [
            ("fig10", 0.7 * (0.999 + 0.001 / 10)),
            ("fig11", 0.7 * (0.999 + 0.001 * 11 / 60)),
            ("fig12", 0.7 * (0.999 + 0.001 / 60)),
        ],
    )
    def test_a_start_slightly_below_it_falls_short_by_as_much(self, motion, scene, mu_sapp):
        assert motion[scene, "0.999 of maximal residual strain"] == pytest.approx(mu_sapp, abs=ROUNDING)

    @pytest.mark.parametrize(("scene", "mu_sapp"), [("fig11", 0.4845), ("fig10", 0.4858), ("fig12", 0.4883)])
    def test_a_start_at_natural_length_stays_below(self, motion, scene, mu_sapp):
        assert motion[scene, "natural length"] == pytest.approx(mu_sapp, abs=FOUR_DECIMALS)
        assert motion[scene, "natural length"] < 0.7

    def test_one_block_reaches_mu_s(self, motion):
        assert motion["N = 1", "natural length"] == pytest.approx(0.7, abs=ROUNDING)

    def test_without_a_global_slip_nothing_is_claimed(self, scenes):
        check = eq15.check_motion("fig10", "natural length", scenes["fig10"], None, 1.0, expected=0.7)
        assert check.mu_sapp is None
        assert not check.holds

    @pytest.mark.parametrize("theta", [-1, 1])
    def test_a_chain_that_never_comes_to_rest_is_not_pushed(self, theta):
        assert list(eq15.check_motions("weightless", Chain.from_slider(theta=theta), 10.0)) == []


class TestChecksFailWhenBroken:
    def test_eq_12_as_printed_does_not_pass_for_the_derivation(self, monkeypatch, underived):
        monkeypatch.setattr(derivation, "balances", derivation.balances_as_printed)
        assert not eq15.check_symbols(4).holds

    def test_a_load_that_one_weight_does_not_enter_does_not_pass(self, monkeypatch, underived):
        true = derivation.balances
        monkeypatch.setattr(
            derivation, "balances", lambda n: [line.subs(derivation.weights(n)[0], 0) for line in true(n)]
        )
        assert not eq15.check_symbols(4).holds

    def test_a_state_at_rest_other_than_eq_12_s_does_not_pass(self, monkeypatch, scenes):
        monkeypatch.setattr(eq15, "maximal_compressions", bound.compressions_as_printed)
        assert not eq15.check_rest("fig10", scenes["fig10"]).holds

    def test_a_wrong_bound_does_not_pass(self, monkeypatch, scenes):
        monkeypatch.setattr(eq15, "load_bound", lambda chain: chain.mu_k * chain.normal_load)
        assert not eq15.check_rest("fig10", scenes["fig10"]).holds

    def test_a_start_at_too_little_strain_does_not_pass_for_the_maximum(self, scenes):
        chain = scenes["fig10"]
        start = 0.99 * bound.maximal_strain_positions(chain)
        assert not eq15.check_motion("fig10", "less strain", chain, start, 10.0, expected=chain.mu_s).holds

    def test_natural_length_does_not_pass_for_the_rigid_slider(self, scenes):
        check = eq15.check_motion("fig10", "natural length", scenes["fig10"], None, 10.0, expected=0.7)
        assert not check.holds


class TestTable:
    def test_every_claim_holds(self, written):
        _, rows = written
        assert list(rows[0]) == ["check", "case", "unit", "expected", "found", "difference", "holds"]
        assert [row for row in rows if row["holds"] != "True"] == []

    def test_every_claim_is_there(self, written):
        everything, rows = written
        assert [check["n_blocks"] for check in everything["symbolic"]] == list(EVERY_N)
        assert [check["scene"] for check in everything["misprint"]] == list(SCENES)
        assert {check["n_blocks"] for check in everything["rest"]} >= {1, 2, 10, 500}
        assert len(everything["motion"]) == 3 * len(SCENES) + 1
        n_rows = 2 * len(EVERY_N) + len(SCENES) + 2 * len(everything["rest"]) + len(everything["motion"])
        assert len(rows) == len(everything["claims"]) == n_rows

    def test_no_scene_is_refused(self):
        with pytest.raises(ValueError, match="scenes are empty"):
            eq15.check_eq15({}, duration=10.0)
