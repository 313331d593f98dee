"""The time mean of F_X under many loadings and drives."""
