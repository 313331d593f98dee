"""The results as an RO-Crate: metadata that say what each file is and what made it, for archives to read."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from precursors.support.files import write_atomically
from precursors.support.provenance import checksums

METADATA = "ro-crate-metadata.json"
PROVENANCE = "provenance.json"
VERSION = "1.1"  # of RO-Crate: the one that every reader knows
PAPER = "https://doi.org/10.1007/s11249-010-9611-7"
LICENSE = "https://spdx.org/licenses/MIT"
FORMATS = {
    ".csv": "text/csv",
    ".gz": "application/gzip",
    ".h5": "application/x-hdf5",
    ".html": "text/html",
    ".json": "application/json",
    ".pdf": "application/pdf",
    ".png": "image/png",
    ".svg": "image/svg+xml",
}
TOOLS = {
    "precursors": "stick-slip chains solved exactly",
    "snakemake": "runs the workflow",
    "numba": "compiles the kernel",
}


def write_crate(provenance: Mapping[str, Any], directory: str | os.PathLike[str]) -> Path:
    """Make the directory of the results an RO-Crate by writing its metadata into it; no file is copied.

    Parameters
    ----------
    provenance : mapping
        As `precursors.support.provenance.provenance` gives it: its outputs are the crate's files.
    directory : path
        The directory of the results, with provenance.json in it.

    Returns
    -------
    Path
        The metadata file.
    """
    from rocrate.model import ContextEntity, File
    from rocrate.rocrate import ROCrate

    crate = ROCrate(version=VERSION)
    crate.name = "Precursors of global slip: the simulation of Maegawa, Suzuki and Nakano (2010) reproduced"
    crate.description = (
        "Runs, tables and figures, each with its checksum; provenance.json says what computed them."
    )
    crate.datePublished = provenance["written"]
    crate.license = crate.add(ContextEntity(crate, LICENSE, {"@type": "CreativeWork", "name": "MIT License"}))
    crate.root_dataset["citation"] = crate.add(
        ContextEntity(crate, PAPER, {"@type": "ScholarlyArticle", "name": "the paper that is reproduced"})
    )
    files = []
    results = Path(directory)
    listed = provenance["outputs"] | checksums([results / PROVENANCE], results)
    for name, facts in listed.items():
        path = PurePosixPath(name)
        about = {
            "name": path.name,
            "contentSize": str(facts["bytes"]),
            "encodingFormat": FORMATS.get(path.suffix, "application/octet-stream"),
            "sha256": facts["sha256"],
        }
        files.append(crate.add(File(crate, results / name, name, properties=about)))
    versions = {**provenance["packages"], "precursors": provenance["software"]["precursors"]}
    tools = [
        crate.add(
            ContextEntity(
                crate,
                f"#{name}",
                {
                    "@type": "SoftwareApplication",
                    "name": name,
                    "description": purpose,
                    "softwareVersion": versions[name],
                },
            )
        )
        for name, purpose in TOOLS.items()
        if name in versions
    ]
    crate.add_action(
        tools,
        identifier="#run",
        result=files,
        properties={"name": "the workflow's run", "endTime": provenance["written"]},
    )
    target = results / METADATA
    with write_atomically(target) as temporary:
        temporary.write_text(json.dumps(crate.metadata.generate(), indent=1) + "\n", encoding="utf-8")
    return target
