"""The ledger: what the paper states, and the verdict of the results on every statement.

A claim (`claims`) names its evidence (file, rows and column of results/tables) and one of a few rules
(`rules`); nothing in it is evaluated as code. Its verdict (`judge`) is computed anew from the tables each
time.
"""
