"""Convergence with the number of blocks. Claims rest on it."""
