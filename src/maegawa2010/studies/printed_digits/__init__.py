"""Sliders with the same printed inputs. Claims and the page rest on it."""
