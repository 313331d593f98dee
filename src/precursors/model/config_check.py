"""What a configuration must hold, and the directory of its results: the first thing wrong in one line."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from precursors.ensembles.cost import TRACE_PER_RUN, seconds_of_run, too_long
from precursors.model.config_schema import against_schema, joined, shown
from precursors.model.config_studies import wrong_studies
from precursors.model.plain_yaml import one_line, too_many
from precursors.model.scene_models import ADDED, MODEL_NAMES
from precursors.model.scenes import (
    Config,
    scene_chain,
    scene_duration,
    scene_model,
    scene_outputs,
    scene_slider,
)

SCENE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
# Whole numbers that no configuration needs.
LARGEST_INTEGER = 2**63
# The figures that are no scene's: none of their names, or what they begin with, is allowed as a scene's.
RESERVED_NAMES = (
    "definitions",
    "failure_gallery",
    "fig09",
    "fig13",
    "growth",
    "horizon",
    "ladder",
    "long_runs",
    "resolution",
    "resolution_models",
)
RESERVED_BEGINNINGS = ("map_", "spread_", "step_sweep", "work_precision")


def check_config(config: Config, schema_path: str | os.PathLike[str]) -> None:
    """Refuse a configuration that the workflow cannot run.

    Parameters
    ----------
    config : mapping
        The configuration as YAML gives it.
    schema_path : path
        The JSON schema, as YAML.

    Raises
    ------
    ValueError
        One line: which value, where, and what is allowed.
    """
    for complaint in _complaints(config, schema_path):
        raise ValueError(f"configuration: {one_line(complaint)}")


def check_directory(path: str | os.PathLike[str]) -> None:
    """Refuse a results directory that cannot be written to.

    Raises
    ------
    ValueError
        One line: which path, and what is wrong with it.
    """
    directory = Path(path)
    if not directory.exists():
        directory = directory.absolute().parent
    elif not directory.is_dir():
        raise ValueError(f"{directory} is a file: a directory that can be written to is needed there")
    if not os.access(directory, os.W_OK | os.X_OK):
        raise ValueError(f"{directory} cannot be written to: allow it, or run in another directory")


def scene_seconds(config: Config, name: str) -> float:
    """Time that the run of a scene is expected to take on one core [s] (see `precursors.ensembles.cost`)."""
    return seconds_of_run(scene_slider(config, name), scene_duration(config, name))


def trace_seconds(config: Config, name: str) -> float:
    """Time that the trace of a scene is expected to take, where it has one [s]."""
    return TRACE_PER_RUN * scene_seconds(config, name) if "trace" in scene_outputs(config, name) else 0.0


def _complaints(config: Config, schema_path: str | os.PathLike[str]) -> Iterator[str]:
    """What is wrong, the first thing first; later checks rely on the earlier ones."""
    yield from too_many(config)
    yield from _odd_values("", config)
    yield from against_schema(config, schema_path)
    for name, scene in config["scenes"].items():
        yield from _wrong_scene(config, name, scene)
    for name in config["fig13"]:
        if name not in config["scenes"]:
            yield f"fig13 names {name!r}, which is no scene: allowed are {', '.join(config['scenes'])}"
        elif "run" not in scene_outputs(config, name):
            yield f"fig13 names {name!r}: allowed are scenes without `model:`, which have a run"
    yield from wrong_studies(config)


def _odd_values(where: str, value: object) -> Iterator[str]:
    """Keys and numbers that YAML can write and no schema refuses."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            if not isinstance(key, str):
                yield f"{where or 'top level'}: the key {key!r} is no text: allowed is a name or quotes"
            yield from _odd_values(joined(where, key), inner)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from _odd_values(f"{where}[{i}]", inner)
    elif isinstance(value, float) and not math.isfinite(value):
        yield f"{where} = {value!r} is not finite: allowed is a finite number"
    elif isinstance(value, int) and abs(value) > LARGEST_INTEGER:
        yield f"{where} is a whole number of {value.bit_length()} bits: allowed are numbers up to 2^63"


def _wrong_scene(config: Config, name: str, scene: Mapping[str, Any]) -> Iterator[str]:
    where = f"scenes.{name}"
    if not SCENE_NAME.fullmatch(name):
        yield f"scenes: {name!r} is no name: allowed are a letter and up to 63 letters, digits, _ and -"
    if name.lower() in RESERVED_NAMES or name.lower().startswith(RESERVED_BEGINNINGS):
        others = ", ".join([*RESERVED_NAMES, *(f"{beginning}..." for beginning in RESERVED_BEGINNINGS)])
        yield f"{where}: a figure of its own has this name: allowed is any but {others}"

    yield from _wrong_model(config, name, scene)
    cells = [key for key in ("load_cell_a", "load_cell_b") if key in scene]
    if ("theta" in scene) == bool(cells) or len(cells) == 1:
        given = " and ".join([key for key in ("theta", *cells) if key in scene]) or "neither"
        yield f"{where} gives {given}: allowed is either theta or both load_cell_a and load_cell_b"
    if cells and "normal_load" in scene:
        yield (
            f"{where}.normal_load = {scene['normal_load']!r}: not allowed beside the load cells, "
            "whose sum is the normal load"
        )

    mu_s, mu_k = (scene.get(key, config["chain"][key]) for key in ("mu_s", "mu_k"))
    if mu_k > mu_s:
        culprit = where if {"mu_s", "mu_k"} & scene.keys() else "chain"
        yield f"{culprit}.mu_k = {mu_k!r} is larger than mu_s = {mu_s!r}: allowed is 0 <= mu_k <= mu_s"
    try:
        # First what it costs: a chain of too many blocks could not even be held.
        yield from too_long(config, where, scene_seconds(config, name) + trace_seconds(config, name))
        scene_chain(config, name)
    except ValueError as error:
        yield f"{where}: {error}"
    except OverflowError:
        yield f"{where}: numbers so far apart cannot be computed with: allowed are those of a slider"


def _wrong_model(config: Config, name: str, scene: Mapping[str, Any]) -> Iterator[str]:
    where, model = f"scenes.{name}", scene_model(config, name)
    if model not in MODEL_NAMES:
        yield f"{where}.model = {shown(model)} is no model: allowed are {', '.join(MODEL_NAMES)}"
        return
    for addition in ADDED.values():
        if addition in scene and model not in ADDED:
            yield (
                f"{where}.{addition} = {scene[addition]!r}: not allowed for the model {model!r}, "
                f"only for {', '.join(ADDED)}"
            )
    if model in ADDED and ADDED[model] not in scene:
        addition = ADDED[model]
        yield f"{where}.{addition} is missing: the model {model!r} needs a number > 0"
    if scene_outputs(config, name) == ("answers",):
        for key in ("duration", "paper"):
            if key in scene:
                yield (
                    f"{where}.{key}: not allowed for a scene that only answers quantities, "
                    "up to the end of the first global slip"
                )
