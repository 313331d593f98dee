"""What the paper says, and what became of it."""
