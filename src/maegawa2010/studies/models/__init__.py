"""Smaller models, and which of them answers which question. A claim rests on it."""
