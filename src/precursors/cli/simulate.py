"""`precursors simulate`: run a chain, or many that differ by noise, and say what came out."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from precursors.cli.arguments import (
    add_chain,
    add_duration,
    duration_of,
    number,
    simulate_of,
    slider_of,
    until_of,
    whole,
)
from precursors.cli.exit_codes import ExitCode, Refused
from precursors.cli.output import print_json, print_table, print_values, records
from precursors.support.progress import Progress

if TYPE_CHECKING:
    import pandas as pd

NAME = "simulate"
HELP = "run a chain, or an ensemble of chains, and say what came out"
DESCRIPTION = """\
Run a chain from rest, exactly, and print the events, the first global slip and mu_sapp. Events and events
kept (those of Fig. 13) are counted up to and including the first global slip, or over the whole run without
one. With --ensemble, many chains whose normal loads differ by noise: one row a chain."""
EXAMPLES = """\
  precursors simulate --theta 5/6
  precursors simulate --blocks 100 --until-global-slip --output long.h5
  precursors simulate --theta -5/6 --ensemble 1000 --noise 1e-3 --seed 7 --output ensemble.csv
  precursors simulate --mu-k 0.3 --json"""

NOISE = 1e-3
FIELDS = {
    "transitions": "transitions",
    "n_events": "events",
    "events_kept": "events_kept",
    "mu_sapp": "mu_sapp",
    "load": "largest_load_N",
    "time": "global_slip_s",
    "end": "global_slip_end_s",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this command."""
    add_chain(parser)
    add_duration(parser)
    group = parser.add_argument_group("an ensemble")
    group.add_argument("--ensemble", type=whole, metavar="N", help="run N chains that differ by noise")
    group.add_argument(
        "--noise",
        type=number,
        metavar="X",
        help=f"each normal load is changed by up to this share of it, uniformly distributed ({NOISE:g})",
    )
    group.add_argument("--seed", type=whole, metavar="N", help="seed of the noise (0)")
    parser.add_argument(
        "--output", type=Path, metavar="FILE", help="keep the run (HDF5), or the rows of the ensemble (CSV)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Simulate and print."""
    if arguments.ensemble is None:
        if arguments.noise is not None or arguments.seed is not None:
            raise ValueError("--noise and --seed belong to an ensemble: say --ensemble N too")
        return _one(arguments)
    if arguments.max_transitions is not None:
        raise ValueError("--max-transitions belongs to a single run: leave it out with --ensemble")
    return _ensemble(arguments)


def _one(arguments: argparse.Namespace) -> int:
    from precursors.analysis.summary import summarise

    result = simulate_of(arguments)
    if arguments.output:
        result.save(arguments.output)
    summary = summarise([result])[0]
    values: dict[str, Any] = {
        "blocks": result.chain.n_blocks,
        "duration_s": result.duration,
        **{label: summary[name].item() for name, label in FIELDS.items()},
        # the summary counts up to the first global slip
        "transitions": len(result.transitions),
    }
    if arguments.output:
        values["output"] = str(arguments.output)
    (print_json if arguments.json else print_values)(values)
    return ExitCode.DONE


def _ensemble(arguments: argparse.Namespace) -> int:
    import numpy as np
    import pandas as pd

    from precursors.ensembles.study import Study, run_members
    from precursors.model import chain as parameters
    from precursors.support.files import write_whole

    count = parameters.whole("ensemble", arguments.ensemble, at_least=1)
    noise = parameters.not_negative("noise", NOISE if arguments.noise is None else arguments.noise, "1")
    seed = parameters.whole("seed", arguments.seed or 0, at_least=0)
    slider = slider_of(arguments)
    parameters.Chain.from_slider(**slider)  # refuses a wrong value before members are made of it
    members = {
        "load_noise": np.full(count, noise),
        "group": np.zeros(count, dtype=int),
        "draw": np.arange(count),
    }
    study = Study("ensemble", slider, members, duration_of(arguments), until_of(arguments), seed)
    capped: list[str] = []
    with Progress("simulating", np.ones(count)) as progress:
        summary = run_members(
            study, 0, count, progress, None, lambda i, limit: capped.append(f"member {i + 1}: {limit}")
        )
    table = pd.DataFrame({label: summary[name] for name, label in FIELDS.items()})
    table.insert(0, "member", np.arange(1, count + 1))
    if arguments.output:
        with write_whole(arguments.output) as temporary:
            table.to_csv(temporary, index=False, lineterminator="\n")
    if arguments.json:
        print_json({"noise": noise, "seed": seed, "members": records(table)})
    elif arguments.output:
        print_values(_in_short(table) | {"output": str(arguments.output)})
    else:
        print_table(table)
    if capped:
        raise Refused(f"{len(capped)} of {count} rows are of runs that were cut short, {capped[0]}")
    return ExitCode.DONE


def _in_short(table: pd.DataFrame) -> dict[str, object]:
    """What the rows of an ensemble have in common."""
    return {
        "members": len(table),
        "with a global slip": int(table["global_slip_s"].notna().sum()),
        "events kept, 5 % to 95 %": _range(table["events_kept"]),
        "mu_sapp, 5 % to 95 %": _range(table["mu_sapp"]),
        "first global slip [s], 5 % to 95 %": _range(table["global_slip_s"]),
    }


def _range(values: pd.Series) -> str:
    low, high = values.quantile([0.05, 0.95])
    return f"{low:.5g} to {high:.5g}"
