"""Golden transitions of the paper's three scenes and of held-out chains, as decimal
text.

- reference_{scene}.csv: time_s, block, mode, tangential_load_N with 40 significant
  digits, 0 to 10 s
- reference_heldout.csv: the same with 25 digits and the chain's name in the first column
- reference_viscous.csv: as reference_heldout.csv, of chains with viscosity
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from pathlib import Path

from .chain_reference import BITS, Number, ReferenceChain, Transition, reference

GOLDEN = Path(__file__).resolve().parent.parent / "golden"
SCENES = {"fig10": "0", "fig11": "-5/6", "fig12": "5/6"}  # theta
DURATION = 10  # s
SCENE_DIGITS = 40
HELD_OUT_DIGITS = 25


@dataclass(frozen=True)
class HeldOut:
    """A chain that no figure shows, as `ReferenceChain.from_slider` makes it, and its
    run [s], [m]."""

    slider: Mapping[str, Number | Sequence[Number]]
    duration: str
    start_positions: Sequence[str] | None = None
    until: str | None = None

    @property
    def chain(self) -> ReferenceChain:
        """The chain in exact numbers."""
        return ReferenceChain.from_slider(**self.slider)  # type: ignore[arg-type]

    def run(self, bits: int = BITS) -> list[Transition]:
        """Return all transitions of the chain."""
        return reference(
            self.chain, self.duration, self.until, self.start_positions, bits=bits
        )


HELD_OUT: dict[str, HeldOut] = {
    "one_block": HeldOut({"n_blocks": 1, "drive_velocity": "0.02"}, "1.25"),
    "two_blocks": HeldOut(
        {"n_blocks": 2, "theta": "1/2", "drive_velocity": "1e-3"}, "5"
    ),
    "three_blocks": HeldOut(
        {"n_blocks": 3, "theta": "-1/3", "mu_s": "0.6", "mu_k": "0.3"}, "40"
    ),
    "stiff_drive": HeldOut(
        {"n_blocks": 7, "theta": "1/4", "drive_stiffness": "1e9"}, "0.03"
    ),
    "soft_slider": HeldOut(
        {"n_blocks": 12, "theta": "-1/5", "youngs_modulus": "1e8"}, "10"
    ),
    "fast_drive": HeldOut(
        {"n_blocks": 8, "theta": "2/5", "drive_velocity": "0.01", "mu_k": "0.2"}, "0.1"
    ),
    "frictionless_slip": HeldOut(
        {"n_blocks": 5, "theta": "1/3", "mu_s": "0.5", "mu_k": "0"}, "0.3375"
    ),
    "many_blocks": HeldOut({"n_blocks": 25, "normal_load": "1000"}, "3"),
    "more_blocks": HeldOut({"n_blocks": 40, "theta": "-2/5"}, "1.42"),
    "weightless_front": HeldOut({"theta": "-1"}, "2.3225"),
    "uneven_prestressed": HeldOut(
        {"n_blocks": 6, "weights": ["31", "112.5", "7.25", "64", "90", "18"]},
        "8",
        ["2e-6", "0", "1.5e-6", "-1e-6", "-3e-6", "1e-6"],
    ),
    "grazing": HeldOut(
        {"n_blocks": 1, "mu_k": "0.70", "drive_velocity": "0.01"}, "0.055"
    ),
}

SLIP = "global slip"
# eta = sqrt(0.1 k m) is 54.77 N s/m and sqrt(k m) is 173.2 N s/m for every N (see
# docs/models.md).
VISCOUS: dict[str, HeldOut] = {
    "papers_chain": HeldOut({"viscosity": "54.77"}, "5", until=SLIP),
    "backward": HeldOut(
        {"n_blocks": 3, "theta": "1/2", "mu_k": "0.05", "viscosity": "3"}, "3"
    ),
    "stiff_viscosity": HeldOut(
        {"n_blocks": 3, "theta": "1/3", "viscosity": "300"}, "8"
    ),
}


def write_goldens() -> None:
    """Write all golden files of the reference."""
    for scene, theta in SCENES.items():
        transitions = reference(ReferenceChain.from_slider(theta=theta), DURATION)
        _write_csv(
            GOLDEN / f"reference_{scene}.csv", [], csv_rows(transitions, SCENE_DIGITS)
        )
    for name, cases in (("heldout", HELD_OUT), ("viscous", VISCOUS)):
        rows = [
            [chain, *row]
            for chain, case in cases.items()
            for row in csv_rows(case.run(), HELD_OUT_DIGITS)
        ]
        _write_csv(GOLDEN / f"reference_{name}.csv", ["chain"], rows)


def read_golden(scene: str) -> list[Transition]:
    """Return the golden transitions of "fig10", "fig11" or "fig12"."""
    with (GOLDEN / f"reference_{scene}.csv").open(newline="") as file:
        return [_transition(row) for row in csv.DictReader(file)]


def read_held_out() -> dict[str, tuple[HeldOut, list[Transition]]]:
    """Return the held-out chains by name, each with its golden transitions."""
    return _with_transitions(HELD_OUT, GOLDEN / "reference_heldout.csv")


def read_viscous() -> dict[str, tuple[HeldOut, list[Transition]]]:
    """Return the chains with viscosity by name, each with its golden transitions."""
    return _with_transitions(VISCOUS, GOLDEN / "reference_viscous.csv")


def _with_transitions(
    cases: Mapping[str, HeldOut], path: Path
) -> dict[str, tuple[HeldOut, list[Transition]]]:
    transitions: dict[str, list[Transition]] = {name: [] for name in cases}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            transitions[row["chain"]].append(_transition(row))
    return {name: (case, transitions[name]) for name, case in cases.items()}


def csv_rows(transitions: Iterable[Transition], digits: int) -> list[list[str]]:
    """Return the transitions as decimal text with so many significant digits."""
    return [
        [
            _decimal(t.time, digits),
            str(t.block),
            str(t.mode),
            _decimal(t.tangential_load, digits),
        ]
        for t in transitions
    ]


def _decimal(x: Fraction, digits: int) -> str:
    quotient = Context(prec=digits).divide(Decimal(x.numerator), Decimal(x.denominator))
    # Without trailing zeros: whether there are any depends on the last binary place.
    return format(quotient.normalize(Context(prec=digits)), "f")


def _transition(row: Mapping[str, str]) -> Transition:
    return Transition(
        Fraction(row["time_s"]),
        int(row["block"]),
        int(row["mode"]),
        Fraction(row["tangential_load_N"]),
    )


def _write_csv(path: Path, first_columns: list[str], rows: list[list[str]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(
            [*first_columns, "time_s", "block", "mode", "tangential_load_N"]
        )
        writer.writerows(rows)
