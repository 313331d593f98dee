"""A study: a table of members, each of them one run, and what is kept of the runs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray, Until
from precursors.model.slider import SLIDER, Slider

if TYPE_CHECKING:
    from collections.abc import Iterator

    from precursors.solver.run import Run
    from precursors.solver.simulate import TransitionLimitError

# Runs of a batch are in memory at the same time: some 200 of 10 blocks, 10 of 200.
BLOCKS_PER_BATCH = 2000
NOISE = ("load_noise", "start_noise")


@dataclass(frozen=True, eq=False)
class Study:
    """Runs that differ in a few values.

    Attributes
    ----------
    name : str
        Name of the study and of its files.
    slider : mapping
        Arguments of `Chain.from_slider` that all members have in common.
    columns : mapping of arrays, one value per member
        What the members differ in. Known names: the arguments of `Chain.from_slider`; duration [s];
        load_noise and start_noise (largest relative change, see `Study.member`), with group and draw, the
        numbers of the random stream (spawned group by group, then draw by draw). Other names are labels.
    duration : float
        Time limit of a run [s] where there is no such column.
    until : "global slip" or None
        As in `simulate`.
    seed : int
        Seed of all random numbers.

    Raises
    ------
    ValueError
        If columns differ in length, or noise has no random stream.
    """

    name: str
    slider: Slider
    columns: Mapping[str, NDArray]
    duration: float = 10.0
    until: Until = "global slip"
    seed: int = 0

    def __post_init__(self) -> None:
        lengths = {name: len(values) for name, values in self.columns.items()}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"study {self.name}: columns differ in length: {lengths}")
        if set(NOISE) & lengths.keys() and not {"group", "draw"} <= lengths.keys():
            raise ValueError(f"study {self.name}: noise needs the columns group and draw")

    @classmethod
    def of_blocks(cls, name: str, blocks: Sequence[Mapping[str, Any]], **settings: Any) -> Study:
        """Stack blocks of members, each with a value or an array of values for every column."""
        lengths = [np.broadcast(*block.values()).size for block in blocks]
        columns = {
            key: np.concatenate(
                [np.broadcast_to(block[key], n) for block, n in zip(blocks, lengths, strict=True)]
            )
            for key in blocks[0]
        }
        same = {key: values[0].item() for key, values in columns.items() if key in SLIDER and _is_one(values)}
        differ = {key: values for key, values in columns.items() if key not in same}
        return cls(name, same, differ, **settings)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def column(self, name: str) -> NDArray:
        """Value of each member, from its column or what all have in common, shape (n_members,)."""
        if name in self.columns:
            return self.columns[name]
        return np.full(len(self), {**SLIDER, **self.slider, "duration": self.duration}[name])

    def member(self, i: int) -> tuple[Chain, FloatArray | None]:
        """Chain and start positions [m] of member i; the same whatever else is run.

        Noise of size s changes each normal load to w_i (1 + s u_i), and puts block i at s u_i times
        mu_s F_Z / (N k), the compression of a spring that holds a mean block; u_i is uniform in -1..1.
        """
        differing = [name for name in SLIDER if name in self.columns]
        chain = Chain.from_slider(**{**self.slider, **{name: self.columns[name][i] for name in differing}})
        load_noise, start_noise = (self.columns[name][i] if name in self.columns else 0.0 for name in NOISE)
        if load_noise == start_noise == 0.0:
            return chain, None
        random = np.random.default_rng(
            np.random.SeedSequence(self.seed, spawn_key=(self.columns["group"][i], self.columns["draw"][i]))
        )
        change = load_noise * random.uniform(-1, 1, chain.n_blocks)
        compression = start_noise * random.uniform(-1, 1, chain.n_blocks)
        scale = chain.mu_s * chain.normal_load / (chain.n_blocks * chain.stiffness)
        return replace(chain, weights=chain.weights * (1 + change)), compression * scale

    @cached_property
    def fingerprint(self) -> str:
        """SHA-256 of everything that decides the runs: a chunk of another study is told by it."""
        common = {"slider": dict(self.slider), "duration": self.duration, "until": self.until}
        digest = hashlib.sha256(json.dumps(common | {"seed": self.seed}, sort_keys=True).encode())
        for name, values in self.columns.items():
            digest.update(f"{name} {values.dtype} {values.shape}".encode())
            digest.update(np.ascontiguousarray(values).tobytes())
        return digest.hexdigest()


def _is_one(values: NDArray) -> bool:
    """Whether all are the same value."""
    return bool((values == values[0]).all())


def run_members(
    study: Study,
    first: int,
    end: int,
    progress: Callable[[int], None] | None = None,
    threads: int | None = 1,
    at_cap: Callable[[int, TransitionLimitError], object] | None = None,
) -> NDArray[np.void]:
    """Summaries of members `first` .. `end` - 1 of a study, one row each (see `summary.SUMMARY`).

    A member that meets its cap on transitions is summarised as far as it came.

    Parameters
    ----------
    study : Study
        The study.
    first, end : int
        Range of members.
    progress : callable, optional
        Called now and then with the number of members done.
    threads : int or None
        Threads to use; None for as many as there are cores.
    at_cap : callable, optional
        Called with each member that met its cap on transitions, and what the solver said of it.
    """
    from precursors.analysis.summary import SUMMARY, summarise  # a plan of chunks waits for no compiler

    summaries = [np.empty(0, SUMMARY)]
    for batch in _batches(study, first, end):
        summaries.append(summarise(_runs(study, batch, threads, at_cap)))
        if progress:
            progress(batch.stop - first)
    return np.concatenate(summaries)


def _batches(study: Study, first: int, end: int) -> Iterator[range]:
    """Ranges of members with one duration, so small that their runs find room and progress is seen."""
    durations = study.column("duration")
    most_blocks = int(study.column("n_blocks").max())
    size = max(1, BLOCKS_PER_BATCH // most_blocks)
    changes = np.flatnonzero(np.diff(durations[first:end])) + first + 1
    for start, stop in pairwise([first, *changes.tolist(), end]):
        for begin in range(start, stop, size):
            yield range(begin, min(begin + size, stop))


def _runs(
    study: Study,
    batch: range,
    threads: int | None,
    at_cap: Callable[[int, TransitionLimitError], object] | None,
) -> list[Run]:
    """The runs of some members; one that meets its cap on transitions is kept as far as it came."""
    from precursors.solver.simulate import TransitionLimitError, simulate_many

    duration = float(study.column("duration")[batch[0]])
    members = [study.member(i) for i in batch]
    chains = [chain for chain, _ in members]
    starts = [np.zeros(chain.n_blocks) if start is None else start for chain, start in members]
    try:
        return simulate_many(chains, duration, study.until, threads, starts)
    except TransitionLimitError as limit:
        if len(batch) > 1:
            return [run for i in batch for run in _runs(study, range(i, i + 1), threads, at_cap)]
        if at_cap:
            at_cap(batch[0], limit)
        return [limit.run]
