"""The derivation check of Eq. 15, gathered: symbols, states of rest, motion; and the table of its claims."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import find_slips
from precursors.hierarchy.rigid import as_rigid
from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import (
    compressions_as_printed,
    load_bound,
    loads_at_rest,
    maximal_compressions,
    maximal_strain_positions,
    net_spring_forces,
    positions_from_compressions,
)
from precursors.reproduction import derivation as symbolic
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError, simulate

SYMBOLIC_BLOCKS = range(1, 13)
RANDOM_BLOCKS = (1, 2, 3, 5, 10, 20, 50, 200, 500)
RANDOM_SEED = 15
# Strain of a start slightly below the maximum, as a fraction of the maximal strain.
SLIGHTLY_BELOW = 0.999
# Far more than a chain needs that rests between its slips (the paper's make 300 before their global slip);
# it ends the runs of others.
MAX_TRANSITIONS = 100_000

# Relative: HiGHS is asked for 1e-10, and reaches rounding.
LP_TOLERANCE = 1e-9
# Relative (loads) and absolute (mu_sapp): sums of N terms, each rounded to 1e-16 of the whole.
ROUNDING_TOLERANCE = 1e-12


@dataclass(frozen=True)
class SymbolicCheck:
    """Eq. 12 solved for N blocks with symbolic weights, mu_s, K and k."""

    n_blocks: int
    compressions_m: tuple[str, ...]
    tangential_load_N: str
    tangential_load_by_normal_load_N: str
    difference_from_bound_N: str
    every_weight_has_derivative_mu_s: bool
    unchanged_by_permutations: bool
    net_forces_add_up_to_tangential_load: bool
    tangential_load_as_printed_N: str
    excess_as_printed_N: str
    excess_by_formula_N: str
    difference_of_excess_N: str
    last_block_force_over_strength_as_printed: str

    @property
    def holds(self) -> bool:
        """Whether F_X = mu_s F_Z, whatever the weights."""
        return (
            self.difference_from_bound_N == "0"
            and self.every_weight_has_derivative_mu_s
            and self.unchanged_by_permutations
            and self.net_forces_add_up_to_tangential_load
        )


@dataclass(frozen=True)
class MisprintCheck:
    """Eq. 12 with its last line as printed, for the numbers of one scene."""

    scene: str
    n_blocks: int
    bound_N: float
    formula_as_printed_N: float  # mu_s F_Z + (k/K - 1) mu_s w_N
    tangential_load_as_printed_N: float
    mu_sapp_as_printed: float
    last_block_force_as_printed_N: float
    last_block_strength_N: float

    @property
    def holds(self) -> bool:
        """Whether the N equations in numbers give what the formula says."""
        return math.isclose(
            self.tangential_load_as_printed_N, self.formula_as_printed_N, rel_tol=ROUNDING_TOLERANCE
        )


@dataclass(frozen=True)
class RestCheck:
    """Extremes of F_X over all states of rest of one chain, by linear programming."""

    case: str
    n_blocks: int
    weights_N: tuple[float, ...]
    stiffness_N_per_m: float
    drive_stiffness_N_per_m: float
    mu_s: float
    bound_N: float
    largest_N: float
    smallest_N: float
    largest_relative_difference_of_compressions_from_eq12: float
    largest_difference_of_sensitivity_from_one: float

    @property
    def holds(self) -> bool:
        """Whether F_X spans +-mu_s F_Z, is largest in the state of Eq. 12, and all mu_s w_i count equally."""
        return (
            math.isclose(self.largest_N, self.bound_N, rel_tol=LP_TOLERANCE)
            and math.isclose(self.smallest_N, -self.bound_N, rel_tol=LP_TOLERANCE)
            and self.largest_relative_difference_of_compressions_from_eq12 <= LP_TOLERANCE
            and self.largest_difference_of_sensitivity_from_one <= LP_TOLERANCE
        )


@dataclass(frozen=True)
class MotionCheck:
    """Apparent static friction coefficient of one chain pushed from one start to its first global slip.

    The last three are None if there is no global slip within the duration or MAX_TRANSITIONS.
    """

    case: str
    start: str
    n_blocks: int
    mu_s: float
    expected_mu_sapp: float
    stays_below: bool
    mu_sapp: float | None
    tangential_load_N: float | None
    global_slip_time_s: float | None

    @property
    def holds(self) -> bool:
        """Whether mu_sapp equals what is expected, or stays below it."""
        if self.mu_sapp is None:
            return False
        if self.stays_below:
            return self.mu_sapp < self.expected_mu_sapp
        return abs(self.mu_sapp - self.expected_mu_sapp) <= ROUNDING_TOLERANCE


@dataclass(frozen=True)
class Eq15:
    """All checks of the derivation of Eq. 15."""

    symbolic: tuple[SymbolicCheck, ...]
    misprint: tuple[MisprintCheck, ...]
    rest: tuple[RestCheck, ...]
    motion: tuple[MotionCheck, ...]


@dataclass(frozen=True)
class Row:
    """One line of the short table."""

    check: str
    case: str
    unit: str
    expected: str | float
    found: str | float | None
    difference: str | float | None
    holds: bool


def check_eq15(scenes: Mapping[str, Chain], duration: float) -> Eq15:
    """Check the derivation of Eq. 15, for the chains of some scenes where it needs numbers.

    Parameters
    ----------
    scenes : mapping of str to Chain
        Chains by name of scene, at least one.
    duration : float
        Time within which a global slip is awaited [s].

    Raises
    ------
    ValueError
        If there is no scene.
    """
    if not scenes:
        raise ValueError("scenes are empty: allowed is at least one scene")
    rigid = as_rigid(next(iter(scenes.values())))
    rng = np.random.default_rng(RANDOM_SEED)
    random = {f"N = {n}, random": random_chain(n, rng) for n in RANDOM_BLOCKS}
    return Eq15(
        symbolic=tuple(check_symbols(n) for n in SYMBOLIC_BLOCKS),
        misprint=tuple(check_misprint(scene, chain) for scene, chain in scenes.items()),
        rest=tuple(check_rest(case, chain) for case, chain in {**scenes, **random}.items()),
        motion=(
            *(check for scene, chain in scenes.items() for check in check_motions(scene, chain, duration)),
            check_motion("N = 1", "natural length", rigid, None, duration, expected=rigid.mu_s),
        ),
    )


def check_symbols(n_blocks: int) -> SymbolicCheck:
    """Solve Eq. 12 in symbols and say what its load depends on."""
    n = n_blocks
    found = symbolic.derive(n)
    as_printed = symbolic.difference(found.load_as_printed, symbolic.bound(n))
    formula = symbolic.excess_formula(n)
    return SymbolicCheck(
        n_blocks=n,
        compressions_m=tuple(map(str, found.compressions)),
        tangential_load_N=str(found.load),
        tangential_load_by_normal_load_N=str(symbolic.in_normal_load(found.load, n)),
        difference_from_bound_N=str(symbolic.difference(found.load, symbolic.bound(n))),
        every_weight_has_derivative_mu_s=symbolic.depends_on_sum_only(found.load, n),
        unchanged_by_permutations=symbolic.is_symmetric(found.load, n),
        net_forces_add_up_to_tangential_load=symbolic.sum_of_forces_is_load(n),
        tangential_load_as_printed_N=str(found.load_as_printed),
        excess_as_printed_N=str(as_printed),
        excess_by_formula_N=str(formula),
        difference_of_excess_N=str(symbolic.difference(as_printed, formula)),
        last_block_force_over_strength_as_printed=str(symbolic.overload_as_printed(n)),
    )


def check_misprint(scene: str, chain: Chain) -> MisprintCheck:
    """Compare the formula for Eq. 12 as printed with the solution of its N equations in numbers."""
    n = chain.n_blocks
    compressions = compressions_as_printed(chain)
    load = float(chain.drive_stiffness * compressions[0])
    forces = net_spring_forces(chain, positions_from_compressions(compressions))
    return MisprintCheck(
        scene=scene,
        n_blocks=n,
        bound_N=load_bound(chain),
        formula_as_printed_N=symbolic.value(symbolic.bound(n) + symbolic.excess_formula(n), chain),
        tangential_load_as_printed_N=load,
        mu_sapp_as_printed=load / chain.normal_load,
        last_block_force_as_printed_N=float(forces[-1]),
        last_block_strength_N=float(chain.strength[-1]),
    )


def check_rest(case: str, chain: Chain) -> RestCheck:
    """Find the extremes of F_X over all states of rest, and compare them with Eqs. 12 and 14."""
    found = loads_at_rest(chain)
    eq12 = maximal_compressions(chain)
    difference = np.max(np.abs(found.compressions_at_largest - eq12)) / np.max(eq12)
    return RestCheck(
        case=case,
        n_blocks=chain.n_blocks,
        weights_N=tuple(chain.weights.tolist()),
        stiffness_N_per_m=chain.stiffness,
        drive_stiffness_N_per_m=chain.drive_stiffness,
        mu_s=chain.mu_s,
        bound_N=load_bound(chain),
        largest_N=found.largest,
        smallest_N=found.smallest,
        largest_relative_difference_of_compressions_from_eq12=float(difference),
        largest_difference_of_sensitivity_from_one=float(np.max(np.abs(found.sensitivity - 1))),
    )


def check_motions(scene: str, chain: Chain, duration: float) -> Iterator[MotionCheck]:
    """Push a chain from rest at natural length, at maximal residual strain, and slightly below that.

    A chain with a weightless block is left out: it never comes to rest, and its slips have no onset.
    """
    if not chain.weights.all():
        return
    full = maximal_strain_positions(chain)
    yield check_motion(
        scene, "natural length", chain, None, duration, expected=chain.mu_s, stays_below=chain.n_blocks > 1
    )
    yield check_motion(scene, "maximal residual strain", chain, full, duration, expected=chain.mu_s)
    yield check_motion(
        scene,
        f"{SLIGHTLY_BELOW:g} of maximal residual strain",
        chain,
        SLIGHTLY_BELOW * full,
        duration,
        expected=friction_below_maximal_strain(chain, SLIGHTLY_BELOW),
    )


def check_motion(
    case: str,
    start: str,
    chain: Chain,
    positions: FloatArray | None,
    duration: float,
    *,
    expected: float,
    stays_below: bool = False,
) -> MotionCheck:
    """Push a chain from rest at some positions [m] and compare mu_sapp with what is expected."""
    slips = find_slips(_run_to_global_slip(chain, positions, duration))
    load = onset = None
    first = first_global(slips)
    if first is not None:
        load = float(slips["load_before"].iloc[: first + 1].max())
        onset = float(slips["onset"].iloc[first])
    return MotionCheck(
        case=case,
        start=start,
        n_blocks=chain.n_blocks,
        mu_s=chain.mu_s,
        expected_mu_sapp=expected,
        stays_below=stays_below,
        mu_sapp=None if load is None else load / chain.normal_load,
        tangential_load_N=load,
        global_slip_time_s=onset,
    )


def _run_to_global_slip(chain: Chain, positions: FloatArray | None, duration: float) -> Run:
    try:
        return simulate(chain, duration, "global slip", positions, max_transitions=MAX_TRANSITIONS)
    except TransitionLimitError as error:
        return error.run


def friction_below_maximal_strain(chain: Chain, fraction: float) -> float:
    """Apparent static friction coefficient of a start at a fraction a of the maximal strain, a near 1.

    Every block is at a mu_s w_i. The drive can only load block 1, which slips first, at
    F_X = a mu_s F_Z + (1 - a) mu_s w_1; the others are near enough to their limits to
    follow it, if mu_k is well below mu_s.
    """
    return chain.mu_s * (fraction + (1 - fraction) * float(chain.weights[0]) / chain.normal_load)


def random_chain(n_blocks: int, rng: np.random.Generator) -> Chain:
    """Return a chain of random weights [N], mu_s up to 1, and springs random over twelve decades of K/k."""
    stiffness, drive_stiffness = 1e6 * 10 ** rng.uniform(-3, 3, size=2)
    return Chain(
        weights=rng.exponential(40.0, n_blocks),
        mass=1e-3,
        stiffness=stiffness,
        drive_stiffness=drive_stiffness,
        drive_velocity=1e-4,
        mu_s=rng.uniform(0.1, 1.0),
        mu_k=0.0,
    )


def table(checks: Eq15) -> list[Row]:
    """Put every claim of the derivation on a line: what is expected, what was found, and whether it holds."""
    return [
        *(_symbolic_row(check) for check in checks.symbolic),
        *(_excess_row(check) for check in checks.symbolic),
        *(_misprint_row(check) for check in checks.misprint),
        *(row for check in checks.rest for row in _rest_rows(check)),
        *(_motion_row(check) for check in checks.motion),
    ]


def _symbolic_row(check: SymbolicCheck) -> Row:
    return Row(
        check="Eq. 12 gives F_X = mu_s F_Z for any weights",
        case=f"N = {check.n_blocks}",
        unit="N",
        expected=str(symbolic.mu_s * symbolic.F_Z),
        found=check.tangential_load_by_normal_load_N,
        difference=check.difference_from_bound_N,
        holds=check.holds,
    )


def _excess_row(check: SymbolicCheck) -> Row:
    return Row(
        check="Eq. 12 as printed adds (k/K - 1) mu_s w_N for N > 1",
        case=f"N = {check.n_blocks}",
        unit="N",
        expected=check.excess_by_formula_N,
        found=check.excess_as_printed_N,
        difference=check.difference_of_excess_N,
        holds=check.difference_of_excess_N == "0",
    )


def _misprint_row(check: MisprintCheck) -> Row:
    return Row(
        check="Eq. 12 as printed gives F_X = mu_s F_Z + (k/K - 1) mu_s w_N",
        case=check.scene,
        unit="N",
        expected=check.formula_as_printed_N,
        found=check.tangential_load_as_printed_N,
        difference=check.tangential_load_as_printed_N - check.formula_as_printed_N,
        holds=check.holds,
    )


def _rest_rows(check: RestCheck) -> Iterator[Row]:
    for name, expected, found in (
        ("largest F_X of all states of rest is mu_s F_Z", check.bound_N, check.largest_N),
        ("smallest F_X of all states of rest is -mu_s F_Z", -check.bound_N, check.smallest_N),
    ):
        yield Row(name, check.case, "N", expected, found, found - expected, check.holds)


def _motion_row(check: MotionCheck) -> Row:
    sign = "<" if check.stays_below else "="
    return Row(
        check=f"mu_sapp {sign} expected, pushed from {check.start}",
        case=check.case,
        unit="1",
        expected=check.expected_mu_sapp,
        found=check.mu_sapp,
        difference=None if check.mu_sapp is None else check.mu_sapp - check.expected_mu_sapp,
        holds=check.holds,
    )
