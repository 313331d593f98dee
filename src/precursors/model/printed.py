"""Numbers of the experiment that the paper prints: shown beside the model, never fitted."""

# Events counted (Sect. 3.2.2) by the sign of theta: -1 for the larger load at the trailing edge.
EVENTS_COUNTED = {-1: 11, 0: 19, 1: 27}
MU_SAPP = 0.49
# Fig. 7: F_ZA and F_ZB, and how far the load cells are apart.
CELL_LOADS_N = (100.0, 300.0)
CELL_SPACING_M = 0.06
# Theta of Sect. 5.2 as it is printed.
THETA = 0.833
