"""Simulate a scene; write its run, a table of its slips, and the trace of its load.

The table has every slip event; its column `counted` marks those of Fig. 13. The trace is
the exact tangential load at all transitions, and at further points so that straight lines
between points are right to 1e-4 N. A run that reaches its limit on transitions is saved
as unfinished.
"""

from pathlib import Path

from maegawa2010.support.job import job
from precursors.analysis.load_curve import load_trace
from precursors.analysis.slips import slip_table
from precursors.model.chain import Chain
from precursors.solver.simulate import TransitionLimitError, simulate
from precursors.support.files import write_table

with job() as snakemake:
    params = snakemake.params
    output = snakemake.output
    chain = Chain.from_slider(**params.slider)
    try:
        run = simulate(chain, duration=params.duration)
    except TransitionLimitError as error:
        error.run.save(Path(output.run).with_suffix(".unfinished.h5"))
        raise
    run.save(output.run)
    write_table(slip_table(run), output.slips)
    write_table(load_trace(run), output.trace)
