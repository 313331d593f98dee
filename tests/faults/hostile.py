"""Configurations as files: the paper's with oddities of YAML in it, what hypothesis draws, and noise."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

import yaml
from hypothesis import strategies as st
from numpy.random import Generator, default_rng

ROOT = Path(__file__).parents[2]
SEED = 1963

# The safe dumper, compiled where it is.
DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

# As they stand in a YAML file: what a user mistypes, and what someone else would put there.
# One a line, as what is hostile to a parser is no neater in a list.
ODDITIES = (ROOT / "tests/faults/oddities.txt").read_text(encoding="utf-8").splitlines()
HUGE = (
    "9" * 5000,
    "[" * 3000,
    "{a: " * 3000,
    "x" * 100_000,
    "-" * 1000 + "1",
    "1" + "0" * 400,
    "1." + "0" * 5000,
    "[" * 100_000,
    "- " * 100_000,
    "&a " + "[" * 11 + "]" * 11,
)
NAMES = json.loads((ROOT / "tests/faults/names.json").read_text(encoding="utf-8"))


@cache
def papers() -> Any:
    return yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))


def a_copy() -> Any:
    """A copy of the paper's configuration."""
    return json.loads(json.dumps(papers()))


def short() -> Any:
    """A copy with the last two values in each list of more than three: a tenth of the time to read."""
    return _shortened(papers())


