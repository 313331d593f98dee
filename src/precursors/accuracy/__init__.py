"""Methods compared with proved transitions, and the ways in which they fail."""
