"""What the results are about: the paper's slider, or another one of the configuration."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from precursors.model.chain import parse_theta
from precursors.model.scenes import SLIDER, scene_duration, scene_slider
from precursors.reproduction.tables import SCENES, Tables, one

THETA = dict(zip(SCENES, map(parse_theta, ("-5/6", "0", "5/6")), strict=True))


def changes(config: Mapping[str, Any]) -> Iterator[str]:
    """Say where the slider is not the paper's, such as "mu_k = 0.46 (paper: 0.45)"."""
    chain = config["chain"]
    sliders = [scene for scene in SCENES if scene in config["scenes"]]
    for key, value in chain.items():
        if value != SLIDER[key]:
            yield f"{key} = {_written(value)} (paper: {_written(SLIDER[key])})"
    for scene in sliders:
        paper = SLIDER | {"theta": THETA[scene]}
        for key, value in scene_slider(config, scene).items():
            if value not in (paper[key], chain.get(key)):
                yield f"{key} of {scene} = {_written(value)} (paper: {_written(paper[key])})"


def scenes_are_proved(tables: Tables, config: Mapping[str, Any], chains: tuple[str, ...]) -> bool:
    """Whether the proofs of these chains are proofs of the paper's scenes as the configuration has them."""
    for scene, chain in zip(SCENES, chains, strict=True):
        proved = SLIDER | {"theta": 0} | config["accuracy"]["proved"][chain]
        proved["theta"] = parse_theta(proved["theta"])
        slider = scene_slider(config, scene)
        until = one(tables["certificates"], "proved_until_s", chain=chain)
        proved_to_its_end = until == scene_duration(config, scene)
        if not proved_to_its_end or any(proved[key] != value for key, value in slider.items()):
            return False
    return True


def _written(value: Any) -> str:
    return f"{value:g}" if isinstance(value, int | float) else "as measured"
