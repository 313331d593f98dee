"""Checks of a configuration: the first thing wrong with it, in one line."""

from __future__ import annotations

import math
import os
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

from precursors.model.chain import Chain, parse_theta
from precursors.model.checks import positive
from precursors.model.scenes import (
    Config,
    scene_additions,
    scene_duration,
    scene_slider,
    scenes_with_theta,
)

# Beyond these, a file takes minutes to read, or ends the interpreter.
LARGEST_FILE = 1_000_000  # bytes
DEEPEST = 20
MOST_VALUES = 20_000


def check_file(path: str | os.PathLike[str]) -> None:
    """Refuse a YAML file that cannot be read, has a key twice, or a number that YAML
    reads as another.

    The ValueError says in one line which file, where in it, and what is wrong.
    """
    import yaml

    class Loader(yaml.SafeLoader):
        """Reads plain values, and each key once; what could grow without end is
        refused."""

        depth = 0
        values = 0

        def compose_node(
            self, parent: yaml.Node | None, index: int
        ) -> yaml.Node | None:
            event = self.peek_event()
            self.depth += 1
            self.values += 1
            for is_too_much, problem in (
                (isinstance(event, yaml.AliasEvent), "write out what * stands for"),
                (self.depth > DEEPEST, f"more than {DEEPEST} tables in each other"),
                (self.values > MOST_VALUES, f"more than {MOST_VALUES} values"),
            ):
                if is_too_much:
                    raise yaml.MarkedYAMLError(
                        problem=problem, problem_mark=event.start_mark
                    )
            node = super().compose_node(parent, index)
            self.depth -= 1
            return node

        def construct_mapping(
            self, node: yaml.MappingNode, deep: bool = False
        ) -> dict[Any, Any]:
            keys = [key.value for key, _ in node.value]
            for i, (key, _) in enumerate(node.value):
                if key.value in keys[:i]:
                    raise yaml.MarkedYAMLError(
                        problem=f"the key {key.value!r} stands there twice",
                        problem_mark=key.start_mark,
                    )
            return super().construct_mapping(node, deep)

        def plain_number(self, node: yaml.ScalarNode) -> Any:
            """A number as people read it: YAML takes 010 for 8 and 1:30 for 90."""
            if ":" in node.value or re.match(r"[-+]?0[0-9_]+$", node.value):
                raise yaml.MarkedYAMLError(
                    problem=f"{node.value} is not plain: write a decimal number, or a text in quotes",
                    problem_mark=node.start_mark,
                )
            whole = node.tag.endswith("int")
            return (
                self.construct_yaml_int(node)
                if whole
                else self.construct_yaml_float(node)
            )

    for tag in ("int", "float"):
        Loader.add_constructor(f"tag:yaml.org,2002:{tag}", Loader.plain_number)

    try:
        if Path(path).stat().st_size > LARGEST_FILE:
            raise ValueError(f"a configuration may have {LARGEST_FILE:,} bytes")
        config = yaml.load(Path(path).read_text(encoding="utf-8"), Loader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f" in line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        raise ValueError(
            _short(f"{path}: {error.problem or error.context}{place}")
        ) from None
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


def check_config(config: Config, schema_path: str | os.PathLike[str]) -> None:
    """Refuse a configuration, as YAML gives it, that the workflow cannot run.

    The ValueError says in one line which value, where, and what it must be. The JSON
    schema is YAML, too.
    """
    import yaml
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import best_match

    schema = yaml.safe_load(Path(schema_path).read_text(encoding="utf-8"))
    error = best_match(Draft202012Validator(schema).iter_errors(config))
    if error is not None:
        where = error.json_path.removeprefix("$").lstrip(".") or "top level"
        hint = ""
        message = error.message
        if error.validator == "pattern" and "description" in error.schema:
            message = f"{error.instance!r} must be {error.schema['description']}"
        elif error.validator == "minItems":
            hint = f": at least {error.validator_value} are needed"
        with suppress(TypeError, ValueError):
            if isinstance(error.instance, str) and math.isfinite(float(error.instance)):
                hint = ": this is text; write a number without quotes, as 2.5e+9 and not as 2.5e9"
        raise ValueError(_short(f"configuration: {where}: {message}{hint}"))
    try:
        _check_chains(config)
        _check_names_and_lengths(config)
    except (ValueError, OverflowError) as error:
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
            scene_additions(config, name)
            positive("duration", scene_duration(config, name), "s")
        for name, values in config["accuracy"]["proved"].items():
            where = f"accuracy.proved.{name}"
            Chain.from_slider(
                **{key: value for key, value in values.items() if key != "duration"}
            )
        where = "theta in reproduction"
        for theta in config["reproduction"]["theta"]:
            parse_theta(theta)
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
