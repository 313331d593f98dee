"""Smaller models than the paper's chain, and which of them answers which question."""
