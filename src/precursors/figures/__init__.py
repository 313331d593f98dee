"""Draw figures of a run from its tables."""
