"""Compile solver and fixed-step methods into the cache: python -m precursors.solver.warm_up."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial

# Long enough for a first slip (0.35 s), so that what is called in slips only is met.
DURATION = 0.4  # s
STEP = 1e-6  # s
COMPILED_METHODS = ("rk4", "rk4_skip", "rk4_located", "leapfrog", "moreau_jean_one", "karnopp", "literal")


def solver() -> None:
    """The exact solver, and what is made of its runs."""
    from precursors import Chain, simulate
    from precursors.analysis.summary import summarise
    from precursors.hierarchy.quasistatic import quasistatic_slips

    chain = Chain.from_slider()
    run = simulate(chain, DURATION)
    run.at([DURATION])
    summarise([run])
    quasistatic_slips(chain, overshoot=1.0)


def linked_solver() -> None:
    """The exact solver for chains with viscosity or interface springs, compiled apart."""
    from precursors import Chain, simulate

    simulate(Chain.from_slider(viscosity=1.0), DURATION).at([DURATION])


def methods() -> None:
    """The methods with a fixed step that it is compared with, with transitions and without."""
    from precursors import Chain
    from precursors.methods import METHODS, leapfrog, rk4
    from precursors.methods.stability import largest_stable_step

    for name in COMPILED_METHODS:
        METHODS[name].solve(Chain.from_slider(), DURATION, STEP, None)
    for slide in (rk4.slide, partial(leapfrog.slide, verlet=True)):
        largest_stable_step(Chain.from_slider(), slide)


PARTS: tuple[Callable[[], None], ...] = (solver, linked_solver, methods)


def main() -> None:
    """Compile the parts in processes of their own."""
    with ProcessPoolExecutor(min(len(PARTS), os.cpu_count() or 1)) as pool:
        for part in [pool.submit(part) for part in PARTS]:
            part.result()


if __name__ == "__main__":
    main()
