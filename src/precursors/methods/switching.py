"""Readings of when a block that stops sticks: Eqs. 4 and 5 leave it open."""

# Where |F| <= mu_s w, which is ours; where |F| <= mu_k w; always, and none slides
# backward.
COULOMB = "static"
KINETIC = "kinetic"
FORWARD_ONLY = "forward_only"
