"""Accuracy against computing time."""
