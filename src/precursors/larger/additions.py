"""What a larger chain adds to the paper's, with units."""

ADDITIONS = {
    "weakening_velocity": "m/s",
    "relaxation_time": "s",
    "viscosity": "N s/m",
    "push_height": "m",
}
