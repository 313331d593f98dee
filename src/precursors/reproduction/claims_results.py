"""What Sects. 4 and 5 state: the model, its parameters and its results. Values are in the order of SCENES."""

from __future__ import annotations

import numpy as np
import pandas as pd
import scipy

from precursors.model import printed
from precursors.model.switching import COULOMB
from precursors.reproduction.claim import (
    FOLLOWS,
    Finding,
    above,
    at_least,
    below,
    claim,
    decreasing,
    equal,
    increasing,
    rounds_to,
    same,
)
from precursors.reproduction.tables import (
    LEADING,
    SCENES,
    TRAILING,
    UNIFORM,
    Tables,
    before_global,
    one,
    rows,
    up_to_global,
)

FRICTION = [(scene, "mu_sapp") for scene in SCENES]
# mu_sapp is printed with two digits, and said to "appear to have" this value.
LAST_DIGIT = 0.01
# A sequence whose steps vary by less than this (standard deviation over mean) would be called periodic.
PERIODIC = 0.05
# Probability by chance below which a trend counts as one.
CHANCE = 0.05
EXACT = 1e-12


def measure(t: Tables, column: str) -> list[float]:
    """A column of measures.csv for the three scenes."""
    return [one(t["measures"], column, scene=scene) for scene in SCENES]


def outer_loads(t: Tables, scene: str) -> pd.Series:
    """Normal loads of the first and the last block [N]."""
    return rows(t["measures"], scene=scene)[["first_normal_load_N", "last_normal_load_N"]].iloc[0]


def mu_sapp(t: Tables, *scenes: str) -> list[float]:
    """mu_sapp with the reading that gives the paper's numbers."""
    return [one(t["mu_sapp"], "mu_sapp", scene=scene, is_papers=True) for scene in scenes]


def counted(t: Tables, *scenes: str) -> list[int]:
    """Events of Fig. 13, the first global slip included."""
    return [int(t[f"{scene}_slips"]["counted"].sum()) for scene in scenes]


def leading_reading(
    t: Tables, column: str, degree: str = "5/6", short: str = "shorter than one before it"
) -> float:
    """A number for theta > 0 with another size of theta or meaning of "short"; all else is as we read it."""
    ours = {
        "switching": COULOMB,
        "global_slip": "in which all blocks slide at the same instant",
        "front": "farthest block that slid",
    }
    found = rows(t["definitions"], degree=degree, short=short, **ours)
    return float(found[column][found["theta"] > 0].iloc[0])


def first(t: Tables, column: str) -> list[float]:
    """A column of the first slip event of each scene; theta, n_blocks and normal_load_N are the slider's."""
    return [t[f"{scene}_slips"][column].iloc[0] for scene in SCENES]


def global_slip_load(t: Tables) -> list[float]:
    """F_X at the onset of the first global slip of each scene [N]."""
    return [up_to_global(t, scene)["load_before_N"].iloc[-1] for scene in SCENES]


def variation_of_steps(values: pd.Series) -> float:
    """Standard deviation of the steps between values over their mean: 0 for a period."""
    steps = np.diff(values)
    return float(np.std(steps) / np.mean(steps))


def chance_of_rise(values: pd.Series) -> float:
    """Probability that values in random order rise as much: one-sided test of Kendall's tau."""
    return float(
        scipy.stats.kendalltau(range(len(values)), values.astype(float), alternative="greater").pvalue
    )


def noisy(t: Tables, quantity: str, column: str) -> list[float]:
    """A statistic of the runs with noise in the normal loads, for the three scenes."""
    return [one(t["noise"], column, scene=scene, quantity=quantity) for scene in SCENES]


# Sect. 4: model and parameters


@claim("Sect. 4.2.2", kind="input")
def parameters(t: Tables) -> Finding:
    """N = 10, mu_s = 0.70, mu_k = 0.45, F_Z = 400 N, V = 0.1 mm/s and K = 0.8 MN/m (SI units)."""
    names = ["n_blocks", "mu_s", "mu_k", "normal_load_N", "drive_velocity_m_per_s", "drive_stiffness_N_per_m"]
    ours = rows(t["measures"], scene=UNIFORM)[names].iloc[0]
    return equal(ours, paper=[10, 0.70, 0.45, 400, 1e-4, 0.8e6], relative=EXACT)


