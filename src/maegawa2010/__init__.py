"""Maegawa, Suzuki and Nakano (2010) with the library `precursors`: scenes, readings, claims,
Figs. 10-13, and the studies about them.
"""
