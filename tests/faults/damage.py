"""Damaged files: cut short, a bit turned, another kind, another version. What is read is right or refused."""

from __future__ import annotations

import contextlib
import gzip
import io
import re
import shutil
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, replace
from functools import cache, partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import print_reproduction
import write_provenance
import yaml

import precursors.reproduction.ledger.judge as judge
from faults.outcome import Outcome
from precursors import Chain, Run, simulate
from precursors.accuracy.proof.certificate import Certificate
from precursors.analysis.slip_table import slip_table
from precursors.ensembles.catalogue import make_study
from precursors.ensembles.chunks import FORMAT as CHUNK
from precursors.ensembles.chunks import load_chunk, save_chunk
from precursors.ensembles.study import Study, run_members
from precursors.figures.style import read_columns
from precursors.figures.table_page import write_table_page
from precursors.reproduction.paper import Number, Source, collect_numbers, write_numbers
from precursors.reproduction.paper.pages import take_along
from precursors.solver.run import FORMAT as RUN
from precursors.support.files import CHECKSUMS, read_json
from precursors.support.tables import read_table, write_table

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
    """A kind of file, and one way to read it: how it is made, read, and what two readings are compared by.

    `places` are where such files lie in results/; every other file there is read by nothing.
    """

    name: str
    write: Callable[[Path], None]
    read: Callable[[Path], Any]
    other_version: tuple[bytes, bytes]
    places: tuple[str, ...] = ()


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
    return _chunk(path, _study())


def _read_chunk_of(name: str, path: Path) -> Any:
    return _chunk(path, _study_now(name))


