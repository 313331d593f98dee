"""Ensembles: thousands of runs that differ in a few values, in chunks that may run anywhere.

A `Study` (study.py) is a table of members; a chunk (chunks.py) is a range of its rows, run by one job into
one file; gathered, the chunks are the table of the study, the same whatever the chunks were.
"""
