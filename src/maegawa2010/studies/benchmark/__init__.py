"""Other solvers, scored on the reference problems."""
