"""Convergence with the number of blocks."""
