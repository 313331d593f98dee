"""What Sects. 6 and 7 state, the experiment beside the model, misprints and open points."""

from __future__ import annotations

import numpy as np
import pandas as pd

from precursors.model import printed
from precursors.model.chain import linear_weights, theta_from_load_cells
from precursors.model.printed import CELL_LOADS_N, CELL_SPACING_M
from precursors.reproduction import eq15
from precursors.reproduction.claim import (
    FOLLOWS,
    Finding,
    above,
    at_least,
    at_most,
    below,
    claim,
    decreasing,
    equal,
    instead_of,
    not_computed,
)
from precursors.reproduction.claims_results import (
    EXACT,
    counted,
    first,
    global_slip_load,
    leading_reading,
    measure,
    mu_sapp,
    noisy,
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

# L_p/L from which the length of the experiment's precursors grows faster (Sect. 6.1).
KINK = 0.7


def largest_load(t: Tables) -> list[float]:
    """Largest F_X of each scene in all the time simulated [N]."""
    return [t[f"{scene}_trace"]["tangential_load_N"].max() for scene in SCENES]


def growth(slips: pd.DataFrame) -> tuple[float, float]:
    """Growth of L_p/L with the load [1/N] before and after the last event of Fig. 13 with L_p/L <= KINK.

    It ends with the first event of the whole length: from there on the length cannot grow.
    """
    counted = rows(slips, counted=True)
    length, load = (counted["front"] / counted["n_blocks"]).to_numpy(), counted["load_before_N"].to_numpy()
    until = int(np.argmax(length == length.max())) + 1
    length, load = length[:until], load[:until]
    kink = np.flatnonzero(length <= KINK)[-1]
    rise, span = np.diff(length[[0, kink, -1]]), np.diff(load[[0, kink, -1]])
    return rise[0] / span[0], rise[1] / span[1]


def share_with_precursors(slips: pd.DataFrame) -> float:
    """Share of the stick phases between global slips that have a partial slip."""
    events = np.diff(np.flatnonzero(slips["is_global"]))
    return float(np.mean(events > 1))


def theta_of_cells(t: Tables) -> float:
    """theta of the straight line through the load cells of Fig. 7."""
    return theta_from_load_cells(*CELL_LOADS_N, CELL_SPACING_M, first(t, "length_m")[0])


def cell_moment(t: Tables) -> float:
    """Moment of the loads of the cells about the middle of the contact, over F_Z L."""
    low, high = CELL_LOADS_N
    return (high - low) / (high + low) * CELL_SPACING_M / 2 / first(t, "length_m")[0]


def checked(t: Tables, check: str, column: str = "found") -> np.ndarray:
    """A column of a check of Eq. 15 for the three scenes."""
    return np.array([one(t["eq15"], column, check=check, case=scene) for scene in SCENES], dtype=float)


# Sect. 6.1: mechanism, and the experiment beside the model


@claim("Sects. 5.2 and 6.1")
def short_events(t: Tables) -> Finding:
    """The simulation has short events before the first global slip, which Fig. 13 leaves out."""
    return above([len(rows(before_global(t, scene), counted=False)) for scene in SCENES], 0)


@claim("Sect. 6.1")
def static_and_kinetic_friction(t: Tables) -> Finding:
    """The difference between static and kinetic friction is the essence of the precursors: their number
    depends on it (median of the events in Fig. 13 over theta, at the least and the largest difference)."""
    grid = t["map_theta_friction_ratio"].dropna(subset=["events_counted"])
    medians = grid.groupby("friction_ratio")["events_counted"].median().sort_index(ascending=False)
    return decreasing(medians.iloc[[0, -1]])


@claim("Sects. 3.2.1 and 5.1")
def precursors_in_later_periods(t: Tables) -> Finding:
    """Precursors come in the later stick phases of uniform loading, too (in more than half of the phases
    between two global slips: their share)."""
    return above(share_with_precursors(t["fig10_slips"]), 0.5)


@claim("Sect. 6.1, Figs. 8 and 13", kind="experiment", unit="1/N")
def no_kink(t: Tables) -> Finding:
    """The fast growth of the experiment beyond L_p/L = 0.7 is missing from the simulation; its length grows
    no faster there."""
    slopes = [growth(t[f"{scene}_slips"]) for scene in SCENES]
    return at_most([beyond for _, beyond in slopes], [before for before, _ in slopes])


@claim("Sects. 3.2.2 and 6.1, Fig. 8", kind="experiment")
def counts_of_the_experiment(t: Tables) -> Finding:
    """Simulation and experiment are similar, which has 11, 19 and 27 events, the global slip included."""
    return equal(counted(t, *SCENES), paper=list(printed.EVENTS_OF_EXPERIMENT.values()))


@claim("Sects. 3.2.1 and 5.1, Fig. 4", kind="experiment", unit="N")
def load_of_the_experiment(t: Tables) -> Finding:
    """F_X of the experiment is simulated well, whose first global slip comes at about 200 N under uniform
    loading (to 5 %)."""
    return equal(up_to_global(t, UNIFORM)["load_before_N"].iloc[-1], paper=200, relative=0.05)


@claim("Sects. 3.2.1 and 5.1", kind="experiment", unit="s")
def slip_duration_of_the_experiment(t: Tables) -> Finding:
    """F_X of the experiment is simulated well, whose global slips last about 2 ms (to 25 %)."""
    last = [up_to_global(t, scene).iloc[-1] for scene in SCENES]
    return equal([slip["end_s"] - slip["onset_s"] for slip in last], paper=0.002, relative=0.25)


@claim("Sect. 3.2.2, Eq. 1", kind="experiment", unit="N")
def largest_load_at_first_global_slip(t: Tables) -> Finding:
    """In the model, too, the maximum of F_X is at the first global slip, as observed in the experiment (over
    the 10 s simulated)."""
    return at_least(global_slip_load(t), largest_load(t))


@claim("Sects. 3.2.1 and 7 (1)", kind="experiment")
def contact_area(t: Tables) -> Finding:
    """A precursor is a sharp decrease in the real contact area, seen in the transmitted light."""
    return not_computed()


@claim("Sects. 3.1 and 6.1, Fig. 2", kind="experiment", unit="s")
def ageing(t: Tables) -> Finding:
    """The real contact area ages in stationary contact, with a relaxation time of about 200 s."""
    return not_computed(paper=200)


@claim("Sect. 6.1", kind="experiment")
def curvature(t: Tables) -> Finding:
    """The kink at L_p/L = 0.7 may come from a smaller normal load at the leading edge, by a curvature of the
    surfaces."""
    return not_computed()


@claim("Sects. 3.2.2 and 6.2", kind="experiment")
def friction_of_the_experiment(t: Tables) -> Finding:
    """The experiment has mu_sapp = 0.49 for its three normal loadings."""
    return not_computed(paper=printed.MU_SAPP)


# Sect. 6.2: apparent and real static friction


@claim("Abstract, Sects. 6.2 and 7 (4)")
def due_to_residual_strain(t: Tables) -> Finding:
    """mu_sapp is below mu_s due to the residual strain: so it is lower from a state of much strain (maximal)
    than from one of less (mu_sapp of the scenes, which start without)."""
    return below(checked(t, eq15.FULL_STRAIN), mu_sapp(t, *SCENES))


@claim("Sect. 6.2")
def waves(t: Tables) -> Finding:
    """Waves induce the global slip before the strain is maximal: a chain without waves, the overdamped
    cascade, has another mu_sapp (error against the median of noisy runs, above the models' tolerance)."""
    own = rows(t["model_comparison"], model="overdamped", question="mu_sapp")
    without = np.array([one(own, "value", scene=scene) for scene in SCENES])
    return above(abs(without / noisy(t, "mu_sapp", "q50") - 1.0), own["tolerance"].iloc[0])


@claim("Sects. 6.2 and 7 (4)")
def friction_underestimated(t: Tables) -> Finding:
    """mu_sapp is smaller than mu_s for the three normal loadings."""
    return below(mu_sapp(t, *SCENES), measure(t, "mu_s"))


@claim("Sect. 6.2")
def residual_strain_below_its_maximum(t: Tables) -> Finding:
    """The first global slip comes before the residual strain is at its maximum (1 is the maximum, Eq. 12)."""
    return below(measure(t, "residual_strain"), 1)


@claim("Sect. 6.2", kind=FOLLOWS)
def rigid_body(t: Tables) -> Finding:
    """A rigid slider (N = 1) has mu_sapp = mu_s."""
    return equal(float(one(t["eq15"], "found", check=eq15.RIGID)), to=measure(t, "mu_s")[0], relative=EXACT)


@claim("Sect. 6.2, Eqs. 13 and 14", kind=FOLLOWS)
def eq13(t: Tables) -> Finding:
    """With all blocks at their limit (Eq. 12 corrected) F_X = mu_s F_Z, in symbols for ten blocks with any
    normal loads (1: it is so)."""
    return equal(rows(t["eq15"], check=eq15.AT_LIMIT)["holds"].astype(float), to=1)


@claim("Sect. 6.2, Eqs. 14 and 15", kind=FOLLOWS, unit="N")
def eq15_at_rest(t: Tables) -> Finding:
    """No state of rest has more than mu_s F_Z, whatever the normal loads (the largest, by linear
    programming)."""
    return equal(checked(t, eq15.AT_REST), to=checked(t, eq15.AT_REST, "expected"), relative=1e-9)


@claim("Sect. 6.2, Eq. 15", unit="N")
def eq15_in_motion(t: Tables) -> Finding:
    """F_X never exceeds mu_s F_Z in the time simulated."""
    return at_most(largest_load(t), np.multiply(measure(t, "mu_s"), measure(t, "normal_load_N")))


@claim("Sect. 6.2, Eq. 15", kind=FOLLOWS)
def eq15_equality(t: Tables) -> Finding:
    """A chain pushed from the state of maximal residual strain has mu_sapp = mu_s, whatever the normal
    loading."""
    return equal(checked(t, eq15.FULL_STRAIN), to=measure(t, "mu_s"), relative=EXACT)


@claim("Sect. 6.2, Eq. 15", kind=FOLLOWS)
def eq15_inequality(t: Tables) -> Finding:
    """A chain pushed from slightly less residual strain has mu_sapp < mu_s."""
    return below(checked(t, eq15.LESS_STRAIN), measure(t, "mu_s"))


# Misprints: what the words give as printed, and what is right


@claim("Sect. 6.2, Eq. 12", kind="misprint", unit="N")
def eq12_last_line(t: Tables) -> Finding:
    """Printed: K y_N in the last line. Right: k y_N (F_X of the state of Eq. 12). Our text of the paper was
    read by a machine, which may have made a K of a k."""
    return instead_of(checked(t, eq15.AS_PRINTED), checked(t, eq15.AT_REST, "expected"))


@claim("Fig. 8, caption", kind="misprint")
def fig8_caption(t: Tables) -> Finding:
    """Printed: uniform loading for the open circles (F_ZA = 100 N, F_ZB = 300 N). Right: non-uniform loading
    (theta)."""
    return instead_of(0, first(t, "theta")[-1])


@claim("Sect. 5.2", kind="misprint")
def latter_figure(t: Tables) -> Finding:
    """Printed: the latter figure, which is Fig. 8, leaves short events out. Right: Fig. 13 does; the
    experiment has none (short events of the three scenes)."""
    return instead_of(0, sum(len(rows(before_global(t, scene), counted=False)) for scene in SCENES))


@claim("Eqs. 1 and 5", kind="misprint")
def two_names(t: Tables) -> Finding:
    """Printed: mu_app and f_max. Right: mu_sapp and f_smax, as elsewhere."""
    return instead_of([], [])


# Open points: what the words may mean or give, and what is meant or taken


@claim("Sects. 1 and 5.1", kind="open point")
def global_slip(t: Tables) -> Finding:
    """Global slip is not defined. Taken: all blocks slide at the same instant. As printed: every block may
    slide at some time (events in Fig. 13, theta = -0.833)."""
    each = "largest F_X up to the first event in which every block slides at some time"
    other = one(t["mu_sapp"], "events_counted", scene=TRAILING, definition=each)
    return instead_of(other, counted(t, TRAILING))


@claim("Sects. 5.2 and 6.1", kind="open point")
def short_events_of_equal_length(t: Tables) -> Finding:
    """Short event is not defined for equal lengths. Taken: they stay. As printed: they may be dropped (events
    in Fig. 13, theta = 0.833)."""
    other = leading_reading(t, "events_counted", short="not longer than all before it")
    return instead_of(other, counted(t, LEADING))


@claim("Sects. 5.2 and 6.1", kind="open point")
def short_events_by_the_previous_one(t: Tables) -> Finding:
    """A short event is "smaller than that of the previous precursors". Taken: shorter than one before. As
    printed: it may be shorter than the last one (events in Fig. 13, theta = 0.833)."""
    other = leading_reading(t, "events_counted", short="shorter than the one just before it")
    return instead_of(other, counted(t, LEADING))


@claim("Sects. 3.2.2 and 5.2", kind="open point")
def global_slip_counted(t: Tables) -> Finding:
    """The "number of precursor events (including one global slip)" is counted as printed. Precursors of a
    global slip would be counted without it."""
    without = [int((rows(up_to_global(t, s), counted=True)["is_global"] == 0).sum()) for s in SCENES]
    return instead_of(counted(t, *SCENES), without)


@claim("Figs. 10-12", kind="open point", unit="s")
def time_axis(t: Tables) -> Finding:
    """Our text of the paper does not say what time the figures span. Taken: a time that holds the first
    global slip (time simulated)."""
    return instead_of([], [t[f"{scene}_trace"]["time_s"].iloc[-1] for scene in SCENES])


@claim("Eq. 7 and Sect. 5.2", kind="open point")
def ratio_at_the_load_cells(t: Tables) -> Finding:
    """Eq. 7 has 1 -+ theta at the centres of the outer blocks, and theta = 5/6 is of the straight line
    through the load cells, 60 mm apart. Meant: the loads of the cells (ratio of the normal loads at the
    cells)."""
    n, theta = first(t, "n_blocks")[0], theta_of_cells(t)
    at_cells = theta * (CELL_SPACING_M / first(t, "length_m")[0]) / (1 - 1 / n)
    return instead_of((1 + at_cells) / (1 - at_cells), CELL_LOADS_N[1] / CELL_LOADS_N[0])


@claim("Eq. 7 and Sect. 5.2", kind="open point")
def theta_by_moments_of_blocks(t: Tables) -> Finding:
    """theta is the straight line through the load cells. It may be the balance of moments with the cells, ten
    blocks (theta)."""
    n = int(first(t, "n_blocks")[0])
    centres = (np.arange(n) + 0.5) / n - 0.5
    return instead_of(theta_of_cells(t), cell_moment(t) / float(linear_weights(n, 1.0, 1.0) @ centres))


@claim("Eq. 7 and Sect. 5.2", kind="open point")
def theta_by_moments_of_a_line(t: Tables) -> Finding:
    """theta is the straight line through the load cells. It may be the balance of moments with the cells, a
    continuous line contact (theta)."""
    return instead_of(theta_of_cells(t), cell_moment(t) / (1 / 6))


@claim("Eq. 7 and Sect. 6.2", kind="open point", unit="N")
def one_block(t: Tables) -> Finding:
    """Eq. 7 is 0/0 for N = 1. Taken: the block has the whole normal load (w_1)."""
    return instead_of(np.nan, linear_weights(1, measure(t, "normal_load_N")[0], 0.0))


@claim("Eq. 10", kind="open point", unit="N/m")
def stiffness_of_the_slider(t: Tables) -> Finding:
    """N blocks with springs k = N E S/L have N - 1 springs between them. Meant: E S/L (stiffness of the
    slider from end to end)."""
    n, k = first(t, "n_blocks")[0], measure(t, "stiffness_N_per_m")[0]
    return instead_of(k / (n - 1), k / n)
