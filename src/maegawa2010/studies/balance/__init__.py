"""The distance R from kinetic balance, and the mean of F_X that follows from it."""
