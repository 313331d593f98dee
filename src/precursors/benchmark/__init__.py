"""Lists of transitions compared with proved ones."""
