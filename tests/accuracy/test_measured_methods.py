"""Methods are timed as they should be, and compared with what is proved."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from accuracy.made_up import CHAIN, DURATION, TRUE, has_all_transitions, made_up, tied_certificate

from precursors import Chain, Run, TransitionLimitError, simulate
from precursors.accuracy.compare import Truth, compare
from precursors.accuracy.proof import ExactChain, certify
from precursors.accuracy.work_precision import SHORTEST, Case, charted_values, measure_methods, proved_cases
from precursors.methods import METHODS, Method, Result

FIVE = TRUE[:5]  # two slips, the second not over
# A call of a fake method takes so long, on a clock that the test moves [s].
CALL = 0.002
# And where it is to be repeated [s].
WARM_CALL = 0.0005


def case(run: Run, **changes) -> Case:
    return replace(Case("made up", 0.0, CHAIN, DURATION, None, Truth.of_run(run), True), **changes)


class TestCases:
    def test_a_proof_is_the_truth_to_its_end_and_to_the_first_global_slip(self):
        certificate = certify(ExactChain.from_slider(n_blocks=2, theta="1/4"), 8)
        first, whole = proved_cases("two", 0.25, certificate)
        assert (first.until, whole.until) == ("global slip", None)
        assert first.is_proved
        assert whole.is_proved
        assert first.duration == whole.duration == 8.0
        n = len(first.truth.run.transitions)
        assert 0 < n < len(whole.truth.run.transitions) == len(certificate.transitions)
        np.testing.assert_array_equal(first.truth.time_rest, whole.truth.time_rest[:n])
        for of in (first, whole):
            assert has_all_transitions(compare(simulate(of.chain, of.duration, of.until), of.truth))

    def test_a_tie_leaves_all_to_the_exact_solver(self):
        certificate = replace(tied_certificate(), start_positions=(Fraction(0),) * 7, duration=Fraction(2))
        for of in proved_cases("seven", 0.0, certificate):
            assert not of.is_proved
            assert compare(simulate(of.chain, 2.0, of.until), of.truth).time_error == 0.0

    def test_a_start_that_the_methods_do_not_have_is_refused(self):
        with pytest.raises(ValueError, match=r"seven must start with springs at natural length"):
            proved_cases("seven", 0.0, tied_certificate())


class TestValues:
    def test_the_exact_solver_is_in_every_chart_and_comes_first(self):
        for until in (None, "global slip"):
            for full in (False, True):
                values = charted_values(case(made_up(FIVE), until=until), full)
                assert next(iter(values)) == "exact"
                assert values["exact"] == (0.0,)

    def test_the_full_chart_has_all_methods_and_the_default_one_some_of_their_values(self):
        first = case(made_up(FIVE), until="global slip")
        full, default = charted_values(first, full=True), charted_values(first)
        assert all(full.values())
        for name, method in METHODS.items():
            assert full[name] == method.values
            assert len(default[name]) <= len(full[name])

    @pytest.mark.parametrize("name", METHODS)
    def test_values_go_from_loose_to_tight(self, name):
        method = METHODS[name]
        for values in (method.values, method.whole, method.quick, method.quick_whole):
            assert list(values) == sorted(values, reverse=True)


class Fake:
    """A method that takes as long as its setting says, and gives a run."""

    def __init__(self, run: Run, clock) -> None:
        self.run, self.clock, self.calls = run, clock, []

    def solve(self, _chain: Chain, _duration: float, value: float, _until: str | None) -> Result:
        self.calls.append(value)
        self.clock.now += value
        return Result(self.run, 7)


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch, clock) -> Fake:
    fake = Fake(made_up(FIVE), clock)
    monkeypatch.setitem(METHODS, "rk4", Method("rk4", "fake", "time [s]", fake.solve, (CALL, 2 * CALL)))
    return fake


def measured(values, longest=1.0, **changes):
    return measure_methods(case(made_up(FIVE), **changes), values, 5, longest)


class TestMeasuring:
    def test_a_row_holds_time_work_and_errors(self, fake):
        fake.run = made_up([(t, b, m, f - 1.0) for t, b, m, f in FIVE[:4]])
        (row,) = measured({"rk4": [CALL]}).to_dict("records")
        assert row["seconds"] == pytest.approx(CALL)
        assert (row["method"], row["label"], row["value"]) == ("rk4", "fake", CALL)
        assert (row["evaluations"], row["error_load_N"], row["error_time_s"]) == (7, 1.0, 0.0)
        assert (row["transitions_right"], row["transitions_found"], row["transitions_true"]) == (4, 4, 5)
        assert (row["slips_right"], row["slips_found"], row["slips_true"]) == (2, 2, 2)

    def test_a_method_is_given_up_before_the_first_value_that_takes_too_long(self, fake):
        table = measured({"rk4": [CALL, 40 * CALL, 0.5 * CALL]}, longest=10 * CALL)
        assert table["value"].tolist() == [CALL]
        assert fake.calls.count(CALL) == 2 + (5 - 1 if CALL > SHORTEST else 5 * round(SHORTEST / CALL))
        assert 0.5 * CALL not in fake.calls

    @pytest.mark.parametrize("first", [WARM_CALL, 0.05, 0.82, 1.9, 10.0])
    def test_a_first_call_that_compiles_counts_for_nothing(self, fake, clock, first):
        def solve(_chain, _duration, value, _until):
            clock.now += WARM_CALL if fake.calls else first
            fake.calls.append(value)
            return Result(fake.run, 7)

        METHODS["rk4"] = replace(METHODS["rk4"], solve=solve)
        table = measured({"rk4": [1e-6]}, longest=2.0)
        assert len(fake.calls) == 2 + 5 * round(SHORTEST / WARM_CALL)
        assert table["seconds"].item() == pytest.approx(WARM_CALL)

    def test_a_run_that_breaks_off_is_a_row_with_what_there_is(self, fake):
        def breaks_off(*_arguments):
            fake.clock.now += CALL
            raise TransitionLimitError("enough", made_up(FIVE[:3]))

        METHODS["rk4"] = replace(METHODS["rk4"], solve=breaks_off)
        table = measured({"rk4": [CALL]})
        assert table["transitions_right"].item() == 3
        assert math.isnan(table["evaluations"].item())

    @pytest.mark.parametrize("is_proved", [True, False])
    def test_the_exact_solver_has_no_error_where_it_is_the_truth(self, is_proved):
        chain = Chain.from_slider(n_blocks=2)
        truth = Truth.of_run(simulate(chain, DURATION))
        (row,) = measured({"exact": [0.0]}, chain=chain, truth=truth, is_proved=is_proved).to_dict("records")
        assert math.isnan(row["error_time_s"]) is not is_proved
        assert row["transitions_right"] == row["transitions_true"] > 0
