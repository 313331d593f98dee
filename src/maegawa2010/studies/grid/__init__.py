"""mu_sapp and events counted over any two values of the chain."""
