"""The configuration of the workflow: what it must hold, and the chain that a scene of it stands for."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from precursors.chain import Chain, parse_theta, theta_from_load_cells
from precursors.scene_models import ADDED, ANSWERED, PAPERS_MODEL, SIMULATED, UNITS

Config = Mapping[str, Any]

SCENE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
# Values inside values, and whole numbers, that no configuration needs.
DEEPEST, LARGEST_INTEGER = 12, 2**63
LONGEST_LINE = 500
# Computing time [s] above which a scene is refused, unless the configuration has a `longest_run` of its own.
LONGEST_RUN = 3600.0
# Of the exact solver at N = 10, one window being about a third of the fastest period.
SECONDS_PER_WINDOW = 1e-6
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

    What its model adds to the paper's chain is among its own values. Two load cells give theta and the
    total normal load F_Z = F_ZA + F_ZB.
    """
    scene = config["scenes"][name]
    slider = {key: scene.get(key, value) for key, value in config["chain"].items()}
    slider |= {key: scene[key] for key in ADDED.values() if key in scene}
    if "theta" in scene:
        return slider | {"theta": parse_theta(scene["theta"])}
    a, b = scene["load_cell_a"], scene["load_cell_b"]
    theta = theta_from_load_cells(a, b, spacing=config["load_cells"]["spacing"], length=slider["length"])
    return slider | {"theta": theta, "normal_load": math.fsum([a, b])}


def scene_chain(config: Config, name: str) -> Chain:
    """The chain of a scene (Eqs. 7, 9 and 10)."""
    return Chain.from_slider(**scene_slider(config, name))


def scene_seconds(config: Config, name: str) -> float:
    """Time that a scene is expected to take on one core [s], to a factor of ten; infinite beyond all numbers.

    It grows with the slips that the drive makes of the chain, and is never more than that of blocks which
    slide all the time.
    """
    import numpy as np

    from precursors.ensembles.chunks import seconds_of_long_run, seconds_of_ringing
    from precursors.ensembles.study import loading_time

    with np.errstate(all="ignore"):
        slider = {key: np.float64(value) for key, value in scene_slider(config, name).items()}
        duration, n_blocks = np.float64(scene_duration(config, name)), slider["n_blocks"]
        loadings = duration / loading_time(slider)
        slipping = float(seconds_of_long_run(n_blocks, loadings, slider["mu_k"] / slider["mu_s"]))
        stiffness = n_blocks * slider["youngs_modulus"] * slider["cross_section"] / slider["length"]
        stiffest = np.maximum(4 * stiffness, slider["drive_stiffness"] + 2 * stiffness)
        windows = duration * np.sqrt(stiffest * n_blocks / slider["slider_mass"])
        sliding = float(SECONDS_PER_WINDOW * windows * (1 + n_blocks / 10))
        springs, viscosity = slider.get("interface_stiffness", 0.0), slider.get("viscosity", 0.0)
        ringing = float(loadings * seconds_of_ringing(n_blocks, springs, viscosity))
    known = [seconds for seconds in (slipping, sliding) if not math.isnan(seconds)]
    return min(known, default=math.inf) + ringing


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
        raise ValueError(f"configuration: {_one_line(complaint)}")


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
    yield from _odd_values("", config)
    yield from _against_schema(config, schema_path)
    for name, scene in config["scenes"].items():
        yield from _wrong_scene(config, name, scene)
    for name in config["fig13"]:
        if name not in config["scenes"]:
            yield f"fig13 names {name!r}, which is no scene: allowed are {', '.join(config['scenes'])}"
        elif scene_model(config, name) != PAPERS_MODEL or "run" not in scene_outputs(config, name):
            yield f"fig13 names {name!r}: allowed are scenes of the model {PAPERS_MODEL!r} without quantities"
    proved = config["horizon"]["chains"]
    for name in config["accuracy"]["chains"]:
        if name not in proved:
            yield (
                f"accuracy.chains names {name!r}, which is no chain of horizon.chains: "
                f"allowed are {', '.join(proved)}"
            )


def _odd_values(where: str, value: object, depth: int = 0) -> Iterator[str]:
    """Keys, numbers and depths that YAML can write and no schema refuses."""
    if depth > DEEPEST:
        yield f"{where[:60]}... holds values inside values without end: allowed are {DEEPEST} levels"
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            if not isinstance(key, str):
                yield f"{where or 'top level'}: the key {key!r} is no text: allowed is a name or quotes"
            yield from _odd_values(_join(where, key), inner, depth + 1)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from _odd_values(f"{where}[{i}]", inner, depth + 1)
    elif isinstance(value, float) and not math.isfinite(value):
        yield f"{where} = {value!r} is not finite: allowed is a finite number"
    elif isinstance(value, int) and abs(value) > LARGEST_INTEGER:
        yield f"{where} is a whole number of {value.bit_length()} bits: allowed are numbers up to 2^63"


