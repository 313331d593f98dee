"""The configuration of the workflow: what it must hold, and the chain that a scene of it stands for."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from precursors.chain import Chain, parse_theta, theta_from_load_cells

Config = Mapping[str, Any]

SCENE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
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
)
RESERVED_BEGINNINGS = ("map_", "spread_", "step_sweep", "work_precision")


def scene_names(config: Config) -> list[str]:
    """Names of the scenes, in the order of the configuration."""
    return list(config["scenes"])


def scene_duration(config: Config, name: str) -> float:
    """Time that the scene is simulated for [s]."""
    return float(config["scenes"][name].get("duration", config["duration"]))


def scene_slider(config: Config, name: str) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` for a scene: `chain`, the scene's own values, and its normal loading.

    Two load cells give theta and the total normal load F_Z = F_ZA + F_ZB.
    """
    scene = config["scenes"][name]
    slider = {key: scene.get(key, value) for key, value in config["chain"].items()}
    if "theta" in scene:
        return slider | {"theta": parse_theta(scene["theta"])}
    a, b = scene["load_cell_a"], scene["load_cell_b"]
    theta = theta_from_load_cells(a, b, spacing=config["load_cells"]["spacing"], length=slider["length"])
    return slider | {"theta": theta, "normal_load": math.fsum([a, b])}


def scene_chain(config: Config, name: str) -> Chain:
    """The chain of a scene (Eqs. 7, 9 and 10)."""
    return Chain.from_slider(**scene_slider(config, name))


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
        raise ValueError(f"configuration: {complaint}")


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
    proved = config["horizon"]["chains"]
    for name in config["accuracy"]["chains"]:
        if name not in proved:
            yield (
                f"accuracy.chains names {name!r}, which is no chain of horizon.chains: "
                f"allowed are {', '.join(proved)}"
            )


def _odd_values(where: str, value: object) -> Iterator[str]:
    """Keys and numbers that YAML can write and no schema refuses."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            if not isinstance(key, str):
                yield f"{where or 'top level'}: the key {key!r} is no text: allowed is a name or quotes"
            yield from _odd_values(_join(where, key), inner)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from _odd_values(f"{where}[{i}]", inner)
    elif isinstance(value, float) and not math.isfinite(value):
        yield f"{where} = {value!r} is not finite: allowed is a finite number"


def _against_schema(config: Config, schema_path: str | os.PathLike[str]) -> Iterator[str]:
    import yaml
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import relevance

    schema = yaml.safe_load(Path(schema_path).read_text(encoding="utf-8"))
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
        scene_chain(config, name)
    except ValueError as error:
        yield f"{where}: {error}"


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
