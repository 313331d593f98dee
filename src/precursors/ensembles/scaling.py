"""What runs cost: time against the number of blocks, the time simulated and the number of runs."""

from __future__ import annotations

import math
import resource
import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.ensembles.maps import AXES, map_study
from precursors.ensembles.resolution import resolution_study
from precursors.ensembles.study import Study, run_members
from precursors.model.chain import Chain
from precursors.model.scenes import Config, scene_slider
from precursors.solver.simulate import simulate
from precursors.support import timing

# What a new process goes through before its first run, each line with all that is above it.
STARTS = {
    "interpreter": "pass",
    "imports": "import precursors.solver.simulate, precursors.analysis.summary",
    "compiled code loaded and one run made": (
        "from precursors import Chain, simulate_many\n"
        "from precursors.analysis.summary import summarise\n"
        "summarise(simulate_many([Chain.from_slider()], until='global slip', threads=1))"
    ),
}
# A chunk shorter than this is spoiled by what a job costs beside; a longer one by what a failed job loses.
SHORTEST_CHUNK, LONGEST_CHUNK = 60.0, 600.0  # s
CHUNKS_PER_CORE = 4
COLUMNS = [
    "kind",
    "case",
    "n_blocks",
    "duration_s",
    "runs",
    "seconds_per_run",
    "transitions_per_run",
    "seconds_per_transition",
]


@dataclass(frozen=True)
class Case:
    """Something to be timed: the columns that say what it is, and the call."""

    kind: str
    case: str
    n_blocks: float
    duration: float
    runs: int
    transitions: Callable[[], float]
    call: Callable[[], object]


def measure_costs(config: Config) -> pd.DataFrame:
    """Time runs of all kinds on one core, as `scaling` of the configuration says.

    Returns
    -------
    DataFrame
        `COLUMNS`, one row per case. Of kind "first slip": runs of the resolution study up to the first
        global slip, against n_blocks. "duration": the scenes of Fig. 13, against the time simulated. "map":
        runs of a map of `points` points, a sample spread evenly over it. "start": a new process.
        Times are processor times [s], medians of the rounds; NaN where a column has no meaning.
    """
    settings = config["scaling"]
    cases = [*_first_slips(config), *_durations(config), *_maps(config)]
    timings = timing.measure({case.case: case.call for case in cases}, settings["repetitions"])
    rows = []
    for case in cases:
        total = float(np.median(timings[case.case].cpu))
        seconds, transitions = total / case.runs, case.transitions() / case.runs
        what = (case.kind, case.case, case.n_blocks, case.duration, case.runs)
        each = seconds / transitions if transitions else math.nan
        rows.append((*what, seconds, transitions, each))
    for name, code in STARTS.items():
        seconds = np.median([_seconds_of_process(code) for _ in range(settings["repetitions"])])
        rows.append(("start", name, math.nan, math.nan, 1, seconds, math.nan, math.nan))
    return pd.DataFrame(rows, columns=COLUMNS)


def _seconds_of_process(code: str) -> float:
    """Processor time [s] that a new Python takes for some lines, its start and end included.

    `timing.measure` has the time of this process only, and would repeat and warm up what is to be cold.
    """
    before = _children()
    subprocess.run([sys.executable, "-c", code], check=True)
    return _children() - before


def _children() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _first_slips(config: Config) -> Iterable[Case]:
    settings = config["scaling"]
    sizes = {"n_blocks": settings["n_blocks"], "seconds_per_point": settings["seconds_per_point"]}
    study = resolution_study({**config, "resolution": {**config["resolution"], **sizes}})
    for n_blocks in settings["n_blocks"]:
        part = members_of(study, np.flatnonzero(study.column("n_blocks") == n_blocks))
        run = partial(run_members, part, 0, len(part))
        yield Case(
            "first slip",
            f"N = {n_blocks}",
            n_blocks,
            math.nan,
            len(part),
            partial(_transitions_of_members, run),
            run,
        )


def _transitions_of_members(run: Callable[[], NDArray[np.void]]) -> float:
    return float(run()["transitions"].sum())


