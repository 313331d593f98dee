"""What the tables of the spread study call its questions, and the members that answer them."""

QUESTIONS = ("loads", "theta", "start", "parameters")
# Perturbations that are no value's: the member as the scene has it, and the sweep of theta.
UNPERTURBED, SWEEP = "none", "theta, evenly spaced"
