"""Files written whole, measured tables, provenance, kept machine code; no physics."""
