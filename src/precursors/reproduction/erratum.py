"""Misprints and open points of the paper, each with the number that it makes a difference of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.slip_rows import first_global, up_to_first_global
from precursors.analysis.slips import Definition, apparent_friction, find_precursors, find_slips
from precursors.methods import DivergedError, literal
from precursors.model import printed
from precursors.model.chain import Chain, linear_weights, theta_from_load_cells
from precursors.model.statics import compressions_as_printed, load_bound
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError, simulate

MISPRINT, OPEN = "misprint", "open point"
# Fine enough that F_X stays below mu_s w_1 by less than 1e-4 of it, coarse enough for half a second.
LITERAL_STEP_S = 1e-6
# A step so fine that F_X goes beyond mu_s w_1, and how long it is followed.
FINE_LITERAL_STEP_S, FINE_LITERAL_END_S = 1e-8, 0.45
# Chains that take longer to slip are not integrated with it.
LONGEST_LITERAL_S = 10.0


@dataclass(frozen=True)
class Entry:
    """A misprint or open point of the paper.

    Attributes
    ----------
    number : int
        Entries of the same number are one point, in several scenes or quantities.
    kind : {"misprint", "open point"}
        Whether other words must stand there, or the paper leaves open what is meant, or the model differs.
    where, printed, meant : str
        Place in the paper, what stands there, and what is right or what was taken.
    scene, quantity, unit : str
        Which number it makes a difference of, and in which scene, if in one.
    as_printed, as_meant : float
        That number under the one and the other; NaN where the paper's words give none, or only a second name.
    """

    number: int
    kind: str
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
        return cls(run, slips, first_global(slips))

    @property
    def up_to_global(self) -> pd.DataFrame:
        return up_to_first_global(self.slips)

    def at_global(self, column: str) -> float:
        return np.nan if self.first is None else float(self.slips[column].iloc[self.first])

    @property
    def mu_sapp(self) -> float:
        found = apparent_friction(self.run, self.slips)
        return found.mu_sapp if found else np.nan


def find_errors(trailing: str, uniform: str, leading: str, runs: Mapping[str, Run]) -> list[Entry]:
    """Misprints of the paper, then its open points, in numbers of its three scenes.

    Parameters
    ----------
    trailing, uniform, leading : str
        Names of the scenes with the larger load at the trailing edge, none, and at the leading edge.
    runs : mapping of str to Run
        The runs of these scenes. Entries about the springs between blocks are left out at N = 1.
    """
    scenes = {name: _Scene.of(runs[name]) for name in (trailing, uniform, leading)}
    entries = [
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
    return sorted(entries, key=lambda entry: entry.kind != MISPRINT)


def _last_line_of_eq12(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        chain = scene.run.chain
        yield Entry(
            number=1,
            kind=MISPRINT,
            where="Eq. 12, last line",
            printed="K y_N - f_smax = 0",
            meant="k y_N - f_smax = 0",
            scene=name,
            quantity="F_X of the state of Eq. 12",
            unit="N",
            as_printed=float(chain.drive_stiffness * compressions_as_printed(chain)[0]),
            as_meant=load_bound(chain),
        )


def _wrong_words(uniform: str, leading: str, scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    theta = theta_from_load_cells(
        *printed.CELL_LOADS_N, printed.CELL_SPACING_M, scenes[leading].run.chain.length
    )
    yield Entry(
        number=2,
        kind=MISPRINT,
        where="Fig. 8, caption",
        printed="open circle: uniform loading (100 and 300 N)",
        meant="non-uniform loading",
        scene=leading,
        quantity="theta",
        unit="1",
        as_printed=0.0,
        as_meant=theta,
    )
    short = sum(len(s.up_to_global) - len(find_precursors(s.slips)) for s in scenes.values())
    yield Entry(
        number=3,
        kind=MISPRINT,
        where="Sect. 5.2",
        printed='"the latter figure" (Fig. 8) leaves short events out',
        meant="Fig. 13 does; none was observed in the experiment (Sect. 6.1)",
        scene="",
        quantity="short events left out, three scenes",
        unit="1",
        as_printed=0.0,
        as_meant=float(short),
    )
    scene = scenes[uniform]
    drive = scene.run.chain.drive_velocity * scene.at_global("onset")
    yield Entry(
        number=4,
        kind=MISPRINT,
        where="Sect. 5.1",
        printed="trailing edge at i = 0",
        meant="i = 1: the point of index 0 is the drive (Eq. 3)",
        scene=uniform,
        quantity="displacement of that point at the first global slip",
        unit="m",
        as_printed=drive,
        as_meant=drive - scene.at_global("load_before") / scene.run.chain.drive_stiffness,
    )


def theta_of_cells(chain: Chain) -> float:
    """Theta of the paper's load cells on the contact of a chain."""
    return theta_from_load_cells(*printed.CELL_LOADS_N, printed.CELL_SPACING_M, chain.length)


