"""The ways in which methods fail."""