@claim("Sect. 4.2.2, Eq. 9", kind="input", unit="kg")
def block_mass(t: Tables) -> Finding:
    """A block of the slider of M = 0.012 kg has the mass m = M/N = 0.0012 kg."""
    return equal(measure(t, "block_mass_kg"), paper=0.0012, relative=EXACT)


@claim("Sect. 4.2.2, Eq. 10", kind="input", unit="N/m")
def block_stiffness(t: Tables) -> Finding:
    """The springs between blocks have the stiffness k = N E S/L = 25 MN/m."""
    return equal(measure(t, "stiffness_N_per_m"), paper=25e6, relative=EXACT)


@claim("Eqs. 7 and 8", kind="input", unit="N")
def normal_loads_sum(t: Tables) -> Finding:
    """The normal loads of the blocks add up to F_Z = 400 N for every theta."""
    return equal(measure(t, "normal_load_N"), paper=400, relative=EXACT)


@claim("Sect. 4.2.2, Eq. 7", kind="input", unit="N")
def normal_loads_fall(t: Tables) -> Finding:
    """theta < 0 is a larger normal load at the trailing edge, F_ZA > F_ZB (first and last block)."""
    return decreasing(outer_loads(t, TRAILING))


@claim("Sect. 4.2.2, Eq. 7", kind="input", unit="N")
def normal_loads_rise(t: Tables) -> Finding:
    """theta > 0 is a larger normal load at the leading edge, F_ZA < F_ZB (first and last block)."""
    return increasing(outer_loads(t, LEADING))


@claim("Sect. 5.2", kind="input")
def theta_of_the_load_cells(t: Tables) -> Finding:
    """theta = -0.833, 0 and 0.833 correspond to the normal loads of Figs. 6, 4 and 7: 300/100, 200/200 and
    100/300 N."""
    return rounds_to(first(t, "theta"), paper=[-printed.THETA, 0, printed.THETA], digits=3)


@claim("Sect. 4.2.2", kind="input", unit="N")
def start(t: Tables) -> Finding:
    """At the start all blocks are at rest and all springs at natural length, so that F_X = 0."""
    return equal([t[f"{scene}_trace"]["tangential_load_N"].iloc[0] for scene in SCENES], paper=0)


@claim("Sects. 3.2.1 and 4.2.2, Eq. 3", kind="input", unit="N/s")
def loading_rate(t: Tables) -> Finding:
    """In the first stick phase F_X grows at the constant rate K V = 80 N/s."""
    rate = np.divide(first(t, "load_before_N"), first(t, "onset_s"))
    return equal(rate, paper=80, relative=1e-9)


@claim("Eqs. 3, 5 and 7", kind=FOLLOWS, unit="N")
def first_precursor_load(t: Tables) -> Finding:
    """Block 1 is the first to slide, when F_X reaches its largest static friction mu_s w_1."""
    limit = np.multiply(measure(t, "mu_s"), measure(t, "first_normal_load_N"))
    return equal(first(t, "load_before_N"), to=limit, relative=EXACT)


@claim("Eq. 4 and Sect. 4.2.2", kind="reading", unit="N")
def runge_kutta(t: Tables) -> Finding:
    """Eqs. 2 to 6 as printed, solved with a Runge-Kutta method in steps of 1 us, load the chain as the exact
    solution does (largest F_X in the first second, theta = 0)."""
    literal = rows(t["failures"], failure_mode="literal_friction").iloc[-1]
    return equal(literal["measured"], to=literal["exact"], relative=0.01)


# Sect. 5.1: uniform loading


@claim("Sect. 5.1, Fig. 10")
def stick_slip(t: Tables) -> Finding:
    """F_X is a sawtooth of stick and slip; global slips recur."""
    return at_least(t["fig10_slips"]["is_global"].sum(), 2)


@claim("Sects. 5.1 and 7 (3)")
def precursors_exist(t: Tables) -> Finding:
    """A number of partial slips come before the first global slip."""
    return at_least([len(before_global(t, scene)) for scene in SCENES], 2)


@claim("Sect. 5.1", unit="1/s")
def chaos(t: Tables) -> Finding:
    """The stick-slip is not periodic but appears to be chaotic: its largest Lyapunov exponent is positive, by
    more than its uncertainty."""
    exponents = [one(t["lyapunov"], "exponent_per_s", scene=scene) for scene in SCENES]
    return above(exponents, [one(t["lyapunov"], "uncertainty_per_s", scene=scene) for scene in SCENES])


