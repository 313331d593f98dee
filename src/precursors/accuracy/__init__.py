"""What is proved, how methods compare with it, and how they fail."""
