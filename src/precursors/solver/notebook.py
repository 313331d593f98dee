"""The view of a record in a notebook: its numbers, and the load over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from precursors.solver.run import Record

WIDTH = 420
HEIGHT = 120


def html(record: Record) -> str:
    """Numbers of a record, and a picture of the load at its transitions.

    Between two of them the load is nearly straight: a block that slides moves it by
    less than a line is wide.
    """
    moments = record.transitions
    load = moments["tangential_load"]
    largest = max(load.max(initial=0.0), 1e-300)
    time = moments["time"] / record.duration
    x = np.append(0.0, WIDTH * time)
    y = np.append(HEIGHT, HEIGHT * (1 - load / largest))
    pixels = np.unique(np.column_stack([x, y]).round(1), axis=0, return_index=True)[1]
    points = " ".join(f"{x[i]:.1f},{y[i]:.1f}" for i in np.sort(pixels))
    f_z = record.chain.normal_load
    return f"""\
<div><p>{type(record).__name__} of {record.duration:g} s: {len(moments)} transitions of \
{record.chain.n_blocks} blocks under F_Z = {f_z:g} N;
largest F_X = {largest:.1f} N = {largest / f_z:.3f} F_Z</p>
<svg width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="tangential load over time">
<title>tangential load over time</title>
<polyline points="{points}" fill="none" stroke="currentColor"/>
</svg><p>F_X from 0 to {largest:.1f} N, from 0 to {record.duration:g} s</p></div>
"""
