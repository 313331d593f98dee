"""Errors and open points of the paper, each with the number that it makes a difference of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from precursors.bound import compressions_as_printed, load_bound
from precursors.chain import Chain, linear_weights, theta_from_load_cells
from precursors.exact import TransitionLimitError, simulate
from precursors.integrators import DivergedError, literal
from precursors.run import Run
from precursors.slips import Definition, apparent_friction, find_precursors, find_slips, first_global

# What the paper prints and the model does not contain.
PRINTED_THETA = 0.833
PRINTED_MU_SAPP = 0.49
CELL_LOADS_N = (100.0, 300.0)  # F_ZA and F_ZB of Fig. 7
CELL_SPACING_M = 0.06
SLIP_OF_THE_EXPERIMENT_S = 2e-3

# Fine enough that F_X stays below mu_s w_1 by less than 1e-4 of it, coarse enough for half a second.
LITERAL_STEP_S = 1e-6
# Chains that take longer to slip are not integrated with it.
LONGEST_LITERAL_S = 10.0


@dataclass(frozen=True)
class Entry:
    """An error or open point of the paper.

    Attributes
    ----------
    number : int
        Entries of the same number are one point, in several scenes or quantities.
    where, printed, meant : str
        Place in the paper, what stands there, and what is right or what was taken.
    scene, quantity, unit : str
        Which number it makes a difference of, and in which scene, if in one.
    as_printed, as_meant : float
        That number under the one and the other; NaN where the paper's words give none.
    """

    number: int
    where: str
    printed: str
    meant: str
    scene: str
    quantity: str
    unit: str
    as_printed: float
    as_meant: float


@dataclass(frozen=True)
class _Scene:
    """A run, its slips, and the row of its first global slip (None without one)."""

    run: Run
    slips: pd.DataFrame
    first: int | None

    @classmethod
    def of(cls, run: Run) -> _Scene:
        slips = find_slips(run)
        return cls(run, slips, first_global(slips) if slips["is_global"].any() else None)

    @property
    def up_to_global(self) -> pd.DataFrame:
        return self.slips if self.first is None else self.slips.iloc[: self.first + 1]

    def at_global(self, column: str) -> float:
        return np.nan if self.first is None else float(self.slips[column].iloc[self.first])

    @property
    def mu_sapp(self) -> float:
        found = apparent_friction(self.run, self.slips)
        return found.mu_sapp if found else np.nan


def find_errors(trailing: str, uniform: str, leading: str, runs: Mapping[str, Run]) -> list[Entry]:
    """Errors and open points of the paper, in numbers of its three scenes.

    Parameters
    ----------
    trailing, uniform, leading : str
        Names of the scenes with the larger load at the trailing edge, none, and at the leading edge.
    runs : mapping of str to Run
        The runs of these scenes. Entries about the springs between blocks are left out at N = 1.
    """
    scenes = {name: _Scene.of(runs[name]) for name in (trailing, uniform, leading)}
    return [
        *_last_line_of_eq12(scenes),
        *_wrong_words(uniform, leading, scenes),
        *_normal_loading(leading, scenes[leading]),
        *_one_block(uniform, scenes[uniform].run.chain),
        *_stiffness(uniform, scenes[uniform].run.chain),
        *_slip_duration(scenes),
        *_names(uniform, scenes[uniform]),
        *_time_axis(scenes),
        *_literal_friction(uniform, scenes[uniform]),
        *_rounded_theta(leading, scenes[leading]),
        *_rounded_friction(scenes),
        *_largest_load(scenes),
        *_global_slips_counted(scenes),
        *_simultaneous(scenes),
        *_open_definitions(trailing, leading, scenes),
    ]


def _last_line_of_eq12(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        chain = scene.run.chain
        yield Entry(
            1,
            "Eq. 12, last line",
            "K y_N - f_smax = 0",
            "k y_N - f_smax = 0",
            name,
            "F_X of the state of Eq. 12",
            "N",
            float(chain.drive_stiffness * compressions_as_printed(chain)[0]),
            load_bound(chain),
        )


def _wrong_words(uniform: str, leading: str, scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    theta = theta_from_load_cells(*CELL_LOADS_N, CELL_SPACING_M, scenes[leading].run.chain.length)
    yield Entry(
        2,
        "Fig. 8, caption",
        "open circle: uniform loading (100 and 300 N)",
        "non-uniform loading",
        leading,
        "theta",
        "1",
        0.0,
        theta,
    )
    short = sum(len(s.up_to_global) - len(find_precursors(s.slips)) for s in scenes.values())
    yield Entry(
        3,
        "Sect. 5.2",
        '"the latter figure" (Fig. 8) leaves short events out',
        "Fig. 13 does; none was observed in the experiment (Sect. 6.1)",
        "",
        "short events left out, three scenes",
        "1",
        0.0,
        float(short),
    )
    scene = scenes[uniform]
    drive = scene.run.chain.drive_velocity * scene.at_global("onset")
    yield Entry(
        4,
        "Sect. 5.1",
        "trailing edge at i = 0",
        "i = 1: the point of index 0 is the drive (Eq. 3)",
        uniform,
        "displacement of that point at the first global slip",
        "m",
        drive,
        drive - scene.at_global("load_before") / scene.run.chain.drive_stiffness,
    )


def _normal_loading(leading: str, scene: _Scene) -> Iterator[Entry]:
    """Eq. 7 puts 1 -+ theta at the centres of the outer blocks; Sect. 2 has the loads at two cells."""
    chain = scene.run.chain
    if chain.n_blocks == 1:
        return
    theta = theta_from_load_cells(*CELL_LOADS_N, CELL_SPACING_M, chain.length)
    offset = (np.arange(chain.n_blocks) + 0.5) * chain.length / chain.n_blocks - chain.length / 2
    cells = np.array([-1, 1]) * CELL_SPACING_M / 2
    # The line of Eq. 7, which passes through the block centres; beyond them for N = 2.
    at_cells = 1 + theta * cells / offset[-1]
    moment = float(linear_weights(chain.n_blocks, 1.0, 1.0) @ offset)
    share = (CELL_LOADS_N[1] - CELL_LOADS_N[0]) / sum(CELL_LOADS_N)
    point = (5, "Eq. 7 and Sect. 5.2")
    straight = "Eq. 7 with the straight line through the load cells"
    yield Entry(
        *point,
        straight,
        "the loads that the cells read",
        leading,
        "ratio of the normal loads at the load cells",
        "1",
        float(at_cells[1] / at_cells[0]),
        CELL_LOADS_N[1] / CELL_LOADS_N[0],
    )
    yield Entry(
        *point,
        straight,
        "balance of moments, blocks",
        leading,
        "theta",
        "1",
        theta,
        share * CELL_SPACING_M / 2 / moment,
    )
    yield Entry(
        *point,
        straight,
        "balance of moments, continuous line contact",
        leading,
        "theta",
        "1",
        theta,
        share * CELL_SPACING_M / 2 / (chain.length / 6),
    )


def _one_block(uniform: str, chain: Chain) -> Iterator[Entry]:
    yield Entry(
        6,
        "Eq. 7 and Sect. 6.2",
        "N = 1 in Eq. 7: 0/0",
        "the block has the whole normal load",
        uniform,
        "w_1 at N = 1",
        "N",
        np.nan,
        float(linear_weights(1, chain.normal_load, 0.0)[0]),
    )


def _stiffness(uniform: str, chain: Chain) -> Iterator[Entry]:
    if chain.n_blocks == 1:
        return
    yield Entry(
        7,
        "Eq. 10",
        "N blocks with springs k = N E S/L between them: N - 1 springs",
        "E S/L",
        uniform,
        "stiffness of the slider from end to end",
        "N/m",
        chain.stiffness / (chain.n_blocks - 1),
        chain.stiffness / chain.n_blocks,
    )


def _slip_duration(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        yield Entry(
            8,
            "Sects. 3.2.1 and 5.1",
            "F_X is simulated well; a slip of the experiment lasts about 2 ms",
            "the model's is shorter",
            name,
            "duration of the first global slip",
            "s",
            SLIP_OF_THE_EXPERIMENT_S,
            scene.at_global("end") - scene.at_global("onset"),
        )


def _names(uniform: str, scene: _Scene) -> Iterator[Entry]:
    friction, strength = scene.mu_sapp, float(scene.run.chain.strength[0])
    yield Entry(
        9,
        "Eq. 1 and list of symbols",
        "mu_app",
        "mu_sapp, the same",
        uniform,
        "F_Xmax/F_Z",
        "1",
        friction,
        friction,
    )
    yield Entry(9, "Eqs. 5 and 12", "f_max", "f_smax, the same", uniform, "mu_s w_1", "N", strength, strength)


def _time_axis(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        yield Entry(
            10,
            "Figs. 10-12",
            "the text does not say what time they span",
            "ours, which holds the first global slip",
            name,
            "time simulated",
            "s",
            np.nan,
            scene.run.duration,
        )


def _literal_friction(uniform: str, scene: _Scene) -> Iterator[Entry]:
    printed, end = np.nan, scene.at_global("end")
    if end <= LONGEST_LITERAL_S:
        with suppress(DivergedError, TransitionLimitError):
            found = literal.solve(scene.run.chain, end, LITERAL_STEP_S)
            printed = float(found.run.transitions["tangential_load"].max())
    yield Entry(
        11,
        "Eq. 4 and Sect. 4.2.2",
        "static friction where the velocity is 0: met by no step of Runge-Kutta, no block sticks again",
        "a block whose velocity crosses 0 sticks if Eq. 5 allows it",
        uniform,
        "largest F_X up to the first global slip",
        "N",
        printed,
        scene.mu_sapp * scene.run.chain.normal_load,
    )


def _rounded_theta(leading: str, scene: _Scene) -> Iterator[Entry]:
    chain = scene.run.chain
    printed = replace(chain, weights=linear_weights(chain.n_blocks, chain.normal_load, PRINTED_THETA))
    rounded = _Scene.of(simulate(printed, scene.run.duration, "global slip"))
    for quantity, unit, number in (
        ("events kept", "1", lambda s: float(len(find_precursors(s.slips)))),
        ("mu_sapp", "1", lambda s: s.mu_sapp),
        ("time of the first global slip", "s", lambda s: s.at_global("onset")),
    ):
        yield Entry(
            12,
            "Sect. 5.2 and Figs. 11, 12",
            "theta = 0.833",
            "5/6, from the load cells",
            leading,
            quantity,
            unit,
            number(rounded),
            number(scene),
        )


def _rounded_friction(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        yield Entry(
            13,
            "Sect. 5.2",
            "mu_sapp = 0.49 for every normal loading",
            "between 0.48 and 0.49",
            name,
            "mu_sapp",
            "1",
            PRINTED_MU_SAPP,
            scene.mu_sapp,
        )


def _largest_load(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        loads = scene.run.transitions["tangential_load"]
        yield Entry(
            14,
            "Eq. 1 and Sect. 3.2.2",
            "F_Xmax, the maximum of F_X, is observed at the first global slip",
            "a later global slip has the maximum",
            name,
            "largest F_X: up to the first global slip, and in all",
            "N",
            scene.mu_sapp * scene.run.chain.normal_load,
            float(loads.max()) if len(loads) else np.nan,
        )


def _global_slips_counted(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        kept = find_precursors(scene.slips)
        yield Entry(
            15,
            "Sects. 3.2.2 and 5.2",
            '"number of precursor events (including one global slip)"',
            "precursors of a global slip: without it",
            name,
            "number of precursor events",
            "1",
            float(len(kept)),
            float((~kept["is_global"]).sum()),
        )


def _simultaneous(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        partial = scene.up_to_global[~scene.up_to_global["is_global"]]
        yield Entry(
            16,
            "Abstract, Sects. 1, 5.1 and 7",
            "a precursor is a simultaneous slip of some of the masses",
            "in some, those at the trailing edge stick before the farthest slides",
            name,
            "precursors whose blocks never slide all at once",
            "1",
            0.0,
            float((partial["n_slid"] > partial["n_simultaneous"]).sum()),
        )


def _open_definitions(trailing: str, leading: str, scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    def kept(name: str, definition: Definition) -> float:
        scene = scenes[name]
        read = definition.read(scene.slips, scene.run.chain.n_blocks)
        return float(len(find_precursors(read, definition.short)))

    yield Entry(
        17,
        "Sects. 1 and 5.1",
        "global slip: not defined; every block may slide at some time",
        "all at the same instant",
        trailing,
        "events kept",
        "1",
        kept(trailing, Definition("each")),
        kept(trailing, Definition()),
    )
    for printed, short in (
        ("short event: not defined for equal lengths; dropped", "not longer"),
        ("short event: smaller than the previous precursor", "shorter than the last"),
    ):
        yield Entry(
            18,
            "Sects. 5.2 and 6.1",
            printed,
            "shorter than one before; equal ones stay",
            leading,
            "events kept",
            "1",
            kept(leading, Definition(short=short)),
            kept(leading, Definition()),
        )
