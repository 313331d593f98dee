"""The configuration of the workflow: its files, put together and checked. What is wrong
is said in one line: which value, in which file, and what it must be."""

import os
from collections import ChainMap
from collections.abc import Iterable, Mapping
from contextlib import suppress
from copy import deepcopy
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match
from snakemake.utils import update_config

from maegawa2010.scenes import Config, scene_slider, scenes_with_theta
from precursors.model.chain import Chain
from precursors.support.files import AnyPath, read_bytes

TEXT = "tag:yaml.org,2002:str"
# Of letters that two words share: a name that is as like as this may be meant.
ALIKE = 0.7


class Loader(yaml.CSafeLoader):
    """Reads each key once, and no number as text."""

    def construct_mapping(
        self, node: yaml.MappingNode, deep: bool = False
    ) -> dict[Any, Any]:
        """Return a table, in which no key stands twice."""
        keys = [key.value for key, _ in node.value]
        for i, (key, _) in enumerate(node.value):
            if key.value in keys[:i]:
                raise _misread(key, f"the key {key.value!r} stands there twice")
        return super().construct_mapping(node, deep)

    def construct_scalar(self, node: Any) -> Any:
        """Return a value; Python's 2.5e9 is refused, which YAML reads as text."""
        if node.tag == TEXT and not node.style and _as_number(node.value) != node.value:
            remedy = "write a number as 2.5e+9 and not as 2.5e9, or a text in quotes"
            raise _misread(node, f"{node.value} is text to YAML: {remedy}")
        return super().construct_scalar(node)


def _misread(node: Any, problem: str) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


def _as_number(value: Any) -> Any:
    """The number that a text is, if it is one."""
    for kind in (int, float) if isinstance(value, str) else ():
        with suppress(ValueError):
            return kind(value)
    return value


def load_config(
    given: Config, files: Mapping[str, Config], workflow: Path
) -> dict[str, Any]:
    """Put a configuration together, and check it.

    Parameters
    ----------
    given
        What Snakemake has read, the command line included.
    files
        The contents of the files that it was read from, the most important one last.
    workflow
        Directory of the settings, which have what is not given, and of the schemas.

    Raises
    ------
    ValueError
        In one line: which value, where, and what it must be.
    """
    settings = read_settings(workflow)
    defaults = dict(ChainMap(*settings.values()))
    contents = {**settings, **files}
    config = deepcopy(dict(given))
    for path, content in reversed(contents.items()):
        place_weights(config, path, content)
    if isinstance(chain := config.get("chain"), dict):
        # --config chain='{mu_k: 0.46}' has numbers as text.
        config["chain"] = {name: _as_number(value) for name, value in chain.items()}
    complete = deepcopy(defaults)
    update_config(complete, config)
    check_config(complete, defaults, workflow / "config.schema.yaml", contents)
    return complete


def read_settings(workflow: Path) -> dict[str, dict[str, Any]]:
    """What the settings of all studies, and those of each, give a configuration, by
    file."""
    shared = workflow / "settings.yaml"
    of_studies = sorted(workflow.glob("studies/*/settings.yaml"))
    return {str(shared): read_file(shared)} | {
        str(path): {path.parent.name: read_file(path)} for path in of_studies
    }


def read_file(path: AnyPath) -> dict[str, Any]:
    """Read a YAML file.

    The ValueError says in one line which file, where in it, and what is wrong.
    """
    try:
        config = yaml.load(read_bytes(path).decode(), Loader)
    except yaml.MarkedYAMLError as error:
        mark: Any = error.problem_mark
        place = f"in line {mark.line + 1}, column {mark.column + 1}"
        raise _refusal(path, f"{error.problem} {place}") from None
    except (yaml.YAMLError, ValueError, OSError) as error:
        raise _refusal(path, error) from None
    if not isinstance(config, dict):
        raise _refusal(path, "it must be a table of keys and values")
    return config


