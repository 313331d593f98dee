"""Smaller models, and which of them answers which question."""
