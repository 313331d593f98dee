"""The configuration of the workflow: what it must hold, and the chain that a scene of it stands for."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from precursors.chain import Chain, exact_theta_from_load_cells, parse_theta
from precursors.config_schema import against_schema, joined, shown
from precursors.plain_yaml import DEEPEST
from precursors.scene_models import ADDED, ANSWERED, PAPERS_MODEL, SIMULATED, UNITS

Config = Mapping[str, Any]

SCENE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
# Whole numbers that no configuration needs.
LARGEST_INTEGER = 2**63
# Values of a configuration, each as often as YAML's aliases repeat it; the paper's has 500.
MOST_VALUES = 100_000
LONGEST_LINE = 500
# Computing time [s] above which a scene is refused, unless the configuration has a `longest_run` of its own.
LONGEST_RUN = 3600.0
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
    "resolution_models_full",
)
RESERVED_BEGINNINGS = ("map_", "spread_", "step_sweep", "work_precision")


def scene_names(config: Config) -> list[str]:
    """Names of the scenes, in the order of the configuration."""
    return list(config["scenes"])


def scene_model(config: Config, name: str) -> str:
    """The model of a scene, a key of `reduced.MODELS`."""
    return str(config["scenes"][name].get("model", PAPERS_MODEL))


def scene_quantities(config: Config, name: str) -> tuple[str, ...]:
    """Quantities that a scene asks its model for, by default all that the model answers."""
    return tuple(config["scenes"][name].get("quantities", ANSWERED[scene_model(config, name)]))


def scene_outputs(config: Config, name: str) -> tuple[str, ...]:
    """What is made of a scene: "run", "slips", "trace" and "figure", or nothing but "answers".

    Only models that are followed through time have a run; a scene that names its quantities asks for no more.
    """
    if scene_model(config, name) in SIMULATED and "quantities" not in config["scenes"][name]:
        return ("run", "slips", "trace", "figure")
    return ("answers",)


def scenes_with(config: Config, output: str) -> list[str]:
    """Names of the scenes that have this output (see `scene_outputs`), in the order of the configuration."""
    return [name for name in scene_names(config) if output in scene_outputs(config, name)]


def scene_duration(config: Config, name: str) -> float:
    """Time that the scene is simulated for [s]."""
    return float(config["scenes"][name].get("duration", config["duration"]))


def scene_slider(config: Config, name: str) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` for a scene: `chain`, the scene's own values, and its normal loading.

    Theta and the sum of two load cells are rounded once, to the nearest doubles.
    """
    slider = scene_as_written(config, name)
    rounded = {key: float(value) for key, value in slider.items() if isinstance(value, Fraction)}
    return slider | rounded | {"theta": parse_theta(slider["theta"])}


def scene_as_written(config: Config, name: str) -> dict[str, Any]:
    """The same before any rounding: numbers and theta as they are written, those of load cells as fractions.

    What its model adds to the paper's chain is among its own values. Two load cells give theta and the
    total normal load F_Z = F_ZA + F_ZB.
    """
    scene = config["scenes"][name]
    slider = {key: scene.get(key, value) for key, value in config["chain"].items()}
    slider |= {key: scene[key] for key in ADDED.values() if key in scene}
    if "theta" in scene:
        return slider | {"theta": scene["theta"]}
    a, b = scene["load_cell_a"], scene["load_cell_b"]
    theta = exact_theta_from_load_cells(
        a, b, spacing=config["load_cells"]["spacing"], length=slider["length"]
    )
    return slider | {"theta": theta, "normal_load": Fraction(repr(a)) + Fraction(repr(b))}


def scene_chain(config: Config, name: str) -> Chain:
    """The chain of a scene (Eqs. 7, 9 and 10)."""
    return Chain.from_slider(**scene_slider(config, name))


def scene_seconds(config: Config, name: str) -> float:
    """Time that the run of a scene is expected to take on one core [s] (see `precursors.cost`)."""
    from precursors.cost import seconds_of_run

    return seconds_of_run(scene_slider(config, name), scene_duration(config, name))


