"""Write the reference problems as plain files, and put them into one archive."""

import gzip
import hashlib
import json
import re
import zipfile
from io import BytesIO
from pathlib import Path

from job import job

# isort: split
from precursors.support.files import write_whole

COLUMNS = {
    "time_s": ("s", "midpoint of the proved interval of the time"),
    "time_radius_s": ("s", "the time is no farther than this from its midpoint"),
    "block": ("1", "block, counted from 1 at the pushed end"),
    "mode": ("1", "after the transition: 1 forward, 0 sticks, -1 backward"),
    "tangential_load_N": ("N", "midpoint of the proved interval of the load"),
    "tangential_load_radius_N": ("N", "as time_radius_s, of the load"),
}
FIELDS = [
    {"name": name, "type": "integer" if unit == "1" else "number", "unit": unit}
    | {"description": text, "constraints": {"required": True}}
    for name, (unit, text) in COLUMNS.items()
]
DATE = (2010, 1, 1, 0, 0, 0)  # in the archive, so that its bytes do not change
PACKAGE = {
    "profile": "tabular-data-package",
    "name": "precursors-benchmark",
    "title": "Proved transitions of eight stick-slip chains",
    "licenses": [{"name": "CC-BY-4.0", "path": "LICENSE-text"}],
}


def files_of(name: str, certificate: bytes) -> dict[str, bytes]:
    """The two files of a problem."""
    proof = json.loads(gzip.decompress(certificate))
    chain = {key: x for key, x in proof["chain"].items() if key != "length"}
    problem = {"problem": name, "duration": proof["duration_s"], **chain}
    rows = [COLUMNS, *(row[: len(COLUMNS)] for row in proof["transitions"])]
    table = "".join(f"{','.join(map(str, row))}\n" for row in rows)
    return {
        f"{name}/problem.json": f"{json.dumps(problem, indent=1)}\n".encode(),
        f"{name}/transitions.csv": table.encode(),
    }


def resource(path: str, content: bytes) -> dict[str, object]:
    """Entry of a file in the data package."""
    name, _, kind = path.rpartition(".")
    about = {
        "name": re.sub("[/_]", "-", name),
        "path": path,
        "hash": f"sha256:{hashlib.sha256(content).hexdigest()}",
    }
    return about | ({"schema": {"fields": FIELDS}} if kind == "csv" else {})


with job() as snakemake:
    files: dict[str, bytes] = {}
    for path in map(Path, snakemake.input.certificates):
        files |= files_of(path.name.removesuffix(".json.gz"), path.read_bytes())
    resources = [resource(path, content) for path, content in files.items()]
    package = json.dumps(PACKAGE | {"resources": resources}, indent=1)
    files["datapackage.json"] = f"{package}\n".encode()
    page = Path(snakemake.input.page).read_text(encoding="utf-8")
    # In the archive there is nothing that it could link to.
    files["README.md"] = re.sub(r"\[(.+?)\]\(\.\./.+?\)", r"\1", page).encode()
    files["LICENSE-text"] = Path(snakemake.input.licence).read_bytes()
    archive = BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in files.items():
            entry = zipfile.ZipInfo(f"benchmark/{name}", DATE)
            file.writestr(entry, content, zipfile.ZIP_DEFLATED)
            write_whole(Path(snakemake.output.folder) / name, content)
    write_whole(snakemake.output.archive, archive.getvalue())
