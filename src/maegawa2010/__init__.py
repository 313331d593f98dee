"""Reproduction of Maegawa, Suzuki and Nakano (2010) with the library `precursors`: the
paper's scenes, Figs. 10-13 and claims, our readings of its words, and further studies.
"""
