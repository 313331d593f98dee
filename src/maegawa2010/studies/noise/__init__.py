"""Noise in the normal loads. Claims and `resolution` rest on it."""
