"""The erratum has the numbers that follow from the paper, and the measures say what they are called."""

import math

import numpy as np
import pytest

from precursors import Chain, simulate
from precursors.analysis.slips import find_precursors, find_slips
from precursors.model.statics import maximal_strain_positions
from precursors.reproduction.erratum import MISPRINT, OPEN, find_errors
from precursors.reproduction.measures import growth, measures, residual_strain

# Sums and quotients of ten numbers in double precision.
ROUNDING = 1e-12
# With a step of 1 microsecond block 1 trembles from just below mu_s w_1 on: 1e-4 of the load.
LITERAL = 3e-3


@pytest.fixture(scope="module")
def runs():
    return {name: simulate(Chain.from_slider(theta=name), 10.0) for name in ("-5/6", "0", "5/6")}


@pytest.fixture(scope="module")
def errors(runs):
    return find_errors("-5/6", "0", "5/6", runs)


def numbers(errors, number, attribute="as_meant"):
    return [getattr(entry, attribute) for entry in errors if entry.number == number]


def test_every_point_has_a_number_and_none_is_left_out(errors):
    assert sorted({entry.number for entry in errors}) == list(range(1, 19))
    assert all(entry.where and entry.printed and entry.meant and entry.unit for entry in errors)
    assert not any(math.isnan(entry.as_meant) for entry in errors)
    # What the paper does not define, does not tell, or calls by a second name has no printed number.
    assert {entry.number for entry in errors if math.isnan(entry.as_printed)} == {6, 9, 10}


def test_misprints_come_first_and_what_is_not_an_error_is_none_of_them(errors):
    kinds = [entry.kind for entry in errors]
    assert kinds == sorted(kinds)
    misprints = {entry.number for entry in errors if entry.kind == MISPRINT}
    assert misprints == {1, 2, 3, 4, 9, 12}
    assert {entry.kind for entry in errors if entry.number in {8, 10, 14, 15}} == {OPEN}


def test_eq_12_as_printed_gives_1127_n_instead_of_280_n(errors):
    printed = numbers(errors, 1, "as_printed")
    # 280 N + (k/K - 1) 0.7 w_N, with w_N = 6.67, 40 and 73.3 N.
    expected = [280 + (25 / 0.8 - 1) * 0.7 * w for w in (40 / 6, 40, 440 / 6)]
    assert printed == pytest.approx(expected, rel=ROUNDING)
    assert printed[1] == pytest.approx(1127, rel=ROUNDING)
    assert numbers(errors, 1) == pytest.approx([280] * 3, rel=ROUNDING)


def test_normal_loads_by_load_cells_and_by_moments_differ(errors):
    assert numbers(errors, 5, "as_printed") == pytest.approx([3.5, 5 / 6, 5 / 6], rel=ROUNDING)
    assert numbers(errors, 5) == pytest.approx([3, 9 / 11, 0.9], rel=ROUNDING)


def test_ten_blocks_have_nine_springs(errors):
    [entry] = [entry for entry in errors if entry.number == 7]
    assert entry.as_printed / entry.as_meant == pytest.approx(10 / 9, rel=ROUNDING)
    assert entry.as_meant == pytest.approx(2.5e9 * 1e-4 / 0.1, rel=ROUNDING)


def test_friction_as_printed_never_lets_the_load_exceed_28_n(errors):
    [entry] = [entry for entry in errors if entry.number == 11]
    assert entry.as_printed == pytest.approx(28, abs=LITERAL)
    assert entry.as_meant == pytest.approx(194.31, abs=0.005)


def test_in_finer_steps_friction_as_printed_lets_it_exceed_28_n_and_still_never_sticks(errors):
    [entry] = [entry for entry in errors if entry.number == 11]
    assert entry.printed.endswith("; 33.4 N at 1e-08 s by 0.45 s, still without a stick")


def test_theta_rounded_to_three_digits_gives_other_numbers(errors):
    assert numbers(errors, 12, "as_printed") == pytest.approx([15, 0.5461, 3.246], rel=1e-3)
    assert numbers(errors, 12) == pytest.approx([14, 0.4883, 2.890], rel=1e-3)


def test_short_events_left_out_are_those_not_kept(errors):
    assert numbers(errors, 3) == [(7 - 6) + (16 - 9) + (56 - 14)]


def test_an_erratum_of_one_block_leaves_out_what_is_about_springs():
    run = simulate(Chain.from_slider(n_blocks=1), 5.0)
    found = {entry.number for entry in find_errors("a", "b", "c", dict.fromkeys("abc", run))}
    assert set(range(1, 19)) - found == {5, 7}


def test_measures_are_the_parameters_and_what_happens_up_to_the_global_slip(runs):
    found = {(m.quantity, m.block): m.value for m in measures(runs["-5/6"])}
    assert [found[name, None] for name in ("m", "k", "K V")] == pytest.approx(
        [0.0012, 25e6, 80], rel=ROUNDING
    )
    assert found["w_i", 1] == pytest.approx(440 / 6)
    assert found["events that begin at block 1, of all", None] == 1
    # Backward sliding occurs before the first global slip at theta = -5/6, and not at 0.
    backward = ("times that a block begins to slide backward before the first global slip", None)
    assert found[backward] > 0
    assert {(m.quantity, m.block): m.value for m in measures(runs["0"])}[backward] == 0


def test_the_residual_strain_of_eq_12_is_the_largest():
    chain = Chain.from_slider(theta="5/6")
    for share in (1.0, 0.5):
        run = simulate(chain, 1e-6, start_positions=share * maximal_strain_positions(chain))
        assert residual_strain(run, 0.0) == pytest.approx(share, rel=ROUNDING)


def test_growth_is_measured_before_and_after_the_last_event_below_0_7(runs):
    kept = find_precursors(find_slips(runs["0"]))
    below, beyond = growth(kept, 10)
    loads = dict(zip(kept.front, kept.load_before, strict=True))
    assert below == pytest.approx(0.5 / (loads[6] - loads[1]), rel=ROUNDING)
    assert beyond == pytest.approx(0.4 / (loads[10] - loads[6]), rel=ROUNDING)
    assert np.isnan(growth(kept[:1], 10)).all()
    assert np.isnan(growth(kept[-1:], 10)).all()
