"""Define the normal loads by a formula: here, a parabola that is zero at both edges.

Prints:
    11 events counted
"""

import numpy as np

from precursors import Chain, find_precursors, find_slips, simulate

x = (np.arange(10) + 0.5) / 10  # centres of the blocks, as fractions of L
parabola = x * (1 - x)
chain = Chain.from_slider(weights=400 * parabola / parabola.sum())  # F_Z = 400 N
print(len(find_precursors(find_slips(simulate(chain)))), "events counted")
