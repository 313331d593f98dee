"""Ensembles: many runs that differ in a few values.

A `Study` (members.py) is a table of members, each of them one run. A job runs every n-th
member and writes a file of rows. Together the files are the table of the study, the
same for any n.
"""
