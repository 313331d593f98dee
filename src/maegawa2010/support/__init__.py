"""Digest of code, timing, statistics of runs."""
