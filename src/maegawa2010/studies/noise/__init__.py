"""Noise in the normal loads."""
