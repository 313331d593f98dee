"""Ways in which methods fail on the paper's chain, each with a measured number that shows it."""

from precursors.accuracy.failures.backward import forward_only
from precursors.accuracy.failures.common import Failure, Number, Way
from precursors.accuracy.failures.energy import leapfrog_unstable, numerical_damping, rk4_unstable
from precursors.accuracy.failures.friction_laws import (
    creep,
    dead_zone_too_large,
    dead_zone_too_small,
    literal_friction,
    stiffness,
)
from precursors.accuracy.failures.locating import merged_transitions, missed_roots, restart_on_root

WAYS = tuple(
    Way(measure.__name__, measure)
    for measure in (
        rk4_unstable,
        leapfrog_unstable,
        numerical_damping,
        literal_friction,
        dead_zone_too_small,
        dead_zone_too_large,
        creep,
        stiffness,
        missed_roots,
        restart_on_root,
        merged_transitions,
        forward_only,
    )
)

__all__ = ["WAYS", "Failure", "Number", "Way"]
