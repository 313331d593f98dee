"""The file of a configuration, before Snakemake reads it: plain values, each key once, and an end to them."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from precursors.model.plain_yaml import one_line, parse_yaml, too_many

# Snakemake evaluates Python in a configuration file that has this key.
EVALUATED = "__use_yte__"


def check_config_file(path: str | os.PathLike[str]) -> None:
    """Refuse a configuration file that Snakemake would misread, evaluate or not come to the end of.

    Of a key that stands twice, YAML takes the second one silently. A missing file is left to Snakemake.

    Raises
    ------
    ValueError
        One line: which file, where, and what is allowed.
    """
    if not os.path.exists(path):
        return
    try:
        config = _plain_yaml(Path(path).read_text(encoding="utf-8-sig"))
    except (ValueError, RecursionError, OverflowError, OSError) as error:
        what = "it is nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise ValueError(f"configuration: Config file {one_line(f'{path}: {what}')}") from None
    for complaint in _odd_file(config):
        raise ValueError(f"configuration: Config file {path}: {one_line(complaint)}")


def _plain_yaml(text: str) -> Any:
    """What Snakemake takes a configuration file for, as JSON and else as YAML, with every key once.

    Raises
    ------
    ValueError
        If it is neither, holds anything but text, numbers, lists and tables of these, or a key stands twice.
    """
    with contextlib.suppress(json.JSONDecodeError):
        return json.loads(text, object_pairs_hook=_each_once)
    return parse_yaml(text)


def _each_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        twice = next(key for key in table if sum(key == other for other, _ in pairs) > 1)
        raise ValueError(f"the key {twice!r} stands twice: allowed is each key once")
    return table


def _odd_file(config: object) -> Iterator[str]:
    if not isinstance(config, Mapping):
        yield "needed are keys and values at the top level"
    elif EVALUATED in config:
        yield f"{EVALUATED} asks Snakemake to evaluate Python in it: allowed are values as they stand"
    else:
        yield from too_many(config)
