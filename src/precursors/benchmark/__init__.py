"""Compare and score lists of transitions against proved ones."""
