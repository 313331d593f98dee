"""Golden transitions of chains with one addition each, as decimal text: reference_{addition}.csv."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from .chain_reference import Number, ReferenceChain, Transition
from .extended_chain import Additions, extended_reference
from .goldens import GOLDEN, _transition, _write_csv, csv_rows

DIGITS = 25


@dataclass(frozen=True)
class ExtendedScene:
    """A chain with additions, from rest, up to the end of its first global slip or to its duration.

    Parameters
    ----------
    slider : mapping
        Arguments of `ReferenceChain.from_slider` that differ from the paper's.
    additions : mapping
        Arguments of `Additions.of` but the number of blocks.
    duration : str
        Latest time [s].
    until : str, optional
        None or "global slip".
    """

    slider: Mapping[str, Number]
    additions: Mapping[str, Number]
    duration: str
    until: str | None = "global slip"

    @property
    def chain(self) -> ReferenceChain:
        """The chain in exact numbers."""
        return ReferenceChain.from_slider(**self.slider)  # type: ignore[arg-type]

    @property
    def added(self) -> Additions:
        """Its additions in exact numbers."""
        return Additions.of(len(self.chain.weights), **self.additions)

    def run(self, bits: int = 256) -> list[Transition]:
        """Return all transitions of the scene."""
        return extended_reference(self.chain, self.added, self.duration, self.until, bits=bits)


# eta = sqrt(0.1 k m) is 54.77 N s/m and sqrt(k m) is 173.2 N s/m for every N (see docs/models.md).
EXTENDED: dict[str, dict[str, ExtendedScene]] = {
    "viscous": {
        "papers_chain": ExtendedScene({}, {"viscosity": "54.77"}, "5"),
        "little_viscosity": ExtendedScene({"theta": "5/6"}, {"viscosity": "1"}, "2.1", None),
        "backward": ExtendedScene(
            {"n_blocks": 3, "theta": "1/2", "mu_k": "0.05"}, {"viscosity": "3"}, "3", None
        ),
        "stiff_viscosity": ExtendedScene({"n_blocks": 3, "theta": "1/3"}, {"viscosity": "300"}, "8", None),
        "creep": ExtendedScene({"n_blocks": 3, "theta": "1/3"}, {"viscosity": "400"}, "0.778", None),
        "many_blocks": ExtendedScene({"n_blocks": 26, "theta": "-2/5"}, {"viscosity": "17.3"}, "1.6", None),
    },
    "interface": {
        "backward": ExtendedScene(
            {"n_blocks": 3, "theta": "-1/2", "mu_k": "0.05", "drive_velocity": "0.1"},
            {"interface_stiffness": "4e8"},
            "0.003",
            None,
        ),
        "one_block": ExtendedScene(
            {"n_blocks": 1, "drive_velocity": "0.02"}, {"interface_stiffness": "4e8"}, "0.06", None
        ),
        "three_blocks": ExtendedScene(
            {"n_blocks": 3, "theta": "1/3", "drive_velocity": "0.02"}, {"interface_stiffness": "4e8"}, "0.02"
        ),
        "papers_chain": ExtendedScene(
            {"drive_velocity": "0.02"}, {"interface_stiffness": "4e8", "viscosity": "54.77"}, "0.03"
        ),
        "soft_interface": ExtendedScene(
            {"n_blocks": 5, "theta": "-1/2", "drive_velocity": "0.05"},
            {"interface_stiffness": "2.5e7"},
            "0.02",
        ),
        "many_blocks": ExtendedScene(
            {"n_blocks": 26, "drive_velocity": "0.1"},
            {"interface_stiffness": "4e8", "viscosity": "54.77"},
            "0.001",
            None,
        ),
    },
    "head": {
        "papers_chain": ExtendedScene({}, {"head_mass": "0.3122"}, "5"),
        "backward": ExtendedScene(
            {"n_blocks": 3, "theta": "-1/2", "mu_k": "0.05"}, {"head_mass": "0.004"}, "1.8", None
        ),
        "two_blocks": ExtendedScene({"n_blocks": 2, "theta": "1/2"}, {"head_mass": "0.01"}, "10", None),
        "one_block": ExtendedScene({"n_blocks": 1}, {"head_mass": "0.3122"}, "10", None),
        "all_additions": ExtendedScene(
            {"n_blocks": 4, "theta": "1/4", "drive_velocity": "0.02"},
            {"head_mass": "0.02", "viscosity": "54.77", "interface_stiffness": "4e8"},
            "0.03",
        ),
    },
}


def write_extended_goldens(directory: Path = GOLDEN) -> None:
    """Write reference_{addition}.csv for each addition into `directory`."""
    for addition, scenes in EXTENDED.items():
        rows = [[name, *row] for name, scene in scenes.items() for row in csv_rows(scene.run(), DIGITS)]
        _write_csv(directory / f"reference_{addition}.csv", ["chain"], rows)


def read_extended(
    addition: str, directory: Path = GOLDEN
) -> dict[str, tuple[ExtendedScene, list[Transition]]]:
    """Return the scenes of "viscous", "interface" or "head" by name, each with its golden transitions."""
    transitions: dict[str, list[Transition]] = {name: [] for name in EXTENDED[addition]}
    with (directory / f"reference_{addition}.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            transitions[row["chain"]].append(_transition(row))
    return {name: (scene, transitions[name]) for name, scene in EXTENDED[addition].items()}
