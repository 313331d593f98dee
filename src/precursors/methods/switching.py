"""Readings of when a block that stops sticks: Eqs. 4 and 5 leave it open."""

# The first is ours.
COULOMB = "sticks if |F| <= mu_s w"
KINETIC = "sticks if |F| <= mu_k w"
FORWARD_ONLY = "slides forward only"
