"""The studies of a configuration by name, and their chunks."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import lru_cache, partial

from precursors.ensembles.chunks import plan_chunks
from precursors.ensembles.maps import AXES, map_study
from precursors.ensembles.resolution import resolution_study
from precursors.ensembles.spread import spread_study
from precursors.ensembles.study import Study
from precursors.model.scenes import Config

STUDIES: dict[str, Callable[[Config], Study]] = {
    "spread_members": spread_study,
    "resolution_members": resolution_study,
    **{name: partial(map_study, name=name) for name in AXES},
}


def make_study(config: Config, name: str) -> Study:
    """The study of this name.

    Raises
    ------
    ValueError
        If there is none.
    """
    if name not in STUDIES:
        raise ValueError(f"study = {name!r} is unknown: allowed are {', '.join(STUDIES)}")
    return _made(json.dumps(config), name)


@lru_cache(maxsize=len(STUDIES))
def _made(config: str, name: str) -> Study:
    return STUDIES[name](json.loads(config))


def chunk_names(config: Config, name: str) -> list[str]:
    """Names of the chunks of a study: the range of its members, first and last."""
    seconds = config["ensembles"]["seconds_per_chunk"]
    return [f"{first}-{end - 1}" for first, end in plan_chunks(make_study(config, name), seconds)]
