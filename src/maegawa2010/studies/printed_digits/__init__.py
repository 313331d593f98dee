"""Sliders with the same printed inputs."""
