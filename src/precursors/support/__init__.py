"""Files written whole, timing and provenance; no physics."""
