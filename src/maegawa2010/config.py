"""Merge and check the files of the workflow's configuration.

An error message has one line: which value, in which file, and what it must be.
"""

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
# Least similarity (as `difflib` measures it) at which another name is suggested.
SIMILARITY = 0.7


class Loader(yaml.CSafeLoader):
    """A YAML loader that refuses repeated keys and numbers that YAML reads as text."""

    def construct_mapping(
        self, node: yaml.MappingNode, deep: bool = False
    ) -> dict[Any, Any]:
        """Return a table, or refuse a repeated key."""
        keys = [key.value for key, _ in node.value]
        for i, (key, _) in enumerate(node.value):
            if key.value in keys[:i]:
                raise _misread(key, f"the key {key.value!r} is repeated")
        return super().construct_mapping(node, deep)

    def construct_scalar(self, node: Any) -> Any:
        """Return a value, or refuse one such as 2.5e9, which YAML reads as text."""
        if node.tag == TEXT and not node.style and _as_number(node.value) != node.value:
            remedy = "write a number as 2.5e+9 and not as 2.5e9, or a text in quotes"
            raise _misread(node, f"{node.value} is text to YAML: {remedy}")
        return super().construct_scalar(node)


def _misread(node: Any, problem: str) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


def _as_number(value: Any) -> Any:
    """The number that a text stands for, or the value unchanged."""
    for kind in (int, float) if isinstance(value, str) else ():
        with suppress(ValueError):
            return kind(value)
    return value


def load_config(
    given: Config, files: Mapping[str, Config], workflow: Path
) -> dict[str, Any]:
    """Merge a configuration with the default settings, and check it.

    Parameters
    ----------
    given
        The configuration as Snakemake read it, including the command line.
    files
        The contents of its files by path; a later file overrides an earlier one.
    workflow
        Directory with the default settings and the schemas.

    Raises
    ------
    ValueError
        If a value is wrong: one line that says which, where, and what it must be.
    """
    settings = read_settings(workflow)
    defaults = dict(ChainMap(*settings.values()))
    contents = {**settings, **files}
    config = deepcopy(dict(given))
    for path, content in reversed(contents.items()):
        place_weights(config, path, content)
    if isinstance(chain := config.get("chain"), dict):
        # Snakemake passes the numbers of --config chain='{mu_k: 0.46}' as text.
        config["chain"] = {name: _as_number(value) for name, value in chain.items()}
    complete = deepcopy(defaults)
    update_config(complete, config)
    check_config(complete, defaults, workflow / "config.schema.yaml", contents)
    return complete


def read_settings(workflow: Path) -> dict[str, dict[str, Any]]:
    """Default settings by file: those that all studies share, and those of each study."""
    shared = workflow / "settings.yaml"
    of_studies = sorted(workflow.glob("studies/*/settings.yaml"))
    return {str(shared): read_file(shared)} | {
        str(path): {path.parent.name: read_file(path)} for path in of_studies
    }


def long_settings(workflow: Path) -> dict[str, Any]:
    """The settings of a full build, with a section for each study."""
    settings = dict(ChainMap(*read_settings(workflow).values()))
    update_config(settings, read_file(workflow / "full.yaml"))
    return settings


def read_file(path: AnyPath) -> dict[str, Any]:
    """Read a YAML file.

    Raises
    ------
    ValueError
        In one line: which file, where in it, and what is wrong.
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
    """Make the paths of files of normal loads relative to the configuration file that
    names them.

    `content` is the content of that file, `path` its path.
    """
    # The schema refuses malformed scenes later.
    with suppress(AttributeError, LookupError, TypeError):
        for name, scene in content["scenes"].items():
            file = scene.get("weights")
            merged = config["scenes"][name]
            # Another file or the command line may override this one.
            if isinstance(file, str) and merged["weights"] == file:
                beside = os.path.join(os.path.dirname(path) or os.curdir, file)
                merged["weights"] = beside


def check_config(
    config: Config,
    studies: Config,
    schema_path: AnyPath,
    files: Mapping[str, Config] | None = None,
) -> None:
    """Refuse a configuration that the workflow cannot run.

    Parameters
    ----------
    config
        The merged configuration, as YAML gives it.
    studies
        Default settings of all studies by section.
    schema_path
        The JSON schema, written in YAML.
    files
        The contents of the merged files by path; a later file overrides an earlier one.

    Raises
    ------
    ValueError
        In one line: which value, where, and what it must be.
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
        raise _refusal(*_file_and_problem(error, files or {}))
    try:
        _check_chains(config)
        check_names("fig13", config["fig13"], scenes_with_theta(config))
        if config["figure"]:
            from precursors.figures.style import Look  # slow

            Look(**config["figure"])
    except ValueError as problem:
        raise _refusal("configuration", problem) from None


def _add_keys(schema: dict[str, Any], studies: Config) -> None:
    """Allow the sections of studies and their keys in the schema."""
    for name, section in studies.items():
        known = schema["properties"].setdefault(name, {})
        if isinstance(section, dict):
            keys = dict.fromkeys(section, True) | known.get("properties", {})
            known |= {"type": "object", "properties": keys}
            known["additionalProperties"] = False


def _file_and_problem(error: Any, files: Mapping[str, Config]) -> tuple[str, str]:
    """The file with the value that the schema refuses, and what is wrong with it."""
    where = error.json_path.removeprefix("$").lstrip(".") or "top level"
    place = [*error.absolute_path]
    value = error.instance
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        key = next(key for key in value if key not in known)
        file = _file_with([*place, key], value[key], files)
        return file, f"{where} has no key {key!r}: {suggestion(key, known)}"
    message = error.message
    if "description" in error.schema:
        given = list(value) if isinstance(value, dict) else value
        message = f"{given!r} must {error.schema['description']}"
    return _file_with(place, value, files), f"{where}: {message}"


def _file_with(path: list[Any], value: Any, files: Mapping[str, Config]) -> str:
    """The last file that has this value at this path of keys."""
    last = "configuration"
    for file, content in files.items():
        there: Any = content
        with suppress(LookupError, TypeError):
            for key in path:
                there = there[key]
            last = file if there == value else last
    return last


def _refusal(where: AnyPath, problem: object) -> ValueError:
    """An error whose message has one line."""
    return ValueError(f"{where}: {' '.join(str(problem).split())}")


def _check_chains(config: Config) -> None:
    """Check the values of every chain of the configuration."""
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
    """Refuse an unknown name."""
    known = [*known]
    for name in names:
        if name not in known:
            raise ValueError(f"{where} has {name!r}: {suggestion(name, known)}")


def suggestion(name: object, known: Iterable[str]) -> str:
    """Suggest the known name that is most similar to an unknown one, or list all."""
    known = [*known]
    like = get_close_matches(str(name), known, 1, SIMILARITY)
    if like:
        return f"did you mean {like[0]!r}?"
    return f"it must be one of {', '.join(known)}"
