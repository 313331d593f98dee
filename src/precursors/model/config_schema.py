"""A configuration against its schema: what is wrong and what is allowed, in words."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from precursors.model.plain_yaml import parse_yaml

Schema = Mapping[str, Any]

_KINDS = {
    "number": "a number",
    "integer": "a whole number",
    "string": "a text",
    "object": "a table of keys and values",
    "array": "a list",
}
_LIMITS = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}


def against_schema(config: Mapping[str, Any], schema_path: str | os.PathLike[str]) -> Iterator[str]:
    """What a schema, a JSON schema in YAML, refuses: which value, where, and what is allowed."""
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import relevance

    schema = _schema(Path(schema_path).read_text(encoding="utf-8"))
    errors = Draft202012Validator(schema).iter_errors(config)
    for error in sorted(errors, key=relevance, reverse=True):
        where = ""
        for part in error.absolute_path:
            where = f"{where}[{part}]" if isinstance(part, int) else joined(where, part)
        if error.validator == "required":
            missing = next(key for key in error.validator_value if key not in error.instance)
            what = _resolve(schema, error.schema["properties"].get(missing, {}))
            yield f"{joined(where, missing)} is missing: needed is {allowed(what)}"
        elif error.validator == "additionalProperties":
            known = error.schema["properties"]
            unknown = next(key for key in error.instance if key not in known)
            yield f"{joined(where, unknown)} is an unknown key: allowed are {', '.join(known)}"
        elif "propertyNames" in error.absolute_schema_path:
            yield f"{joined(where, error.instance)} has no name for it: allowed is {allowed(error.schema)}"
        else:
            hint = _yaml_hint(error.instance) if error.validator == "type" else ""
            shown_value = f"{where or 'top level'} = {shown(error.instance)}{hint}"
            yield f"{shown_value}: allowed is {allowed(error.schema)}"


@lru_cache(maxsize=1)
def _schema(text: str) -> Any:
    return parse_yaml(text)


def _resolve(schema: Schema, part: Schema) -> Schema:
    """The definition that a part of the schema refers to, or the part itself."""
    return schema["$defs"][part["$ref"].rpartition("/")[2]] if "$ref" in part else part


def allowed(schema: Schema) -> str:
    """What a part of the schema allows, with its range and its description (which names the unit)."""
    kinds = schema.get("type", [])
    texts = [_of_kind(schema, kind) for kind in ([kinds] if isinstance(kinds, str) else kinds)]
    if "enum" in schema:
        texts = [f"one of {', '.join(map(str, schema['enum']))}"]
    about = schema.get("description", "").rstrip(".")
    if not texts:
        return about
    return " or ".join(texts) + (f" ({about})" if about else "")


def _of_kind(schema: Schema, kind: str) -> str:
    """A kind of value with those limits of the schema that are about it."""
    text = _KINDS[kind]
    if kind in ("number", "integer"):
        return f"{text} {_range(schema)}".rstrip()
    if kind == "string":
        return text + _size("of", schema.get("minLength"), schema.get("maxLength"), "character", "characters")
    if kind == "object":
        least, most = schema.get("minProperties"), schema.get("maxProperties")
        return text + _size("with", least, most, "entry", "entries")
    different = "different " if schema.get("uniqueItems") else ""
    text += _size(
        "of", schema.get("minItems"), schema.get("maxItems"), f"{different}entry", f"{different}entries"
    )
    if "contains" in schema:
        text += f", at least {schema.get('minContains', 1)} of them {_range(schema['contains'])}"
    return text


def _range(schema: Schema) -> str:
    return " and ".join(f"{sign} {schema[key]}" for key, sign in _LIMITS.items() if key in schema)


def _size(begin: str, least: int | None, most: int | None, one: str, many: str) -> str:
    if least == most:
        sizes = [] if least is None else [str(least)]
    else:
        limits = (("at least", least), ("at most", most))
        sizes = [f"{words} {size}" for words, size in limits if size is not None]
    if not sizes:
        return f" {begin} {many}" if " " in many else ""  # they must differ, however many there are
    last = least if most is None else most
    return f" {begin} {' and '.join(sizes)} {one if last == 1 else many}"


def joined(where: str, key: object) -> str:
    """The place of a key in a table that has a place itself."""
    return f"{where}.{key}" if where else str(key)


def shown(value: object) -> str:
    """A value as a complaint quotes it."""
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