def _durations(config: Config) -> Iterable[Case]:
    for scene in config["fig13"]:
        chain = Chain.from_slider(**scene_slider(config, scene))
        for duration in config["scaling"]["durations"]:
            run = partial(simulate, chain, duration)
            count = partial(_transitions_of_run, chain, duration)
            yield Case("duration", f"{scene}, T = {duration:g} s", chain.n_blocks, duration, 1, count, run)


def _transitions_of_run(chain: Chain, duration: float) -> float:
    return float(len(simulate(chain, duration).transitions))


def _maps(config: Config) -> Iterable[Case]:
    settings = config["scaling"]
    for name in AXES:
        study = map_study({**config, "maps": {**config["maps"], "points": settings["points"]}}, name)
        part = members_of(study, even_sample(study.column(AXES[name][0]), settings["sample"]))
        run = partial(run_members, part, 0, len(part))
        yield Case("map", name, math.nan, math.nan, len(part), lambda: math.nan, run)


def members_of(study: Study, members: NDArray[np.intp]) -> Study:
    """A study of some members of another."""
    return replace(study, columns={name: values[members] for name, values in study.columns.items()})


def even_sample(second_axis: NDArray, n: int) -> NDArray[np.intp]:
    """About n members of a map, the middles of equal parts of either axis.

    Parameters
    ----------
    second_axis : array, shape (n_members,)
        Value of the axis other than theta; members with one value follow each other.
    n : int
        Number of members wanted.
    """
    begins = np.flatnonzero(np.r_[True, second_axis[1:] != second_axis[:-1]])
    row_length = len(second_axis) // len(begins)
    n_rows = min(len(begins), math.isqrt(n))
    rows, within = _middles(len(begins), n_rows), _middles(row_length, n // n_rows)
    return (begins[rows][:, np.newaxis] + within).ravel()


def _middles(n: int, parts: int) -> NDArray[np.intp]:
    """Middles of so many equal parts of 0 .. n - 1."""
    parts = min(n, parts)
    return ((np.arange(parts) + 0.5) * n / parts).astype(np.intp)


def growth_exponent(n_blocks: Sequence[float], seconds: Sequence[float]) -> float:
    """Exponent p of the power law seconds = c N^p, by least squares over the logarithms."""
    return float(np.polyfit(np.log(n_blocks), np.log(seconds), 1)[0])


def chunk_seconds(core_seconds: float, cores: int) -> float:
    """Size of a chunk [s] with which every core has a few of them, within what is sensible for a job."""
    return min(LONGEST_CHUNK, max(SHORTEST_CHUNK, core_seconds / (CHUNKS_PER_CORE * cores)))


def time_of_maps(
    seconds_per_run: Mapping[str, float], points: int, cores: Iterable[int], seconds_per_job: float
) -> pd.DataFrame:
    """What maps of so many points cost on so many cores.

    Parameters
    ----------
    seconds_per_run : mapping
        Mean time of a run on one core [s], for each map.
    points : int
        Points of each map.
    cores : iterable of int
        Numbers of cores.
    seconds_per_job : float
        Time that a job takes beside its runs [s].

    Returns
    -------
    DataFrame
        One row per map, and one for all together, and number of cores: core_hours without what the jobs take
        beside; the size of a chunk and the number of them; wall_hours, if all chunks take the same time, jobs
        start at once and every core works off its share.
    """
    core_seconds = {name: seconds * points for name, seconds in seconds_per_run.items()}
    core_seconds["all of them"] = sum(core_seconds.values())
    rows = []
    for name, total in core_seconds.items():
        for n_cores in cores:
            chunks = math.ceil(total / chunk_seconds(total, n_cores))
            seconds = math.ceil(chunks / n_cores) * (total / chunks + seconds_per_job)
            rows.append((name, points, total / 3600.0, n_cores, total / chunks, chunks, seconds / 3600.0))
    names = ["map", "points", "core_hours", "cores", "seconds_per_chunk", "chunks", "wall_hours"]
    return pd.DataFrame(rows, columns=names)
