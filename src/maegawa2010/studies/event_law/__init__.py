"""The number of events against the law."""