@cache
def _study_now(name: str) -> Study:
    return make_study(yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8")), name)


def _chunk(path: Path, study: Study) -> Any:
    first, columns = load_chunk(path, study)
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


def _read_for_the_paper(path: Path) -> Any:
    source = Source("load", table=path.stem, column="load_before_N", take="largest")
    return collect_numbers([source], path.parent, {})


def _read_for_typst(path: Path) -> Any:
    with tempfile.TemporaryDirectory() as root:
        take_along({f"results/{path.name}": path}, root)
        return (Path(root) / "results" / path.name).read_bytes()


def _read_for_a_page(path: Path) -> Any:
    page = path.parent / "page.html"
    write_table_page(path, page)
    return page.read_bytes()


def _write_reproduction(path: Path) -> None:
    names = ["scene", "theta", "quantity", "unit", "paper", "reproduced"]
    write_table(pd.DataFrame([["fig10", 0.0, "events kept", "1", 9, 9.0]], columns=names), path)


def _read_aloud(path: Path) -> Any:
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        print_reproduction.main(path, path.parent)
    return printed.getvalue()


def _read_for_the_ledger(path: Path) -> Any:
    return judge._read(path).to_csv()


def _write_some_numbers(path: Path) -> None:
    write_numbers({"load": Number(194.31, "N", "results/tables/fig10_slips.csv, load_before_N")}, path)


def _write_origin(path: Path) -> None:
    (path.parent / "root").mkdir(exist_ok=True)
    config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    write_provenance.main(config, str(ROOT / "workflow"), path)


KINDS = (
    Kind("run.h5", _write_run, _read_run, (RUN.encode(), b"precursors run 0"), ("runs/*.h5",)),
    Kind("chunk.h5", _write_chunk, _read_chunk, (CHUNK.encode(), b"a chunk 0"), ("ensembles/*/*.h5",)),
    Kind("table.csv", _write_table, _read_table, (b"onset_s", b"onset_m"), ("tables/**/*.csv",)),
    Kind("slips.csv", _write_table, _read_figure_table, (b"front", b"frond")),
    Kind("numbers.csv", _write_table, _read_for_the_paper, (b"load_before_N", b"load_before_lb")),
    Kind("shown.csv", _write_table, _read_for_typst, (b"front", b"frond")),
    Kind("page.csv", _write_table, _read_for_a_page, (b"front", b"frond")),
    Kind("reproduction.csv", _write_reproduction, _read_aloud, (b"reproduced", b"recomputed")),
    Kind("evidence.csv", _write_table, _read_for_the_ledger, (b"front", b"frond")),
    Kind("proof.json.gz", _write_certificate, _read_certificate, (b"", b""), ("certificates/**/*.json.gz",)),
    Kind("numbers.json", _write_some_numbers, _read_for_typst, (b"value", b"worth"), ("numbers.json",)),
    Kind("origin.json", _write_origin, read_json, (b"outputs", b"put"), ("provenance.json", "tables/*.json")),
)
# Written for others, and not read here.
NOT_READ = ("ro-crate-metadata.json",)


def kind_of(place: str) -> Kind | None:
    """The kind of a file of results/ by where it lies, or None for one that no kind is known for."""
    return next((kind for kind in KINDS if any(_lies(place, pattern) for pattern in kind.places)), None)


def _lies(place: str, pattern: str) -> bool:
    parts = [re.escape(part).replace(r"\*\*", "@").replace(r"\*", "[^/]+") for part in pattern.split("/")]
    return re.fullmatch("/".join(parts).replace("@/", "(.+/)?"), place) is not None


def data_files(results: Path) -> list[str]:
    """Every HDF5, CSV and JSON file that lies in a directory of results now, and is read by something."""
    endings = (".h5", ".hdf5", ".csv", ".json", ".gz")
    found = (path.relative_to(results).as_posix() for path in sorted(results.rglob("*")) if path.is_file())
    return [
        place
        for place in found
        if place.endswith(endings) and place not in NOT_READ and not re.search(r"(^|/)\.", place)
    ]


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
    elif old in content:
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
        _damage(kind, path, share, outcome)
    return outcome


def try_result(place: str, share: float, results: Path = ROOT / "results") -> Outcome:
    """Damage a copy of a file of results/ in every way, if its kind is known."""
    outcome = Outcome("damaged files of results/")
    kind = kind_of(place)
    if kind is None:
        outcome.count(f"{place}: nobody knows how it is read: add its kind")
        return outcome
    if kind.name == "chunk.h5":
        kind = replace(kind, read=partial(_read_chunk_of, Path(place).parent.name))
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / Path(place).name
        shutil.copyfile(results / place, path)
        beside = (results / place).parent / CHECKSUMS / f"{path.name}.sha256"
        if beside.is_file():
            (path.parent / CHECKSUMS).mkdir()
            shutil.copyfile(beside, path.parent / CHECKSUMS / beside.name)
        elif path.suffix in (".csv", ".json"):
            outcome.count(f"{place}: no checksum lies beside it: have it made anew")
            return outcome
        _damage(kind, path, share, outcome)
    return outcome


def _damage(kind: Kind, path: Path, share: float, outcome: Outcome) -> None:
    try:
        content, right = path.read_bytes(), kind.read(path)
    except (ValueError, OSError):
        outcome.count(reading(kind, path, None))  # left from another version
        return
    for what, damage in damaged(content, kind, share):
        path.write_bytes(damage)
        answer = reading(kind, path, right)
        outcome.count(answer if answer in ("survived", "refused") else f"{path.name} {what}: {answer}")
    path.unlink()
    for what in ("absent", "a directory"):
        answer = reading(kind, path, right)
        outcome.count(answer if answer == "refused" else f"{path.name} {what}: {answer}")
        path.mkdir(exist_ok=True)


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Damage every kind of file that is read, and every file of results/; one that crashes Python is lost."""
    outcomes = {name: Outcome(name) for name in [f"damaged {kind.name}" for kind in KINDS]}
    last = outcomes["damaged files of results/"] = Outcome("damaged files of results/")
    places = data_files(ROOT / "results")
    last.note = f"{len(places)} files" if places else "there are none: make all"
    with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
        jobs = [(kind.name, pool.submit(try_kind, kind.name, share)) for kind in KINDS]
        jobs += [(place, pool.submit(try_result, place, share)) for place in places]
        for what, future in jobs:
            try:
                outcome = future.result()
            except BrokenProcessPool:
                outcome = Outcome(last.fault, 1, lost=[f"{what}: the interpreter crashed"])
            outcomes[outcome.fault] += outcome
    return list(outcomes.values())