@lru_cache(maxsize=1)
def _schema(text: str) -> Any:
    import yaml

    return yaml.safe_load(text)


def _against_schema(config: Config, schema_path: str | os.PathLike[str]) -> Iterator[str]:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import relevance

    schema = _schema(Path(schema_path).read_text(encoding="utf-8"))
    errors = Draft202012Validator(schema).iter_errors(config)
    for error in sorted(errors, key=relevance, reverse=True):
        where = ""
        for part in error.absolute_path:
            where = f"{where}[{part}]" if isinstance(part, int) else _join(where, part)
        if error.validator == "required":
            missing = next(key for key in error.validator_value if key not in error.instance)
            what = error.schema["properties"].get(missing, {})
            yield f"{_join(where, missing)} is missing: needed is {_allowed(_resolve(schema, what))}"
        elif error.validator == "additionalProperties":
            known = error.schema["properties"]
            unknown = next(key for key in error.instance if key not in known)
            yield f"{_join(where, unknown)} is an unknown key: allowed are {', '.join(known)}"
        else:
            hint = _yaml_hint(error.instance) if error.validator == "type" else ""
            shown = f"{where or 'top level'} = {_shown(error.instance)}{hint}"
            yield f"{shown}: allowed is {_allowed(error.schema)}"


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
        longest, seconds = float(config.get("longest_run", LONGEST_RUN)), scene_seconds(config, name)
        if seconds > longest:
            yield (
                f"{where} would take about {seconds:.1g} s: allowed is longest_run = {longest:g} s "
                "(fewer blocks, a shorter duration, or a larger longest_run)"
            )
        scene_chain(config, name)
    except ValueError as error:
        yield f"{where}: {error}"
    except OverflowError:
        yield f"{where}: numbers so far apart cannot be computed with: allowed are those of a slider"


def _wrong_model(config: Config, name: str, scene: Mapping[str, Any]) -> Iterator[str]:
    where, model = f"scenes.{name}", scene_model(config, name)
    if model not in ANSWERED:
        yield f"{where}.model = {_shown(model)} is no model: allowed are {', '.join(ANSWERED)}"
        return  # nothing is known of what it answers
    for quantity in scene.get("quantities", ()):
        if quantity not in ANSWERED[model]:
            answered = ", ".join(ANSWERED[model])
            yield (
                f"{where}.quantities: {_shown(quantity)} is none that the model {model!r} answers: "
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


def _one_line(text: str) -> str:
    """A complaint whatever is in the names that it quotes: one line, without its middle if it is long."""
    line = "".join(c if c.isprintable() else " " for c in text)
    return (
        line if len(line) <= LONGEST_LINE else f"{line[: LONGEST_LINE // 2]} ... {line[-LONGEST_LINE // 2 :]}"
    )


def _join(where: str, key: object) -> str:
    return f"{where}.{key}" if where else str(key)


def _resolve(schema: Mapping[str, Any], part: Mapping[str, Any]) -> Mapping[str, Any]:
    """The definition that a part of the schema refers to, or the part itself."""
    return schema["$defs"][part["$ref"].rpartition("/")[2]] if "$ref" in part else part


_KINDS = {
    "number": "a number",
    "integer": "a whole number",
    "string": "a text",
    "object": "a table of keys and values",
    "array": "a list",
}


def _allowed(schema: Mapping[str, Any]) -> str:
    """What a part of the schema allows, with its range and its description (which names the unit)."""
    kinds = schema.get("type", [])
    text = " or ".join(_KINDS[kind] for kind in ([kinds] if isinstance(kinds, str) else kinds))
    limits = {
        "exclusiveMinimum": "> {}",
        "minimum": ">= {}",
        "maximum": "<= {}",
        "minLength": "of at least {} character",
        "maxLength": "of at most {} characters",
        "minProperties": "with at least {} entry",
        "minItems": "of {} different entries",
    }
    ranges = [form.format(schema[key]) for key, form in limits.items() if key in schema]
    about = f" ({schema['description'].rstrip('.')})" if "description" in schema else ""
    return " ".join([text, " and ".join(ranges)]).strip() + about


def _shown(value: object) -> str:
    if value is None:
        return "(empty)"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _yaml_hint(value: object) -> str:
    """How to write a number that YAML took for text: with a point and a signed exponent."""
    if not isinstance(value, str):
        return ""
    written = re.fullmatch(r"([-+]?\d+)(\.\d*)?[eE]([-+]?)(\d+)", value.strip())
    if not written:
        return " is text"
    whole, fraction, sign, exponent = written.groups()
    return f" is text to YAML (write {whole}{fraction or '.0'}e{sign or '+'}{exponent})"