def _shortened(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _shortened(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_shortened(inner) for inner in value[-2 if len(value) > 3 else 0 :]]
    return value


def places(value: Any, where: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place in a configuration."""
    if where:
        yield where
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, (*where, key))


def changed(config: Any, where: tuple[Any, ...], change: Callable[[Any, Any], None]) -> None:
    """Apply a change to what holds a place, given its last key."""
    for key in where[:-1]:
        config = config[key]
    change(config, where[-1])


PLACEHOLDER = "PLACEHOLDER"


def configuration(number: int) -> bytes:
    """The configuration with a number, as a file: the paper's with up to three oddities, or four."""
    rng = default_rng([SEED, number])
    if rng.random() < 0.05:
        return _noise(rng)
    config = short()
    oddities: list[str] = []
    for _ in range(rng.choice([1, 2, 3], p=[0.6, 0.25, 0.15])):
        everywhere = list(places(config))
        # Scenes and the chain are what a user edits.
        near = [
            where
            for where in everywhere
            if where[0] in ("scenes", "chain", "duration", "fig13", "load_cells")
        ]
        where = (near if rng.random() < 0.8 else everywhere)[rng.integers(len(near))]
        _oddity(rng, config, where, oddities)
    flow = bool(rng.random() < 0.05)
    text = yaml.dump(config, Dumper=DUMPER, allow_unicode=True, sort_keys=False, default_flow_style=flow)
    for i, oddity in enumerate(oddities):
        text = text.replace(f"{PLACEHOLDER}{i}.", oddity)
    if rng.random() < 0.2:
        return WRITTEN[rng.choice(list(WRITTEN))](text, rng)
    return text.encode("utf-8", "surrogatepass")


def laughs(leaf: str, nest: str) -> str:
    """Ten lines that hold a billion values: each line holds the one before ten times."""
    lines = [f"laugh0: &laugh0 {leaf}"]
    lines += [f"laugh{i}: &laugh{i} {nest.replace('*', f'*laugh{i - 1}')}" for i in range(1, 10)]
    return "\n".join(lines) + "\n"


def _a_line(text: str, rng: Generator) -> int:
    return int(rng.integers(len(text.splitlines()) or 1))


def _with_line(text: str, place: int, change: Callable[[str], str]) -> str:
    lines = text.splitlines(keepends=True) or [""]
    lines[place] = change(lines[place])
    return "".join(lines)


# Oddities of a whole file: how it is written, and what YAML and Snakemake have for files.
WRITTEN: dict[str, Callable[[str, Generator], bytes]] = {
    "a byte order mark": lambda text, rng: b"\xef\xbb\xbf" + text.encode(),
    "UTF-16": lambda text, rng: text.encode("utf-16"),
    "Latin letters": lambda text, rng: text.replace("uniform", "über").encode("latin-1", "replace"),
    "line ends of elsewhere": lambda text, rng: text.replace("\n", str(rng.choice(["\r", "\r\n"]))).encode(),
    "tabs": lambda text, rng: text.replace("  ", "\t").encode(),
    "a tab": lambda text, rng: _with_line(text, _a_line(text, rng), lambda line: "\t" + line).encode(),
    "NUL": lambda text, rng: _with_line(text, _a_line(text, rng), lambda line: line[:-1] + "\0\n").encode(),
    "a line twice": lambda text, rng: _with_line(text, _a_line(text, rng), lambda line: line * 2).encode(),
    "a line less": lambda text, rng: _with_line(text, _a_line(text, rng), lambda line: "").encode(),
    "a line farther in": lambda text, rng: _with_line(
        text, _a_line(text, rng), lambda line: " " + line
    ).encode(),
    "two documents": lambda text, rng: f"{text}---\n{text}".encode(),
    "an end": lambda text, rng: f"---\n{text}...\n".encode(),
    "a directive": lambda text, rng: f"%YAML 1.{rng.integers(1, 4)}\n---\n{text}".encode(),
    "a billion lists": lambda text, rng: (laughs("[1]", f"[{', '.join(9 * '*')}]") + text).encode(),
    "a billion tables": lambda text, rng: (
        laughs("{a: 1}", "{" + ", ".join(f"{key}: *" for key in "abcdefghi") + "}") + text
    ).encode(),
    "a billion theta": lambda text, rng: (
        re.sub("theta:.*", "theta: *laugh9", laughs("[1]", f"[{', '.join(9 * '*')}]") + text, count=1)
    ).encode(),
    "anchors that are merged": lambda text, rng: (
        text.replace("chain:", "chain: &chain", 1)
        .replace("    title:", "    <<: *chain\n    title:")
        .encode()
    ),
    "Python": lambda text, rng: f"__use_yte__: true\n{text}odd: ?__import__('os').getcwd()\n".encode(),
    "JSON": lambda text, rng: _as_json(text, indent=int(rng.integers(3))),
    "JSON with tabs": lambda text, rng: _as_json(text, indent="\t"),
    "a long comment": lambda text, rng: f"# {'x' * 1_000_000}\n{text}".encode(),
    "no end of spaces": lambda text, rng: (text + 1_000_000 * " ").encode(),
}


def _as_json(text: str, **how: Any) -> bytes:
    try:
        return json.dumps(yaml.safe_load(text), default=str, **how).encode()
    except (yaml.YAMLError, ValueError, TypeError, RecursionError):
        return text.encode("utf-8", "surrogatepass")


def _oddity(rng: Generator, config: Any, where: tuple[Any, ...], oddities: list[str]) -> None:
    def odd(holder: Any, key: Any) -> None:
        oddities.append(str(rng.choice(HUGE if rng.random() < 0.03 else ODDITIES)))
        holder[key] = f"{PLACEHOLDER}{len(oddities) - 1}."

    def number(holder: Any, key: Any) -> None:
        holder[key] = float(10.0 ** rng.uniform(-12, 12)) * float(rng.choice([1, 1, 1, -1]))

    def near(holder: Any, key: Any) -> None:
        if type(holder[key]) is float:
            holder[key] *= float(10.0 ** rng.uniform(-1, 1))
        elif type(holder[key]) is int:
            holder[key] = int(rng.integers(1, 30))

    def whole(holder: Any, key: Any) -> None:
        holder[key] = int(10.0 ** rng.uniform(0, 9))

    def remove(holder: Any, key: Any) -> None:
        del holder[key]

    def scene(holder: Any, key: Any) -> None:
        name = str(rng.choice(NAMES)) * (100 if rng.random() < 0.02 else 1)
        name = f"odd{rng.integers(99)}" if rng.random() < 0.5 else name
        config.setdefault("scenes", {})
        if isinstance(config["scenes"], dict):
            config["scenes"][name] = {"title": "odd", "theta": float(rng.uniform(-1, 1))}

    def unknown(holder: Any, key: Any) -> None:
        if isinstance(holder, dict):
            holder[str(rng.choice(NAMES))] = 1

    kinds = [odd, number, near, whole, remove, scene, unknown]
    changed(config, where, kinds[rng.choice(len(kinds), p=[0.35, 0.1, 0.2, 0.1, 0.05, 0.15, 0.05])])


def _noise(rng: Generator) -> bytes:
    """Bytes of which the YAML parser is to make what it can."""
    if rng.random() < 0.2:
        return bytes(rng.integers(0, 256, rng.integers(0, 60)).tolist())
    if rng.random() < 0.5:
        return "".join(chr(c) for c in rng.integers(0, 0x300, rng.integers(0, 60))).encode()
    text = (ROOT / "config.yaml").read_text(encoding="utf-8")
    cut = int(rng.integers(len(text)))
    return (
        text[:cut] + "".join(map(str, rng.choice(ODDITIES, 3))) + text[cut + int(rng.integers(30)) :]
    ).encode()


# Any value that YAML and JSON have, and numbers of a size that a slider could have.
SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(1, 30),
    st.floats(),
    st.floats(1e-9, 1e9),
    st.fractions(-1, 1, max_denominator=30).map(str),
    st.text(max_size=80),
    st.dates(),
    st.datetimes(),
    st.binary(max_size=20),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=9), inner, max_size=4),
    max_leaves=12,
)
PLACES = list(places(short()))


