"""Increase the friction of one block: friction is mu w, so increase its weight.

The weights then add up to more than F_Z, so mu_sapp is the largest F_X divided by the original normal load.

Prints:
    mu_sapp = 0.463
"""

from precursors import Chain, find_slips, simulate

chain = Chain.from_slider()
rough = chain.weights.copy()
rough[3] *= 1.1
run = simulate(Chain.from_slider(weights=rough), until="global slip")
largest = find_slips(run)["largest_load"].max()
print(f"mu_sapp = {largest / chain.normal_load:.3f}")
