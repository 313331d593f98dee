"""The paper's numbers in a window of theta."""
