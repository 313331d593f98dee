"""What scripts of the workflow share, digest of code, provenance, timing, statistics of runs."""
