"""From a run to its slips, its load curve and the growth of its errors."""
