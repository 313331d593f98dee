"""What is simulated: the chain, its scenes and its statics (Eqs. 2-14)."""
