"""Damaged files: cut short, a bit turned, another kind, another version. What is read is right or refused."""

from __future__ import annotations

import gzip
import re
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from tables import read_table, write_table

from faults.outcome import Outcome
from precursors import Chain, Run, simulate
from precursors.ensembles.catalogue import make_study
from precursors.ensembles.chunks import FORMAT as CHUNK
from precursors.ensembles.chunks import load_chunk, save_chunk
from precursors.ensembles.study import Study, run_members
from precursors.figures.style import read_columns
from precursors.proof.certificate import Certificate
from precursors.run import FORMAT as RUN
from precursors.tables import slip_table

ROOT = Path(__file__).parents[2]
SEED = 1962
CUTS, FLIPS = 50, 500
OTHERS = {
    "an empty file": b"",
    "zeros": bytes(4096),
    "a picture": b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 4,
    "a pickle": b"\x80\x04\x95\x10\x00\x00\x00\x00\x00\x00\x00\x8c\x02os\x94\x8c\x06system\x94\x93\x94.",
    "an HDF5 file of something else": b"\x89HDF\r\n\x1a\n" + bytes(2000),
    "text": "Früher war es länger.\n".encode() * 50,
    "deeply nested JSON": b"[" * 100_000,
    "a table of something else": b"a,b\n1,2\n",
    "half a gzip file": b"\x1f\x8b\x08\x00" + bytes(50),
}


@dataclass(frozen=True)
class Kind:
    """A kind of file: how it is made, read, and turned into what two readings are compared by."""

    name: str
    write: Callable[[Path], None]
    read: Callable[[Path], Any]
    other_version: tuple[bytes, bytes]


def _write_run(path: Path) -> None:
    simulate(Chain.from_slider(), duration=0.6).save(path)


def _read_run(path: Path) -> Any:
    run = Run.load(path)
    return repr([vars(run.chain), run.duration, run.transitions.tolist(), run.at([0.0, run.duration])])


@cache
def _study() -> Study:
    config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    config["maps"]["points"] = 20
    return make_study(config, "map_blocks")


def _write_chunk(path: Path) -> None:
    save_chunk(path, _study(), 2, run_members(_study(), 2, 6))


def _read_chunk(path: Path) -> Any:
    first, columns = load_chunk(path, _study())
    return repr([first, {name: values.tolist() for name, values in columns.items()}])


def _write_table(path: Path) -> None:
    write_table(slip_table(simulate(Chain.from_slider(), until="global slip")), path)


def _read_table(path: Path) -> Any:
    return read_table(path).to_csv()


def _read_figure_table(path: Path) -> Any:
    return read_columns(path, {"onset_s": float, "front": int}).to_csv()


def _write_certificate(path: Path) -> None:
    Certificate.load(ROOT / "workflow/certificates/leading.json.gz").save(path)


def _read_certificate(path: Path) -> Any:
    return hash(Certificate.load(path))


KINDS = (
    Kind("run.h5", _write_run, _read_run, (RUN.encode(), b"precursors run 0")),
    Kind("chunk.h5", _write_chunk, _read_chunk, (CHUNK.encode(), b"precursors chunk 0")),
    Kind("table.csv", _write_table, _read_table, (b"onset_s", b"onset_m")),
    Kind("slips.csv", _write_table, _read_figure_table, (b"front", b"frond")),
    Kind("certificate.json.gz", _write_certificate, _read_certificate, (b"", b"")),
)


def damaged(content: bytes, kind: Kind, share: float) -> Iterator[tuple[str, bytes]]:
    """What was done to a file, and what it then holds."""
    rng = np.random.default_rng(SEED)
    for length in np.linspace(0, len(content) - 1, max(3, round(CUTS * share))).astype(int):
        yield f"cut to {length} of {len(content)} bytes", content[:length]
    for place in rng.integers(0, 8 * len(content), max(10, round(FLIPS * share))):
        changed = bytearray(content)
        changed[place // 8] ^= 1 << (place % 8)
        yield f"bit {place % 8} of byte {place // 8} turned", bytes(changed)
    for name, other in OTHERS.items():
        yield f"replaced by {name}", other
    old, new = kind.other_version
    if kind.name.endswith(".gz"):
        text = gzip.decompress(content)
        yield "of another version", gzip.compress(re.sub(rb'("format": "[^"]*)"', rb'\1 9"', text))
    else:
        yield "of another version", content.replace(old, new, 1)


def reading(kind: Kind, path: Path, right: Any) -> str:
    """Read a damaged file: "refused" in a line that names it, "survived" if all is right, or the fault."""
    try:
        found = kind.read(path)
    except (ValueError, OSError) as error:
        text = str(error)
        return "refused" if path.name in text and "\n" not in text else f"refused with {text!r}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return "survived" if found == right else "a wrong content was read"


def try_kind(name: str, share: float) -> Outcome:
    """Damage one kind of file in every way, and put a directory in its place."""
    [kind] = [kind for kind in KINDS if kind.name == name]
    outcome = Outcome(f"damaged {kind.name}")
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / kind.name
        kind.write(path)
        content, right = path.read_bytes(), kind.read(path)
        for what, damage in damaged(content, kind, share):
            path.write_bytes(damage)
            answer = reading(kind, path, right)
            outcome.count(answer if answer in ("survived", "refused") else f"{kind.name} {what}: {answer}")
        path.unlink()
        for what in ("absent", "a directory"):
            answer = reading(kind, path, right)
            outcome.count(answer if answer == "refused" else f"{kind.name} {what}: {answer}")
            path.mkdir(exist_ok=True)
    return outcome


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Damage every kind of file that is read; a file that takes the interpreter with it is lost."""
    outcomes = []
    with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
        for kind, future in [(kind, pool.submit(try_kind, kind.name, share)) for kind in KINDS]:
            try:
                outcomes.append(future.result())
            except BrokenProcessPool:
                outcomes.append(
                    Outcome(f"damaged {kind.name}", 1, lost=[f"{kind.name}: the interpreter crashed"])
                )
    return outcomes
