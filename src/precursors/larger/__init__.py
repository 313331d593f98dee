"""The one larger chain: falling friction, viscosity, and the height of the push."""
