"""Numbers printed in the paper."""

# The same for all simulations and experiments.
MU_SAPP = 0.49
# One unit of its last digit. The paper says that mu_sapp "appears to have" the value 0.49.
LAST_DIGIT = 0.01
# By scene; the events are those counted in Fig. 13 (Sect. 5.2).
SCENES = {
    "fig10": {"events_counted": 9, "mu_sapp": MU_SAPP},
    "fig11": {"events_counted": 6, "mu_sapp": MU_SAPP},
    "fig12": {"events_counted": 14, "mu_sapp": MU_SAPP},
}
# Events of the experiment (Sect. 3.2.2) by the sign of theta: -1 for the larger load at
# the trailing edge. We never fit the experiment.
EVENTS_OF_EXPERIMENT = {-1: 11, 0: 19, 1: 27}
# Uniform loading (Sect. 3.2.1): F_X at the first global slip, and the duration of a
# global slip.
FIRST_GLOBAL_SLIP_N = 200.0
SLIP_DURATION_S = 0.002
# Fig. 7: F_ZA and F_ZB at theta = 5/6, and the distance between the two load cells.
CELL_LOADS_N = (100.0, 300.0)
CELL_SPACING_M = 0.06
