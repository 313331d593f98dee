"""Input and output without physics: files, measured tables, provenance, compiled
code."""
