"""The models that a scene may name, from the smallest to the largest (see `hierarchy.models.MODELS`)."""

from __future__ import annotations

PAPERS_MODEL = "chain"
# Models that add to the paper's chain, and the field of `hierarchy.larger.LargerChain` that each one needs.
ADDED = {"viscous": "viscosity", "interface": "interface_stiffness", "head": "head_mass"}
MODEL_NAMES = ("statics", "law", "rigid", "overdamped", "quasistatic", PAPERS_MODEL, *ADDED)
# What stands for the addition of a model that has none.
NO_ADDITION = "none"
