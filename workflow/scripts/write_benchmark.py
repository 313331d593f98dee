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
NOT_IN_THE_MODEL = {"length"}
DATE = (2010, 1, 1, 0, 0, 0)  # in the archive, so that its bytes do not change
PACKAGE = {
    "profile": "tabular-data-package",
    "name": "precursors-benchmark",
    "title": "Proved transitions of eight stick-slip chains",
    "licenses": [{"name": "CC-BY-4.0", "path": "LICENSE-text"}],
}


def files_of(name: str, certificate: bytes) -> dict[str, str]:
    """Texts of the two files of a problem."""
    content = json.loads(gzip.decompress(certificate))
    rows = [",".join(map(str, row[: len(COLUMNS)])) for row in content["transitions"]]
    chain = {
        key: x for key, x in content["chain"].items() if key not in NOT_IN_THE_MODEL
    }
    problem = {"problem": name, "duration": content["duration_s"], **chain}
    return {
        f"{name}/problem.json": json.dumps(problem, indent=1) + "\n",
        f"{name}/transitions.csv": "\n".join([",".join(COLUMNS), *rows, ""]),
    }


def resource(path: str, content: bytes) -> dict[str, object]:
    """Entry of a file in the data package."""
    kind = path.rpartition(".")[2]
    about = {
        "name": path.replace("/", "-").removesuffix(f".{kind}").replace("_", "-"),
        "path": path,
        "format": kind,
        "encoding": "utf-8",
        "bytes": len(content),
        "hash": f"sha256:{hashlib.sha256(content).hexdigest()}",
    }
    if kind == "json":
        return about
    return about | {"profile": "tabular-data-resource", "schema": {"fields": FIELDS}}


with job() as snakemake:
    texts: dict[str, str] = {}
    for path in map(Path, snakemake.input.certificates):
        texts |= files_of(path.name.removesuffix(".json.gz"), path.read_bytes())
    files = {path: text.encode() for path, text in texts.items()}
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
            information = zipfile.ZipInfo(f"benchmark/{name}", DATE)
            file.writestr(information, content, zipfile.ZIP_DEFLATED)
            write_whole(Path(snakemake.output.folder) / name, content)
    write_whole(snakemake.output.archive, archive.getvalue())
