"""The paper's chain to more than 40 digits, sharing no code with the solver, and the golden data from it."""

from .chain_reference import ReferenceChain, Transition, as_array, interval_lengths, reference
from .extended_chain import Additions, extended_reference
from .extended_goldens import EXTENDED, ExtendedScene, read_extended, write_extended_goldens
from .goldens import HeldOut, read_golden, read_held_out, write_goldens

__all__ = [
    "EXTENDED",
    "Additions",
    "ExtendedScene",
    "HeldOut",
    "ReferenceChain",
    "Transition",
    "as_array",
    "extended_reference",
    "interval_lengths",
    "read_extended",
    "read_golden",
    "read_held_out",
    "reference",
    "write_extended_goldens",
    "write_goldens",
]
