"""YAML that holds plain values, with each key once, and comes to an end."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

# Levels of values inside values that no file of this project needs.
DEEPEST = 12


def read_yaml(path: str | os.PathLike[str]) -> Any:
    """Read a file of YAML, see `parse_yaml`.

    Raises
    ------
    ValueError
        One line: which file, where in it, and what is wrong.
    OSError
        If the file cannot be read.
    """
    try:
        return parse_yaml(Path(path).read_text(encoding="utf-8"))
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: not valid YAML: {error}") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def parse_yaml(text: str) -> Any:
    """Values of a text in YAML: text, numbers, dates, and lists and tables of these.

    Of a key that stands twice, YAML takes the second one silently: it is refused here.

    Raises
    ------
    ValueError
        One line: where, and what is wrong.
    """
    import yaml

    # It constructs nothing but plain values; the compiled one, six times as fast, where there is one.
    safe: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        _not_too_deep(yaml.parse(text, safe))
        node = yaml.compose(text, safe)
        _keys_once(node)
        return safe("").construct_document(node) if node else None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f" in line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        raise ValueError(f"not valid YAML: {error.problem or error.context}{place}") from None
    except yaml.YAMLError as error:
        raise ValueError(f"not valid YAML: {' '.join(str(error).split())}") from None
    except (AttributeError, IndexError, KeyError, OverflowError, TypeError) as error:
        # PyYAML's own, at numbers, sets and dates that are none.
        raise ValueError(f"not valid YAML: a value that is none of its type ({error})") from None


def _not_too_deep(events: Iterable[Any]) -> None:
    """Refuse values inside values without end: the compiled loader takes the interpreter with it at them."""
    import yaml

    depth = 0
    for event in events:
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > DEEPEST:
            place = f"in line {event.start_mark.line + 1}"
            raise ValueError(f"values inside values without end, {place}: allowed are {DEEPEST} levels")


def _keys_once(root: Any) -> None:
    """Refuse a key that stands twice in a mapping, in all nodes that YAML's parser made."""
    import yaml

    left, seen = [root], set()
    while left:
        node = left.pop()
        if node is None or id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            left += node.value
        elif isinstance(node, yaml.MappingNode):
            keys = set()
            for key, value in node.value:
                left += [key, value]
                if isinstance(key, yaml.ScalarNode) and key.value in keys:
                    place = f"in line {key.start_mark.line + 1}, column {key.start_mark.column + 1}"
                    raise ValueError(f"the key {key.value!r} stands twice, {place}: allowed is each key once")
                keys.add(key.value if isinstance(key, yaml.ScalarNode) else id(key))
