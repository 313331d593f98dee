"""The chain to more than 40 digits, sharing no code with the solver, and the golden
data from it."""

from .chain_reference import ReferenceChain, Transition, interval_lengths, reference
from .goldens import (
    VISCOUS,
    HeldOut,
    read_golden,
    read_held_out,
    read_viscous,
    write_goldens,
)
