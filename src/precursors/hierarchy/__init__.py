"""Smaller and larger models than the paper's chain, and which of them answers which question."""
