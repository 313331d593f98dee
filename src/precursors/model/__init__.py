"""Model: the chain of blocks and its statics (Eqs. 2-14)."""
