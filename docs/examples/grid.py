"""Map mu_sapp over two parameters, and resume after an interruption.

Each row of the map is saved in a file of its own, which `write_table` writes completely or not at all.
After Ctrl-C or a power cut, run the script again: it computes only the missing rows.

Prints:
    (15, 41) mu_sapp from 0.255 to 0.674
"""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from precursors import Chain, simulate_many, summarise
from precursors.support.files import write_table

thetas = np.linspace(-1, 1, 41)
for mu_k in np.linspace(0.30, 0.65, 15):
    part = Path("parts", f"{mu_k:.3f}.csv")
    if not part.exists():
        chains = [Chain.from_slider(theta=theta, mu_k=mu_k) for theta in thetas]
        runs = simulate_many(chains, until="global slip")
        write_table(summarise(runs).assign(mu_k=mu_k, theta=thetas), part)

rows = pd.concat(pd.read_csv(part) for part in sorted(Path("parts").iterdir()))
grid = rows.pivot_table(index="mu_k", columns="theta", values="mu_sapp")
figure = Figure(layout="constrained")
axes = figure.subplots()
mesh = axes.pcolormesh(grid.columns, grid.index, grid)
axes.set(xlabel="theta", ylabel="mu_k")
figure.colorbar(mesh, label="mu_sapp")
figure.savefig("map.png")
print(grid.shape, f"mu_sapp from {grid.min().min():.3f} to {grid.max().max():.3f}")
