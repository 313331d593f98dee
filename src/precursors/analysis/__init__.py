"""Analyse a run: its slip events, its load curve, and its errors."""
