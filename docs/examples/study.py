"""Study how the drop from static to kinetic friction changes the precursors.

There is one run for each of 15 values of mu_k; everything else is as in the paper.

Prints:
     mu_k  events_counted  mu_sapp  global_slip_s
     0.30               4    0.447          2.534
     0.35               5    0.449          2.578
     0.40               5    0.386          2.145
     0.45               9    0.486          2.739
     0.50               9    0.497          2.803
     0.55              14    0.558          3.165
     0.60              27    0.615          3.519
     0.65              51    0.657          3.752
"""

import numpy as np

from precursors import Chain, plot, simulate, simulate_many, summarise

values = np.linspace(0.30, 0.65, 15)
chains = [Chain.from_slider(mu_k=mu_k) for mu_k in values]
table = summarise(simulate_many(chains)).assign(mu_k=values)
columns = ["mu_k", "events_counted", "mu_sapp", "global_slip_s"]
print(table[columns][::2].round(3).to_string(index=False))

axes = table.plot.scatter("mu_k", "mu_sapp")
axes.set(xlabel="kinetic friction $\\mu_k$ [-]", ylabel=r"$\mu_\mathrm{sapp}$ [-]")
axes.figure.savefig("study.png", dpi=150)

run = simulate(Chain.from_slider(theta="5/6"))
plot(run, look={"width_mm": 120}).savefig("run.png")  # load and slips over time
plot(run, "lengths").savefig("lengths.pdf")  # front lengths against the load
plot(run, "wave").savefig("wave.svg")  # a film for a browser
