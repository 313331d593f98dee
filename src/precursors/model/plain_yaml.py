"""YAML that holds plain values, with each key once, and comes to an end; what is not so, in one line."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

# Levels of values inside values that no file of this project needs.
DEEPEST = 12
# Values of a configuration, each as often as YAML's aliases repeat it; the paper's has 500.
MOST_VALUES = 100_000
# Characters of a complaint.
LONGEST_LINE = 500


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


def too_many(table: Mapping[str, Any]) -> Iterator[str]:
    """Values inside values without end, and more than can be looked at: ten lines of YAML hold a billion."""
    for key, value in table.items():
        number = _count(value, {})
        if number == math.inf:
            yield f"{key} holds values inside values without end: allowed are {DEEPEST} levels"
        if number > MOST_VALUES:
            yield f"{key} holds {number} values, by aliases of aliases: allowed are {MOST_VALUES}"


def one_line(text: str) -> str:
    """A complaint whatever is in the names that it quotes: one line, without its middle if it is long."""
    line = "".join(c if c.isprintable() else " " for c in text)
    return (
        line if len(line) <= LONGEST_LINE else f"{line[: LONGEST_LINE // 2]} ... {line[-LONGEST_LINE // 2 :]}"
    )


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