def _normal_loading(leading: str, scene: _Scene) -> Iterator[Entry]:
    """Eq. 7 puts 1 -+ theta at the centres of the outer blocks; Sect. 2 has the loads at two cells."""
    chain = scene.run.chain
    if chain.n_blocks == 1:
        return
    theta = theta_of_cells(chain)
    offset = (np.arange(chain.n_blocks) + 0.5) * chain.length / chain.n_blocks - chain.length / 2
    cells = np.array([-1, 1]) * printed.CELL_SPACING_M / 2
    # The line of Eq. 7, which passes through the block centres; beyond them for N = 2.
    at_cells = 1 + theta * cells / offset[-1]
    moment = float(linear_weights(chain.n_blocks, 1.0, 1.0) @ offset)
    share = (printed.CELL_LOADS_N[1] - printed.CELL_LOADS_N[0]) / sum(printed.CELL_LOADS_N)
    point: dict[str, Any] = {"number": 5, "kind": OPEN, "where": "Eq. 7 and Sect. 5.2"}
    straight = "Eq. 7 with the straight line through the load cells"
    yield Entry(
        printed=straight,
        meant="the loads that the cells read",
        scene=leading,
        quantity="ratio of the normal loads at the load cells",
        unit="1",
        as_printed=float(at_cells[1] / at_cells[0]),
        as_meant=printed.CELL_LOADS_N[1] / printed.CELL_LOADS_N[0],
        **point,
    )
    yield Entry(
        printed=straight,
        meant="balance of moments, blocks",
        scene=leading,
        quantity="theta",
        unit="1",
        as_printed=theta,
        as_meant=share * printed.CELL_SPACING_M / 2 / moment,
        **point,
    )
    yield Entry(
        printed=straight,
        meant="balance of moments, continuous line contact",
        scene=leading,
        quantity="theta",
        unit="1",
        as_printed=theta,
        as_meant=share * printed.CELL_SPACING_M / 2 / (chain.length / 6),
        **point,
    )


def _one_block(uniform: str, chain: Chain) -> Iterator[Entry]:
    yield Entry(
        number=6,
        kind=OPEN,
        where="Eq. 7 and Sect. 6.2",
        printed="N = 1 in Eq. 7: 0/0",
        meant="the block has the whole normal load",
        scene=uniform,
        quantity="w_1 at N = 1",
        unit="N",
        as_printed=np.nan,
        as_meant=float(linear_weights(1, chain.normal_load, 0.0)[0]),
    )


def _stiffness(uniform: str, chain: Chain) -> Iterator[Entry]:
    if chain.n_blocks == 1:
        return
    yield Entry(
        number=7,
        kind=OPEN,
        where="Eq. 10",
        printed="N blocks with springs k = N E S/L between them: N - 1 springs",
        meant="E S/L",
        scene=uniform,
        quantity="stiffness of the slider from end to end",
        unit="N/m",
        as_printed=chain.stiffness / (chain.n_blocks - 1),
        as_meant=chain.stiffness / chain.n_blocks,
    )