@claim("Sect. 5.1")
def stick_slip_is_not_periodic(t: Tables) -> Finding:
    """The intervals between global slips are not constant (standard deviation over mean above 5 %)."""
    slips = t["fig10_slips"]
    return above(variation_of_steps(slips["onset_s"][slips["is_global"]]), PERIODIC)


@claim("Sect. 5.1")
def precursors_are_not_periodic(t: Tables) -> Finding:
    """The intervals between precursors are not constant (standard deviation over mean above 5 %)."""
    return above([variation_of_steps(before_global(t, scene)["onset_s"]) for scene in SCENES], PERIODIC)


@claim("Sects. 5.1, 6.1 and 7 (1)", kind=FOLLOWS)
def trailing_edge(t: Tables) -> Finding:
    """Every slip begins at the trailing edge, with block 1 (share of the events): while all blocks stick, the
    drive loads no other block."""
    return equal(measure(t, "share_of_events_from_block_1"), paper=1)


@claim("Sect. 5.1, Figs. 10-12", kind=FOLLOWS)
def vertical_lines(t: Tables) -> Finding:
    """A slip reaches from the trailing edge to its front without a gap (its length less the blocks that
    slid): a stuck block is released by a neighbour only."""
    gaps = [t[f"{scene}_slips"]["front"] - t[f"{scene}_slips"]["n_slid"] for scene in SCENES]
    return equal(pd.concat(gaps), to=0)


@claim("Abstract, Sects. 1, 5.1 and 7 (3)")
def simultaneous(t: Tables) -> Finding:
    """A precursor is a simultaneous slip of some of the masses: in none does a block stick before the
    farthest slides (precursors in which one does)."""
    partial = [before_global(t, scene) for scene in SCENES]
    return equal([(slips["n_slid"] > slips["n_simultaneous"]).sum() for slips in partial], to=0)


@claim("Sect. 5.1, Fig. 10")
def lengths_tend_to_increase(t: Tables) -> Finding:
    """The length of the slips tends to increase up to the first global slip (probability that the rank
    correlation with their order is as large by chance)."""
    return below([chance_of_rise(up_to_global(t, scene)["front"]) for scene in SCENES], CHANCE)


@claim("Sects. 3.2.1 and 7 (1), Fig. 10")
def lengths_increase_after_every_event(t: Tables) -> Finding:
    """The propagation length increases after every event up to the first global slip."""
    return increasing(up_to_global(t, UNIFORM)["front"])


# Sect. 5.2: non-uniform loading


@claim("Sect. 5.2, Fig. 13", fragile=[(TRAILING, "events_counted")])
def count_trailing(t: Tables) -> Finding:
    """theta = -0.833: Fig. 13 has 6 events, the first global slip included."""
    return equal(counted(t, TRAILING), paper=printed.EVENTS_COUNTED[-1])


@claim("Sect. 5.2, Fig. 13", fragile=[(UNIFORM, "events_counted")])
def count_uniform(t: Tables) -> Finding:
    """theta = 0: Fig. 13 has 9 events, the first global slip included."""
    return equal(counted(t, UNIFORM), paper=printed.EVENTS_COUNTED[0])


@claim("Sect. 5.2, Fig. 13", fragile=[(LEADING, "events_counted")])
def count_leading(t: Tables) -> Finding:
    """theta = 0.833: Fig. 13 has 14 events, the first global slip included."""
    return equal(counted(t, LEADING), paper=printed.EVENTS_COUNTED[1])


@claim("Sect. 5.2, Figs. 12 and 13", kind="reading")
def count_at_printed_theta(t: Tables) -> Finding:
    """With theta = 0.833 as printed, and not 5/6, Fig. 13 has 14 events."""
    return equal(
        leading_reading(t, "events_counted", degree=f"{printed.THETA}"), paper=printed.EVENTS_COUNTED[1]
    )


@claim("Sects. 5.2 and 7 (2), Fig. 13")
def count_grows_with_theta(t: Tables) -> Finding:
    """The smaller theta, the fewer precursors come in the first stick phase. With noise of 0.1 % in the
    normal loads: 95 % of the counts lie above 95 % of those of the next smaller theta."""
    low, high = noisy(t, "events_counted", "q05"), noisy(t, "events_counted", "q95")
    return above(low[1:], high[:-1])


@claim("Sects. 5.2 and 7 (2), Figs. 10-12", kind="reading")
def all_events_grow_with_theta(t: Tables) -> Finding:
    """The smaller theta, the fewer events come up to the first global slip, short ones included."""
    return increasing([len(up_to_global(t, scene)) for scene in SCENES])


