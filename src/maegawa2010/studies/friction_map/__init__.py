"""mu_sapp over theta and mu_k/mu_s."""
