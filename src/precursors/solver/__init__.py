"""From a chain to its run: every transition, exact to rounding."""
