"""The configuration of the workflow: its files, put together and checked. The first
thing wrong with it is said in one line."""

import math
import os
import re
from collections import ChainMap
from collections.abc import Iterable, Mapping
from contextlib import suppress
from copy import deepcopy
from itertools import chain
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match
from snakemake.utils import update_config

from maegawa2010.scenes import Config, scene_slider, scenes_with_theta
from precursors.model.chain import Chain
from precursors.support.files import AnyPath, read_bytes

SECTIONS = (
    "chain",
    "load_cells",
    "duration",
    "scenes",
    "fig13",
    "figure",
    "figure_formats",
)
# YAML reads 010 as 8, 0x10 as 16, 1_0 as 10, and 1:30 as 90; .nan and .inf are no number
# to compute with.
NOT_PLAIN = re.compile(
    r"[-+]?(0[\d_]+|0x[\da-f_]+|0b[01_]+|\d[\d.]*_[\d_.]*(e[-+]?\d+)?"
    r"|\d[\d_]*(:[0-5]?\d)+(\.[\d_]*)?|\.(inf|nan))",
    re.IGNORECASE,
)
MOST_VALUES = 100_000  # in a file, those of aliases and merges written out
# Python's numbers that YAML reads as text.
TEXT_TO_YAML = re.compile(r"[-+]?(\d+|(\d*\.\d+|\d+\.)(?=e\d))e[-+]?\d+", re.IGNORECASE)


class Loader(yaml.CSafeLoader):
    """Reads each key once, no value that YAML takes for another, and no file whose
    aliases make it endless."""

    def construct_document(self, node: yaml.Node) -> Any:
        """Return what a file has."""
        if _size(node, {}) > MOST_VALUES:
            raise _misread(node, "aliases (*) and merges (<<) are nested too deep")
        return super().construct_document(node)

    def construct_mapping(
        self, node: yaml.MappingNode, deep: bool = False
    ) -> dict[Any, Any]:
        """Return a table, in which no key stands twice."""
        known: list[object] = []
        for key, _ in node.value:
            if key.value in known:
                raise _misread(key, f"the key {key.value!r} stands there twice")
            known.append(key.value)
        return super().construct_mapping(node, deep)

    def construct_scalar(self, node: Any) -> Any:
        """Return a value that is plain, or in quotes."""
        if not node.style and TEXT_TO_YAML.fullmatch(node.value):
            remedy = "write a number as 2.5e+9 and not as 2.5e9, or a text in quotes"
            raise _misread(node, f"{node.value} is text to YAML: {remedy}")
        if not node.style and NOT_PLAIN.fullmatch(node.value):
            remedy = "write a decimal number, or a text in quotes"
            raise _misread(node, f"{node.value} is not plain: {remedy}")
        return super().construct_scalar(node)


def _size(node: yaml.Node, known: dict[int, float]) -> float:
    """Number of values in a node with its aliases written out."""
    if id(node) not in known:
        known[id(node)] = math.inf  # of a node within itself
        inside = node.value if isinstance(node, yaml.CollectionNode) else []
        nodes = chain.from_iterable(x if isinstance(x, tuple) else [x] for x in inside)
        known[id(node)] = 1 + sum(_size(value, known) for value in nodes)
    return known[id(node)]


def _misread(node: Any, problem: str) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


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
    if "chain" in config:
        config["chain"] = read_numbers(config["chain"])
    check_sections(config, defaults)
    complete = deepcopy(defaults)
    update_config(complete, config)
    check_config(complete, workflow / "config.schema.yaml", contents)
    if complete["figure"]:
        from precursors.figures.style import Look  # slow

        Look(**complete["figure"])
    return complete


def read_settings(workflow: Path) -> dict[str, dict[str, Any]]:
    """What the settings of all studies, and those of each, give a configuration, by
    file."""
    shared = workflow / "settings.yaml"
    of_studies = sorted(workflow.glob("studies/*/settings.yaml"))
    return {str(shared): read_file(shared)} | {
        str(path): {path.parent.name: read_file(path)} for path in of_studies
    }


def long_settings(workflow: Path) -> dict[str, Any]:
    """The settings of full studies, those of each in its section."""
    settings = dict(ChainMap(*read_settings(workflow).values()))
    update_config(settings, read_file(workflow / "full.yaml"))
    return settings


