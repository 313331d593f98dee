"""Hostile configurations: what is accepted runs, what is not is refused in one line, and nothing hangs."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import yaml
from numerics.chains import first_transitions
from numpy.random import Generator, default_rng

from faults.outcome import Outcome
from precursors.config import check_config, scene_chain, scene_duration, scene_names

ROOT = Path(__file__).parents[2]
SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
SEED = 1963
CONFIGURATIONS = 10_000
THROUGH_SNAKEMAKE = 8
# A configuration is judged, and the first transitions of its scenes are found, within so many seconds.
PATIENCE = 20
FIRST = 40

# The safe loader and dumper, compiled where there are such.
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
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
)
NAMES = json.loads((ROOT / "tests/faults/names.json").read_text(encoding="utf-8"))


@cache
def papers() -> Any:
    return yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))


def a_copy() -> Any:
    """A copy of the paper's configuration."""
    return json.loads(json.dumps(papers()))


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


def configuration(number: int) -> str:
    """The configuration with a number, as text: the paper's with up to three oddities in it."""
    rng = default_rng([SEED, number])
    if rng.random() < 0.05:
        return _noise(rng)
    config = a_copy()
    oddities: list[str] = []
    for _ in range(rng.integers(1, 4)):
        everywhere = list(places(config))
        # Scenes and the chain are what a user edits.
        near = [
            where
            for where in everywhere
            if where[0] in ("scenes", "chain", "duration", "fig13", "load_cells")
        ]
        where = (near if rng.random() < 0.8 else everywhere)[rng.integers(len(near))]
        _oddity(rng, config, where, oddities)
    text = yaml.dump(config, Dumper=DUMPER, allow_unicode=True, sort_keys=False)
    for i, oddity in enumerate(oddities):
        text = text.replace(f"{PLACEHOLDER}{i}.", oddity)
    return text


def _oddity(rng: Generator, config: Any, where: tuple[Any, ...], oddities: list[str]) -> None:
    def put(holder: Any, key: Any, text: str) -> None:
        oddities.append(text)
        holder[key] = f"{PLACEHOLDER}{len(oddities) - 1}."

    def odd(holder: Any, key: Any) -> None:
        put(holder, key, str(rng.choice(HUGE if rng.random() < 0.03 else ODDITIES)))

    def number(holder: Any, key: Any) -> None:
        holder[key] = float(10.0 ** rng.uniform(-12, 12)) * float(rng.choice([1, 1, 1, -1]))

    def whole(holder: Any, key: Any) -> None:
        holder[key] = int(10.0 ** rng.uniform(0, 9))

    def remove(holder: Any, key: Any) -> None:
        del holder[key]

    def scene(holder: Any, key: Any) -> None:
        name = str(rng.choice(NAMES)) * (100 if rng.random() < 0.02 else 1)
        config.setdefault("scenes", {})
        if isinstance(config["scenes"], dict):
            config["scenes"][name] = {"title": "odd", "theta": float(rng.uniform(-1, 1))}

    def unknown(holder: Any, key: Any) -> None:
        if isinstance(holder, dict):
            holder[str(rng.choice(NAMES))] = 1

    kinds = [odd, number, whole, remove, scene, unknown]
    changed(config, where, kinds[rng.choice(len(kinds), p=[0.45, 0.15, 0.1, 0.05, 0.2, 0.05])])


def _noise(rng: Generator) -> str:
    """Text of which the YAML parser is to make what it can."""
    if rng.random() < 0.5:
        return "".join(chr(c) for c in rng.integers(0, 0x300, rng.integers(0, 60)))
    text = (ROOT / "config.yaml").read_text(encoding="utf-8")
    cut = int(rng.integers(len(text)))
    return text[:cut] + "".join(map(str, rng.choice(ODDITIES, 3))) + text[cut + int(rng.integers(30)) :]


class Hang(Exception):
    """A configuration took longer than it may."""


def verdict(text: str) -> str:
    """Judge a configuration as the workflow does, and begin to run what is accepted."""

    def too_long(*_: object) -> None:
        raise Hang

    before = signal.signal(signal.SIGALRM, too_long)
    signal.alarm(PATIENCE)
    try:
        return _verdict(text)
    except Hang:
        return f"hangs: no end after {PATIENCE} s"
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:200]}"
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def _verdict(text: str) -> str:
    try:
        config = yaml.load(text, LOADER)
    except (yaml.YAMLError, ValueError, RecursionError):
        return "refused"  # by the parser, as Snakemake reports it
    if not isinstance(config, Mapping):
        return "refused"  # by Snakemake: a configuration has keys
    try:
        check_config(config, SCHEMA)
    except ValueError as error:
        line = str(error)
        return "refused" if len(line.splitlines()) == 1 and len(line) < 600 else f"refused in {line[:300]!r}"
    for name in scene_names(config):
        if (
            Path(name).name != name
            or not name.isascii()
            or not name.replace("-", "").replace("_", "").isalnum()
        ):
            return f"the scene {name!r} was accepted"
        first_transitions(scene_chain(config, name), FIRST, duration=scene_duration(config, name))
    return "survived"


def through_snakemake(number: int) -> str:
    """Give a configuration with a bad name to Snakemake itself: it refuses, and touches nothing."""
    name = NAMES[number]
    with tempfile.TemporaryDirectory() as directory:
        config = a_copy()
        config["scenes"][name] = {"title": "odd", "theta": 0.1}
        path = Path(directory) / "configuration.yaml"
        path.write_text(yaml.safe_dump(config, allow_unicode=True), encoding="utf-8")
        command = [sys.executable, "-m", "snakemake", "-c1", "-n", "--snakefile", str(ROOT / "Snakefile")]
        run = subprocess.run(
            [*command, "--directory", directory, "--configfile", str(path)],
            capture_output=True,
            text=True,
        )
        left = sorted(p.name for p in Path(directory).iterdir() if p.name != ".snakemake")
    if run.returncode == 0 or "Traceback" in run.stderr:
        return f"scene {name!r}: Snakemake ended with {run.returncode}: {run.stderr[-300:]!r}"
    return "refused" if left == ["configuration.yaml"] else f"scene {name!r}: wrote {left}"


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Judge a share of the configurations, and give a few bad names to Snakemake."""
    judged = Outcome("configuration: oddities")
    for number in range(round(CONFIGURATIONS * share)):
        answer = verdict(configuration(number))
        good = answer in ("survived", "refused")
        judged.count(answer if good else f"configuration({number}): {answer}")
    named = Outcome("configuration: names")
    for number in range(max(2, round(THROUGH_SNAKEMAKE * share))):
        named.count(through_snakemake(number))
    return [judged, named]
