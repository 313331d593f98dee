"""The chain that is simulated, its scenes and its statics (Eqs. 2-14)."""
