"""`precursors plot`: draw a run, on the screen where there is one, else in a file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from precursors.cli.arguments import add_run, run_of
from precursors.cli.exit_codes import ExitCode
from precursors.cli.output import print_json
from precursors.support.progress import Progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from precursors.solver.run import Run

NAME = "plot"
HELP = "draw a run"
DESCRIPTION = """\
Draw a run file, or a chain that is run: the tangential load over time with the fronts of all slips below
it (as Figs. 10 to 12), or propagation lengths against the load (as Fig. 13). The figure is shown in a
window; with --output, or without a display, it is written to a file (PNG or SVG)."""
EXAMPLES = """\
  precursors plot --theta 5/6 --blocks 20
  precursors plot --theta -5/6 --duration 3 --output steep.svg
  precursors plot results/runs/fig12.h5 --figure lengths"""

DEFAULT_OUTPUT = Path("precursors.png")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this command."""
    add_run(parser)
    parser.add_argument(
        "--figure",
        choices=["load", "lengths"],
        default="load",
        help="tangential load and slips over time, or propagation lengths against the load (load)",
    )
    parser.add_argument(
        "--output",
        type=Path,
        metavar="FILE",
        help=f"write a .png or .svg ({DEFAULT_OUTPUT} without a display)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Draw the run; show or write the figure."""
    result = run_of(arguments)
    with Progress("drawing"):
        figure = draw_lengths(result) if arguments.figure == "lengths" else draw_load(result)
    output = arguments.output
    if output is None and not arguments.json and show(figure):
        return ExitCode.DONE
    why = "" if output or arguments.json else "no display: "
    output = output or DEFAULT_OUTPUT
    from precursors.figures import style

    style.save(figure, output)
    if arguments.json:
        print_json({"output": str(output.resolve())})
    else:
        print(f"{why}wrote {output.resolve()}")
    return ExitCode.DONE


def draw_load(run: Run) -> Figure:
    """F_X(t) and the fronts of all slips, as Figs. 10 to 12."""
    from precursors.analysis.load_curve import load_trace
    from precursors.analysis.slip_table import slip_table
    from precursors.figures.scene import draw_scene

    chain = run.chain
    return draw_scene(slip_table(run), load_trace(run), chain.n_blocks, chain.length, label=_label(run))


def draw_lengths(run: Run) -> Figure:
    """Propagation lengths against the load, as Fig. 13."""
    from precursors.analysis.slip_table import slip_table
    from precursors.figures.precursor_lengths import PrecursorLengths, draw_precursor_lengths

    chain = run.chain
    return draw_precursor_lengths(
        [PrecursorLengths(slip_table(run), theta_of(run), chain.n_blocks, chain.normal_load)]
    )


def theta_of(run: Run) -> float:
    """Theta of Eq. 7 from the outer blocks' weights: (w_N - w_1) / (w_N + w_1); 0 for one block."""
    first, last = run.chain.weights[0], run.chain.weights[-1]
    return float((last - first) / (last + first)) if last + first else 0.0


def show(figure: Figure) -> bool:
    """Show a figure in a window until it is closed; return False where there is no display."""
    from matplotlib import pyplot

    try:
        # The one public way to hand a finished figure to pyplot in every release.
        shown = pyplot.figure(FigureClass=lambda *_, **__: figure)  # type: ignore[arg-type]
    except (ImportError, RuntimeError):  # a window system was asked for that cannot be opened
        return False
    if shown.canvas.required_interactive_framework is None:
        pyplot.close(shown)
        return False
    pyplot.show(block=True)
    return True


def _label(run: Run) -> str:
    from precursors.figures import style

    return f"{style.theta_text(theta_of(run))}, $N = {run.chain.n_blocks}$"
