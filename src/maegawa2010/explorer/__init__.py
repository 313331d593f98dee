"""The explorer: a page that solves the chain while its parameters change."""
