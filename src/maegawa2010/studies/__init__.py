"""Studies of the model, each in a package of its own; most are ensembles of runs.

A `Study` (members.py) is a table of members that differ in a few values. Each member is
one run. If a study has n jobs, each of them runs every n-th member and writes a file of
rows. Joined, the files are the table of the study, which does not depend on n.
"""