def read_file(path: AnyPath) -> dict[str, Any]:
    """Read a YAML file; refuse one that cannot be read, has a key twice, or a number
    that YAML reads as another.

    The ValueError says in one line which file, where in it, and what is wrong.
    """
    try:
        config = yaml.load(read_bytes(path).decode(), Loader)
    except yaml.MarkedYAMLError as error:
        mark: Any = error.problem_mark
        place = f"in line {mark.line + 1}, column {mark.column + 1}"
        raise ValueError(_short(f"{path}: {error.problem} {place}")) from None
    except (yaml.YAMLError, ValueError, OSError) as error:
        raise ValueError(_short(f"{path}: {error}")) from None
    if not isinstance(config, dict):
        raise ValueError(f"{path} must be a table of keys and values")
    if "__use_yte__" in config:
        raise ValueError(f"{path}: __use_yte__: write values, not code that makes them")
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


def read_numbers(values: Any) -> Any:
    """Numbers of a section, also given as text, as by --config chain='{mu_k: 0.46}'."""
    if not isinstance(values, dict):
        return values

    def read(value: Any) -> Any:
        for kind in (int, float) if isinstance(value, str) else ():
            with suppress(ValueError):
                return kind(value)
        return value

    return {name: read(value) for name, value in values.items()}


def check_config(
    config: Config,
    schema_path: AnyPath,
    files: Mapping[str, Config] | None = None,
) -> None:
    """Refuse a configuration, as YAML gives it, that the workflow cannot run.

    The ValueError says in one line which value, where, and what it must be. `files` are
    the contents of the files from which the configuration was put together, the most
    important one last. The JSON schema is YAML, too.
    """
    schema = read_file(schema_path)
    for path in Path(schema_path).parent.glob("studies/*/schema.yaml"):
        section = path.parent.name
        if section in config:
            schema["properties"][section] = read_file(path)
    try:
        error = best_match(Draft202012Validator(schema).iter_errors(config))
        if error is None:
            _check_chains(config)
            _check_case(config["scenes"])
            check_names("fig13", config["fig13"], scenes_with_theta(config))
            return
    except ValueError as problem:
        raise ValueError(_short(f"configuration: {problem}")) from None
    where = error.json_path.removeprefix("$").lstrip(".") or "top level"
    message = error.message
    if "description" in error.schema:
        is_table = isinstance(error.instance, dict)
        given = list(error.instance) if is_table else error.instance
        message = f"{given!r} must {error.schema['description']}"
    message += _hint(error.instance)
    file = _file_with([*error.absolute_path], error.instance, files or {})
    raise ValueError(_short(f"{file}: {where}: {message}"))


def check_sections(config: Config, studies: Config) -> None:
    """Refuse a section, or a key of one, that neither the workflow nor a study has;
    `studies` has all sections of studies.

    The ValueError is one line.
    """
    for name, section in config.items():
        check_names("configuration:", [name], [*SECTIONS, *studies])
        known = studies.get(name)
        if isinstance(section, dict) and isinstance(known, dict):
            check_names(f"configuration: {name}", section, known)


def _hint(value: object) -> str:
    """How to write a number that is given as a text."""
    with suppress(ValueError):
        if isinstance(value, str) and math.isfinite(float(value)):
            return (
                ": this is text; write a number as 2.5e+9 and not as 2.5e9 or in quotes "
                "(within braces, --config has numbers as text)"
            )
    return ""


def _file_with(path: list[Any], value: Any, files: Mapping[str, Config]) -> str:
    """The most important file that has the value at the path."""
    found = "configuration"
    for file, content in files.items():
        there: Any = content
        with suppress(LookupError, TypeError):
            for key in path:
                there = there[key]
            found = file if there == value else found
    return found


def _short(message: str) -> str:
    """A message in one line, without the middle of long words and numbers."""
    cut = re.sub(r"(\S{80})\S{20,}", r"\1...", message)
    return " ".join(cut.split())


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


def _check_case(scenes: Iterable[str]) -> None:
    """Refuse two scenes whose files have one name where case does not count."""
    known: dict[str, str] = {}
    for name in scenes:
        other = known.setdefault(name.casefold(), name)
        if other != name:
            raise ValueError(f"scenes.{name} and {other} differ by case alone")


def check_names(where: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Refuse a name of nothing."""
    for name in names:
        if name not in known:
            raise ValueError(
                f"{where} holds {name!r}, but must hold names of {', '.join(known)}"
            )
