"""The models that a scene may name, and what each answers; a workflow is planned without a compiler."""

from __future__ import annotations

from precursors.model.chain import ADDITIONS

LOAD_BOUND, FIRST_LOAD = "load_bound", "first_load"
EVENTS_KEPT, MU_SAPP, FRONT_LOADS = "events_kept", "mu_sapp", "front_loads"
SLIP_DURATION, WAVEFORM = "slip_duration", "waveform"

PAPERS_MODEL = "chain"
_QUASI_STATIC = (FIRST_LOAD, EVENTS_KEPT, MU_SAPP, FRONT_LOADS)
_DYNAMIC = (*_QUASI_STATIC, SLIP_DURATION, WAVEFORM)

# Models from the smallest to the largest (`reduced.MODELS`), and the quantities that each can answer.
ANSWERED = {
    "statics": (LOAD_BOUND, FIRST_LOAD),
    "law": (FRONT_LOADS, MU_SAPP),
    "rigid": _DYNAMIC,
    "overdamped": _QUASI_STATIC,
    "quasistatic": _QUASI_STATIC,
    PAPERS_MODEL: _DYNAMIC,
    "viscous": _DYNAMIC,
    "interface": _DYNAMIC,
    "head": _DYNAMIC,
}
# What a model must add to the paper's chain, an argument of `Chain.from_slider`; it may add the others too.
ADDED = {"viscous": "viscosity", "interface": "interface_stiffness", "head": "head_mass"}
# Models that are followed through time, for as long as a scene lasts.
SIMULATED = (PAPERS_MODEL, *ADDED)
# What stands for the addition of a model that has none.
NO_ADDITION = "none"
UNITS = ADDITIONS
