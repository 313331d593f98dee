"""Chains with a length: first slips and settled cycles."""