@claim("Sects. 5.2 and 7 (2), Fig. 13", unit="1/N")
def growth_falls_with_theta(t: Tables) -> Finding:
    """The smaller theta, the faster the length of the events in Fig. 13 grows with the load (blocks/N)."""
    counted = [rows(t[f"{scene}_slips"], counted=True) for scene in SCENES]
    return decreasing([np.polyfit(slips["load_before_N"], slips["front"], 1)[0] for slips in counted])


@claim("Sects. 5.2 and 7 (2), Fig. 13", kind=FOLLOWS, unit="s")
def incubation_falls_with_theta(t: Tables) -> Finding:
    """The smaller theta, the longer the time before the first precursor, mu_s w_1/(K V)."""
    return decreasing(first(t, "onset_s"))


@claim("Sects. 5.2 and 6.2, Fig. 13", fragile=[(TRAILING, "mu_sapp")])
def friction_trailing(t: Tables) -> Finding:
    """theta = -0.833: mu_sapp appears to be 0.49 (to a unit of its last digit)."""
    return equal(mu_sapp(t, TRAILING), paper=printed.MU_SAPP, within=LAST_DIGIT)


@claim("Sects. 5.2 and 6.2, Fig. 13", fragile=[(UNIFORM, "mu_sapp")])
def friction_uniform(t: Tables) -> Finding:
    """theta = 0: mu_sapp appears to be 0.49 (to a unit of its last digit)."""
    return equal(mu_sapp(t, UNIFORM), paper=printed.MU_SAPP, within=LAST_DIGIT)


@claim("Sects. 5.2 and 6.2, Fig. 13", fragile=[(LEADING, "mu_sapp")])
def friction_leading(t: Tables) -> Finding:
    """theta = 0.833: mu_sapp appears to be 0.49 (to a unit of its last digit)."""
    return equal(mu_sapp(t, LEADING), paper=printed.MU_SAPP, within=LAST_DIGIT)


@claim("Sects. 5.2 and 6.2", kind="reading", fragile=FRICTION)
def friction_rounded(t: Tables) -> Finding:
    """mu_sapp of all three normal loadings rounds to 0.49."""
    return rounds_to(mu_sapp(t, *SCENES), paper=printed.MU_SAPP, digits=2)


@claim("Sect. 5.2, Figs. 12 and 13", kind="reading")
def friction_at_printed_theta(t: Tables) -> Finding:
    """With theta = 0.833 as printed, and not 5/6, mu_sapp appears to be 0.49."""
    return equal(
        leading_reading(t, "mu_sapp", degree=f"{printed.THETA}"), paper=printed.MU_SAPP, within=LAST_DIGIT
    )


@claim("Sects. 5.2, 6.2 and 7 (4)", kind="reading", fragile=FRICTION)
def friction_same_in_one_run_each(t: Tables) -> Finding:
    """mu_sapp of one run each is the same for the three normal loadings (to a unit of the last digit
    printed)."""
    return same(mu_sapp(t, *SCENES), within=LAST_DIGIT)


@claim("Sects. 5.2, 6.2 and 7 (4)")
def friction_independent_of_loading(t: Tables) -> Finding:
    """mu_sapp is the same for the three normal loadings (medians of runs with noise of 0.1 % in the normal
    loads, to a unit of the last digit printed)."""
    return same(noisy(t, "mu_sapp", "q50"), within=LAST_DIGIT)


@claim("Sect. 7 (4)", kind="reading", unit="N", fragile=FRICTION)
def load_independent_of_loading(t: Tables) -> Finding:
    """The load F_X that brings about the first global slip is the same for the three normal loadings (to 1 %
    of F_Z)."""
    return same(global_slip_load(t), within=4)


@claim("Sects. 5.1 and 5.2", kind="reading")
def readings(t: Tables) -> Finding:
    """What the paper leaves open (global slip, short event, front, theta) can be read so that all six numbers
    come out, to a unit of the last digit."""
    return equal(t["definitions"]["numbers_within_a_digit"].max(), paper=6)


@claim("Sects. 5.1 and 5.2", kind="reading")
def readings_rounded(t: Tables) -> Finding:
    """It can be read so that all six numbers come out as printed, rounded."""
    return equal(t["definitions"]["numbers_as_printed"].max(), paper=6)
