"""`precursors verify`: refuse run files and certificates that are altered or do not hold."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from precursors.cli.arguments import load
from precursors.cli.exit_codes import ExitCode, Refused
from precursors.cli.output import print_json
from precursors.support.progress import Progress

NAME = "verify"
HELP = "refuse run files and certificates that are altered or do not hold"
DESCRIPTION = """\
Check run files and certificates. A run file must be whole, and its run a motion of the model: equation of
motion, Coulomb's law and energy are checked in every interval, by a method that shares nothing with the
solver. A certificate must be the one that was written, and consistent; with --recompute its proof is made
again. Every file has its line; the exit code is 1 if one is refused."""
EXAMPLES = """\
  precursors verify results/runs/fig10.h5 results/certificates/fig10.json.gz
  precursors verify --recompute results/certificates/fig10.json.gz
  precursors verify results/runs/*.h5 --json"""

GZIP = b"\x1f\x8b"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this command."""
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a run file or a certificate")
    parser.add_argument(
        "--recompute", action="store_true", help="make the proof of a certificate again, which takes as long"
    )


def run(arguments: argparse.Namespace) -> int:
    """Verify each file; go on after one that is refused or cannot be read."""
    verdicts = []
    code = ExitCode.DONE
    for path in arguments.files:
        try:
            kind, what = verify_file(path, arguments.recompute)
        except Refused as error:
            code = ExitCode.REFUSED
            verdicts.append({"file": str(path), "holds": False, "why": str(error)})
        except OSError as error:
            code = code or ExitCode.FILE
            verdicts.append({"file": str(path), "holds": None, "why": _reason(path, error)})
        else:
            verdicts.append({"file": str(path), "holds": True, "kind": kind, "what": what})
            if not arguments.json:
                print(f"{path}: holds: {what}")
            continue
        if not arguments.json:
            verdict = "refused" if verdicts[-1]["holds"] is False else "not read"
            why = " ".join(str(verdicts[-1]["why"]).removeprefix(f"{path}").strip(": ").split())
            print(f"precursors verify: {path}: {verdict}: {why}", file=sys.stderr)
    if arguments.json:
        print_json(verdicts)
    return code


def verify_file(path: Path, recompute: bool = False) -> tuple[str, str]:
    """Check one file; return its kind and what holds.

    Raises
    ------
    Refused
        If the file is altered, is neither a run nor a certificate, or does not hold.
    OSError
        If it cannot be read.
    """
    with path.open("rb") as file:
        is_certificate = file.read(len(GZIP)) == GZIP
    return _verify_certificate(path, recompute) if is_certificate else _verify_run(path)


def _verify_run(path: Path) -> tuple[str, str]:
    run = load(path)
    with Progress(f"auditing {path.name}"):
        from precursors.accuracy.audit import audit

        result = audit(run)
    if not result.ok:
        raise Refused(f"no motion of the model: {result.problems[0]}")
    return (
        "run",
        f"a motion of the model, {len(run.transitions)} transitions in {run.duration:g} s, "
        f"{result.n_intervals} intervals audited",
    )


def _verify_certificate(path: Path, recompute: bool) -> tuple[str, str]:
    from precursors.accuracy.proof import CertificateError, verify

    with Progress(f"{'proving' if recompute else 'reading'} {path.name}"):
        try:
            certificate = verify(path, recompute)
        except CertificateError as error:
            raise Refused(str(error)) from error
    widest = max((float(t.time.radius) for t in certificate.transitions), default=0.0)
    proved = "proved again" if recompute else "consistent"
    tie = ", up to a tie" if certificate.tie else ""
    return (
        "certificate",
        f"{proved}, {len(certificate.transitions)} transitions in {float(certificate.duration):g} s{tie}, "
        f"times within {widest:.1g} s",
    )


def _reason(path: Path, error: OSError) -> str:
    return error.strerror or str(error).removeprefix(f"{path}: ")
