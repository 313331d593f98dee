"""Proved transitions, the growth of errors, and the predictability time."""
