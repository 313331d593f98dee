"""Run an ensemble on all cores, with 0.1 % of noise in every normal load.

Prints:
    median mu_sapp = 0.484
"""

from dataclasses import replace

import numpy as np

from precursors import Chain, simulate_many, summarise

chain = Chain.from_slider(theta="-5/6")
random = np.random.default_rng(0)
chains = [
    replace(chain, weights=chain.weights * random.uniform(0.999, 1.001, 10))
    for _ in range(1000)
]
runs = simulate_many(chains, until="global slip")  # one Run per chain
print(f"median mu_sapp = {np.median(summarise(runs)['mu_sapp']):.3f}")