def place_weights(config: dict[str, Any], path: AnyPath, content: Config) -> None:
    """Files of normal loads lie beside the file that names them, whose content is
    given."""
    # What is no scene is refused by the schema.
    with suppress(AttributeError, LookupError, TypeError):
        for name, scene in content["scenes"].items():
            file = scene.get("weights")
            merged = config["scenes"][name]
            # Unless another file or the command line names another one.
            if isinstance(file, str) and merged["weights"] == file:
                beside = os.path.join(os.path.dirname(path) or os.curdir, file)
                merged["weights"] = beside


def check_config(
    config: Config,
    studies: Config,
    schema_path: AnyPath,
    files: Mapping[str, Config] | None = None,
) -> None:
    """Refuse a configuration, as YAML gives it, that the workflow cannot run.

    The ValueError says in one line which value, where, and what it must be. `studies`
    has all sections of studies. `files` are the contents of the files from which the
    configuration was put together, the most important one last. The JSON schema is
    YAML, too.
    """
    schema = read_file(schema_path)
    for path in Path(schema_path).parent.glob("studies/*/schema.yaml"):
        section = path.parent.name
        if section in config:
            schema["properties"][section] = read_file(path)
    _add_keys(schema, studies)
    errors = [*Draft202012Validator(schema).iter_errors(config)]
    unknown = [error for error in errors if error.validator == "additionalProperties"]
    if error := best_match(unknown or errors):
        raise _refusal(*_said_of(error, files or {}))
    try:
        _check_chains(config)
        check_names("fig13", config["fig13"], scenes_with_theta(config))
        if config["figure"]:
            from precursors.figures.style import Look  # slow

            Look(**config["figure"])
    except ValueError as problem:
        raise _refusal("configuration", problem) from None


def _add_keys(schema: dict[str, Any], studies: Config) -> None:
    """Enter the sections of studies and the keys of each into the schema, which refuses
    all others."""
    for name, section in studies.items():
        known = schema["properties"].setdefault(name, {})
        if isinstance(section, dict):
            keys = dict.fromkeys(section, True) | known.get("properties", {})
            known |= {"type": "object", "properties": keys}
            known["additionalProperties"] = False


def _said_of(error: Any, files: Mapping[str, Config]) -> tuple[str, str]:
    """The file with a value that the schema refuses, and what is wrong with it."""
    where = error.json_path.removeprefix("$").lstrip(".") or "top level"
    place = [*error.absolute_path]
    value = error.instance
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        key = next(key for key in value if key not in known)
        file = _file_with([*place, key], value[key], files)
        return file, f"{where} has no key {key!r}: {meant(key, known)}"
    message = error.message
    if "description" in error.schema:
        given = list(value) if isinstance(value, dict) else value
        message = f"{given!r} must {error.schema['description']}"
    return _file_with(place, value, files), f"{where}: {message}"


def _file_with(path: list[Any], value: Any, files: Mapping[str, Config]) -> str:
    """The most important file that has the value at the path."""
    last = "configuration"
    for file, content in files.items():
        there: Any = content
        with suppress(LookupError, TypeError):
            for key in path:
                there = there[key]
            last = file if there == value else last
    return last


def _refusal(where: AnyPath, problem: object) -> ValueError:
    """What is wrong, in one line."""
    return ValueError(f"{where}: {' '.join(str(problem).split())}")


def _check_chains(config: Config) -> None:
    """Make every chain of the configuration; its own errors say what is wrong."""
    where = "chain"
    try:
        Chain.from_slider(**config["chain"])
        for name in config["scenes"]:
            where = f"scenes.{name}"
            Chain.from_slider(**scene_slider(config, name))
    except OSError as error:
        raise ValueError(f"{where}: {error.filename}: {error.strerror}") from None
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{where}: {error}") from None


def check_names(where: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Refuse a name of nothing."""
    known = [*known]
    for name in names:
        if name not in known:
            raise ValueError(f"{where} has {name!r}: {meant(name, known)}")


def meant(name: object, known: Iterable[str]) -> str:
    """The one of the known names that is like a name, or all of them."""
    known = [*known]
    like = get_close_matches(str(name), known, 1, ALIKE)
    if like:
        return f"did you mean {like[0]!r}?"
    return f"it must be one of {', '.join(known)}"