def trace_seconds(config: Config, name: str) -> float:
    """Time that the trace of a scene is expected to take, where it has one [s]."""
    from precursors.cost import TRACE_PER_RUN

    return TRACE_PER_RUN * scene_seconds(config, name) if "trace" in scene_outputs(config, name) else 0.0


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


def _complaints(config: Config, schema_path: str | os.PathLike[str]) -> Iterator[str]:
    """What is wrong, the first thing first; later checks rely on the earlier ones."""
    from precursors.config_studies import wrong_studies

    yield from too_many(config)
    yield from _odd_values("", config)
    yield from against_schema(config, schema_path)
    for name, scene in config["scenes"].items():
        yield from _wrong_scene(config, name, scene)
    for name in config["fig13"]:
        if name not in config["scenes"]:
            yield f"fig13 names {name!r}, which is no scene: allowed are {', '.join(config['scenes'])}"
        elif scene_model(config, name) != PAPERS_MODEL or "run" not in scene_outputs(config, name):
            yield f"fig13 names {name!r}: allowed are scenes of the model {PAPERS_MODEL!r} without quantities"
    yield from wrong_studies(config)


def too_many(config: Config) -> Iterator[str]:
    """Values inside values without end, and more than can be looked at: ten lines of YAML hold a billion."""
    for key, value in config.items():
        number = _count(value, {})
        if number == math.inf:
            yield f"{key} holds values inside values without end: allowed are {DEEPEST} levels"
        if number > MOST_VALUES:
            yield f"{key} holds {number} values, by aliases of aliases: allowed are {MOST_VALUES}"


def _count(value: object, known: dict[int, float], depth: int = 1) -> float:
    """Number of values in a value, each as often as an alias repeats it; infinite if they are too deep."""
    if depth > DEEPEST:
        return math.inf
    if not isinstance(value, Mapping | list):
        return 1
    if id(value) not in known:
        known[id(value)] = math.inf  # for a value that holds itself
        inner = value.values() if isinstance(value, Mapping) else value
        known[id(value)] = 1 + sum(_count(item, known, depth + 1) for item in inner)
    return known[id(value)]


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


def too_long(config: Config, where: str, seconds: float) -> Iterator[str]:
    """Refuse what is expected to take longer than `longest_run`."""
    longest = float(config.get("longest_run", LONGEST_RUN))
    if seconds > longest:
        yield (
            f"{where} would take about {seconds:.1g} s: allowed is longest_run = {longest:g} s "
            "(fewer blocks, a shorter duration, or a larger longest_run)"
        )


def _wrong_model(config: Config, name: str, scene: Mapping[str, Any]) -> Iterator[str]:
    where, model = f"scenes.{name}", scene_model(config, name)
    if model not in ANSWERED:
        yield f"{where}.model = {shown(model)} is no model: allowed are {', '.join(ANSWERED)}"
        return  # nothing is known of what it answers
    for quantity in scene.get("quantities", ()):
        if quantity not in ANSWERED[model]:
            answered = ", ".join(ANSWERED[model])
            yield (
                f"{where}.quantities: {shown(quantity)} is none that the model {model!r} answers: "
                f"allowed are {answered}"
            )
    for addition in ADDED.values():
        if addition in scene and model not in ADDED:
            yield (
                f"{where}.{addition} = {scene[addition]!r} [{UNITS[addition]}]: not allowed for the model "
                f"{model!r}, only for {', '.join(ADDED)}"
            )
    if model in ADDED and ADDED[model] not in scene:
        addition = ADDED[model]
        yield (
            f"{where}.{addition} is missing: needed for the model {model!r} is a number > 0 "
            f"[{UNITS[addition]}]"
        )
    if scene_outputs(config, name) == ("answers",):
        for key in ("duration", "paper"):
            if key in scene:
                yield (
                    f"{where}.{key}: not allowed for a scene that only answers quantities, "
                    "up to the end of the first global slip"
                )


def one_line(text: str) -> str:
    """A complaint whatever is in the names that it quotes: one line, without its middle if it is long."""
    line = "".join(c if c.isprintable() else " " for c in text)
    return (
        line if len(line) <= LONGEST_LINE else f"{line[: LONGEST_LINE // 2]} ... {line[-LONGEST_LINE // 2 :]}"
    )