def put(value: Any, holder: Any, key: Any) -> None:
    """Replace what stands at a place."""
    holder[key] = value


@st.composite
def drawn(draw: Callable[[Any], Any]) -> bytes:
    """The paper's configuration with up to four values replaced, or a scene more with any values."""
    config = short()
    for where in draw(st.lists(st.sampled_from(PLACES), max_size=4)):
        value = draw(st.floats(1e-9, 1e9) | st.integers(1, 30) | VALUES)
        try:
            changed(config, where, partial(put, value))
        except (KeyError, IndexError, TypeError):
            continue  # within what another value replaced
    if draw(st.booleans()) and isinstance(config.get("scenes"), dict):
        numbers = st.floats(1e-3, 1e3) | SCALARS
        keys = list(config["chain"]) if isinstance(config.get("chain"), dict) else ["mu_s"]
        own = draw(st.dictionaries(st.sampled_from(keys), numbers, max_size=2))
        name = draw(st.from_regex("[A-Za-z][A-Za-z0-9_-]{0,9}", fullmatch=True) | st.text(max_size=70))
        config["scenes"][name] = {"title": draw(st.text(max_size=130)), "theta": draw(numbers), **own}
    return yaml.dump(config, Dumper=DUMPER, allow_unicode=draw(st.booleans()), sort_keys=False).encode(
        "utf-8", "surrogatepass"
    )


def of_another_size(number: int) -> Any:
    """The paper's configuration with one scene, whose parameters lie up to four decades off."""
    rng = default_rng([SEED, 2, number])
    config = a_copy()
    names = [name for name in config["chain"] if name not in ("n_blocks", "mu_s", "mu_k")]
    scene: dict[str, Any] = {"title": "odd", "theta": float(rng.uniform(-1, 1))}
    for name in rng.choice(names, rng.integers(0, 4), replace=False).tolist():
        scene[name] = config["chain"][name] * float(10.0 ** rng.uniform(-4, 4))
    if rng.random() < 0.7:
        scene["n_blocks"] = int(10.0 ** rng.uniform(0, 2.2))
    if rng.random() < 0.4:
        scene["mu_k"] = float(config["chain"]["mu_s"] * (1 - 10.0 ** rng.uniform(-4, 0)))
    if rng.random() < 0.5:
        scene["duration"] = float(10.0 ** rng.uniform(-2, 3))
    models = {
        "viscous": ("viscosity", -1, 4),
        "interface": ("interface_stiffness", 5, 10),
        "head": ("head_mass", -3, 2),
    }
    if rng.random() < 0.3:
        model = str(rng.choice(list(models)))
        addition, least, most = models[model]
        scene |= {"model": model, addition: float(10.0 ** rng.uniform(least, most))}
    return config | {"scenes": {"odd": scene}}