def _slip_duration(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        yield Entry(
            number=8,
            kind=OPEN,
            where="Sects. 3.2.1 and 5.1",
            printed="F_X is simulated well; a slip of the experiment lasts about 2 ms",
            meant="the model's is shorter",
            scene=name,
            quantity="duration of the first global slip",
            unit="s",
            as_printed=printed.SLIP_DURATION_S,
            as_meant=scene.at_global("end") - scene.at_global("onset"),
        )


def _names(uniform: str, scene: _Scene) -> Iterator[Entry]:
    friction, strength = scene.mu_sapp, float(scene.run.chain.strength[0])
    yield Entry(
        number=9,
        kind=MISPRINT,
        where="Eq. 1 and list of symbols",
        printed="mu_app",
        meant="mu_sapp, the same; no number changes",
        scene=uniform,
        quantity="F_Xmax/F_Z",
        unit="1",
        as_printed=np.nan,
        as_meant=friction,
    )
    yield Entry(
        number=9,
        kind=MISPRINT,
        where="Eqs. 5 and 12",
        printed="f_max",
        meant="f_smax, the same; no number changes",
        scene=uniform,
        quantity="mu_s w_1",
        unit="N",
        as_printed=np.nan,
        as_meant=strength,
    )


def _time_axis(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        yield Entry(
            number=10,
            kind=OPEN,
            where="Figs. 10-12",
            printed="the text does not say what time they span",
            meant="ours, which holds the first global slip; no number of the paper changes",
            scene=name,
            quantity="time simulated",
            unit="s",
            as_printed=np.nan,
            as_meant=scene.run.duration,
        )


def _literal_friction(uniform: str, scene: _Scene) -> Iterator[Entry]:
    largest, end = np.nan, scene.at_global("end")
    if end <= LONGEST_LITERAL_S:
        with suppress(DivergedError, TransitionLimitError):
            found = literal.solve(scene.run.chain, end, LITERAL_STEP_S)
            largest = float(found.run.transitions["tangential_load"].max())
    yield Entry(
        number=11,
        kind=OPEN,
        where="Eq. 4 and Sect. 4.2.2",
        printed="static friction where the velocity is 0: met by no step of Runge-Kutta, "
        f"no block sticks again in steps of {LITERAL_STEP_S * 1e6:g} µs; {_finer_steps(scene.run.chain)}",
        meant="a block whose velocity crosses 0 sticks if Eq. 5 allows it",
        scene=uniform,
        quantity=f"largest F_X up to the first global slip, in steps of {LITERAL_STEP_S * 1e6:g} µs",
        unit="N",
        as_printed=largest,
        as_meant=scene.mu_sapp * scene.run.chain.normal_load,
    )


def _finer_steps(chain: Chain) -> str:
    """What comes of Eq. 4 as printed in finer steps, in words."""
    words = f"at {FINE_LITERAL_STEP_S:.0e} s by {FINE_LITERAL_END_S:g} s"
    try:
        found = literal.solve(chain, FINE_LITERAL_END_S, FINE_LITERAL_STEP_S).run.transitions
    except (DivergedError, TransitionLimitError) as error:
        return f"{words}: {error}"
    if not len(found):
        return f"no slip {words}"
    sticks = int((found["mode"] == 0).sum())
    largest = f"{found['tangential_load'].max():.1f} N"
    return f"{largest} {words}, " + (f"and {sticks} sticks" if sticks else "still without a stick")


def _rounded_theta(leading: str, scene: _Scene) -> Iterator[Entry]:
    chain = scene.run.chain
    as_printed = replace(chain, weights=linear_weights(chain.n_blocks, chain.normal_load, printed.THETA))
    rounded = _Scene.of(simulate(as_printed, scene.run.duration, "global slip"))
    for quantity, unit, number in (
        ("events kept", "1", lambda s: float(len(find_precursors(s.slips)))),
        ("mu_sapp", "1", lambda s: s.mu_sapp),
        ("time of the first global slip", "s", lambda s: s.at_global("onset")),
    ):
        yield Entry(
            number=12,
            kind=MISPRINT,
            where="Sect. 5.2 and Figs. 11, 12",
            printed=f"theta = {printed.THETA:g}",
            meant="5/6, from the load cells",
            scene=leading,
            quantity=quantity,
            unit=unit,
            as_printed=number(rounded),
            as_meant=number(scene),
        )


def _rounded_friction(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        yield Entry(
            number=13,
            kind=OPEN,
            where="Sect. 5.2",
            printed=f"mu_sapp = {printed.MU_SAPP:g} for every normal loading",
            meant="between 0.48 and 0.49",
            scene=name,
            quantity="mu_sapp",
            unit="1",
            as_printed=printed.MU_SAPP,
            as_meant=scene.mu_sapp,
        )


def _largest_load(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        loads = scene.run.transitions["tangential_load"]
        yield Entry(
            number=14,
            kind=OPEN,
            where="Eq. 1 and Sect. 3.2.2",
            printed="F_Xmax, the maximum of F_X, is observed at the first global slip",
            meant="so in the experiment; differs in the model: a later global slip has the maximum",
            scene=name,
            quantity="largest F_X: up to the first global slip, and in all",
            unit="N",
            as_printed=scene.mu_sapp * scene.run.chain.normal_load,
            as_meant=float(loads.max()) if len(loads) else np.nan,
        )


def _global_slips_counted(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        kept = find_precursors(scene.slips)
        yield Entry(
            number=15,
            kind=OPEN,
            where="Sects. 3.2.2 and 5.2",
            printed='"number of precursor events (including one global slip)"',
            meant="precursors of a global slip: without it",
            scene=name,
            quantity="number of precursor events",
            unit="1",
            as_printed=float(len(kept)),
            as_meant=float((~kept["is_global"]).sum()),
        )


def _simultaneous(scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    for name, scene in scenes.items():
        partial = scene.up_to_global[~scene.up_to_global["is_global"]]
        yield Entry(
            number=16,
            kind=OPEN,
            where="Abstract, Sects. 1, 5.1 and 7",
            printed="a precursor is a simultaneous slip of some of the masses",
            meant="in some, those at the trailing edge stick before the farthest slides",
            scene=name,
            quantity="precursors whose blocks never slide all at once",
            unit="1",
            as_printed=0.0,
            as_meant=float((partial["n_slid"] > partial["n_simultaneous"]).sum()),
        )


def _open_definitions(trailing: str, leading: str, scenes: Mapping[str, _Scene]) -> Iterator[Entry]:
    def kept(name: str, definition: Definition) -> float:
        scene = scenes[name]
        read = definition.read(scene.slips, scene.run.chain.n_blocks)
        return float(len(find_precursors(read, definition.short)))

    yield Entry(
        number=17,
        kind=OPEN,
        where="Sects. 1 and 5.1",
        printed="global slip: not defined; every block may slide at some time",
        meant="all at the same instant",
        scene=trailing,
        quantity="events kept",
        unit="1",
        as_printed=kept(trailing, Definition("each")),
        as_meant=kept(trailing, Definition()),
    )
    for wording, short in (
        ("short event: not defined for equal lengths; dropped", "not longer"),
        ("short event: smaller than the previous precursor", "shorter than the last"),
    ):
        yield Entry(
            number=18,
            kind=OPEN,
            where="Sects. 5.2 and 6.1",
            printed=wording,
            meant="shorter than one before; equal ones stay",
            scene=leading,
            quantity="events kept",
            unit="1",
            as_printed=kept(leading, Definition(short=short)),
            as_meant=kept(leading, Definition()),
        )
