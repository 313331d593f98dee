"""Solver: simulate a chain and return its run, exact to rounding."""
