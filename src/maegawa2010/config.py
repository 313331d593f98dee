"""Checks of a configuration: the first thing wrong with it, in one line."""

from __future__ import annotations

import math
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

from maegawa2010.scenes import Config, scene_slider, scenes_with_theta
from precursors.model.chain import Chain, parse_theta
from precursors.support.files import AnyPath

LARGEST_FILE = 100_000  # bytes, which are read in a second
# YAML reads 010 as 8, and 1:30 as 90; .nan and .inf are no number to compute with.
NOT_PLAIN = re.compile(
    r"[-+]?(0[\d_]+|\d[\d_]*(:[0-5]?\d)+(\.[\d_]*)?|\.(inf|nan))", re.IGNORECASE
)


class Loader(yaml.SafeLoader):
    """Reads each key once, no value that YAML takes for another, and no aliases, of
    which ten lines can stand for 9**9 values."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Return the next part of the file."""
        if self.check_event(yaml.AliasEvent):
            raise _misread(self.peek_event(), "write out what * stands for")
        return super().compose_node(parent, index)

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
        if node.style is None and NOT_PLAIN.fullmatch(node.value):
            remedy = "write a decimal number, or a text in quotes"
            raise _misread(node, f"{node.value} is not plain: {remedy}")
        return super().construct_scalar(node)


def _misread(node: Any, problem: str) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


def check_file(path: AnyPath) -> None:
    """Refuse a YAML file that cannot be read, has a key twice, or a number that YAML
    reads as another.

    The ValueError says in one line which file, where in it, and what is wrong.
    """
    try:
        if Path(path).stat().st_size > LARGEST_FILE:
            raise ValueError(f"a configuration may have {LARGEST_FILE:,} bytes")
        config = yaml.load(Path(path).read_text(encoding="utf-8"), Loader)
    except yaml.MarkedYAMLError as error:
        mark: Any = error.problem_mark
        place = f"in line {mark.line + 1}, column {mark.column + 1}"
        raise ValueError(_short(f"{path}: {error.problem} {place}")) from None
    except RecursionError:
        raise ValueError(f"{path}: too many tables in each other") from None
    except (yaml.YAMLError, ValueError, OSError) as error:
        raise ValueError(_short(f"{path}: {error}")) from None
    if not isinstance(config, dict):
        raise ValueError(f"{path} must be a table of keys and values")


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


def check_config(config: Config, schema_path: AnyPath) -> None:
    """Refuse a configuration, as YAML gives it, that the workflow cannot run.

    The ValueError says in one line which value, where, and what it must be. The JSON
    schema is YAML, too.
    """
    schema = yaml.safe_load(Path(schema_path).read_text(encoding="utf-8"))
    error = best_match(Draft202012Validator(schema).iter_errors(config))
    if error is not None:
        where = error.json_path.removeprefix("$").lstrip(".") or "top level"
        message = error.message
        if "description" in error.schema:
            is_table = isinstance(error.instance, dict)
            given = list(error.instance) if is_table else error.instance
            message = f"{given!r} must {error.schema['description']}"
        with suppress(ValueError):
            if isinstance(error.instance, str) and math.isfinite(float(error.instance)):
                message += ": this is text; write a number without quotes, as 2.5e+9 and not as 2.5e9"
        raise ValueError(_short(f"configuration: {where}: {message}"))
    try:
        _check_chains(config)
        _check_names_and_lengths(config)
    except ValueError as error:
        raise ValueError(_short(f"configuration: {error}")) from None


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
        for name, values in config["accuracy"]["proved"].items():
            where = f"accuracy.proved.{name}"
            Chain.from_slider(
                **{key: value for key, value in values.items() if key != "duration"}
            )
        where = "theta in reproduction"
        for theta in config["reproduction"]["theta"]:
            parse_theta(theta)
    except OSError as error:
        raise ValueError(f"{where}: {error.filename}: {error.strerror}") from None
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{where}: {error}") from None


def _check_names_and_lengths(config: Config) -> None:
    """Refuse names of nothing, and lists that do not fit each other."""
    accuracy = config["accuracy"]
    for where, names, known in (
        ("fig13", config["fig13"], scenes_with_theta(config)),
        ("accuracy.compared", accuracy["compared"], accuracy["proved"]),
    ):
        for name in names:
            if name not in known:
                raise ValueError(
                    f"{where} holds {name!r}, but must hold names of {', '.join(known)}"
                )
    resolution = config["ensembles"]["resolution"]
    if len(resolution["runs"]) != len(resolution["n_blocks"]):
        raise ValueError(
            "ensembles.resolution.runs must have one number for each of n_blocks"
        )
