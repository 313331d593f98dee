"""A chain with a length of its own: friction falls with velocity.

It is solved in steps, and reports how much halving the step changes it.

Prints:
    {'halved_load_N': '0.02', 'halved_events': '0'}
"""

from precursors import Chain, LargerChain, plot

run = LargerChain(Chain.from_slider(), weakening_velocity=0.02).simulate(3.0)
print(
    {
        name: f"{value:.1g}"
        for name, value in run.numbers.items()
        if name.startswith("halved")
    }
)
plot(run).savefig("larger.png")
