"""Hostile configurations: what is accepted runs, what is not is refused in one line, and nothing hangs."""

from __future__ import annotations

import contextlib
import faulthandler
import itertools
import json
import math
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import answer_scene
import hypothesis
import simulate_scene
import tabulate_slips
import tabulate_trace
import yaml
from chains import first_transitions
from numpy.random import default_rng

from faults.hostile import NAMES, ODDITIES, ROOT, SEED, a_copy, configuration, drawn, of_another_size, papers
from faults.outcome import Outcome
from precursors.model.config_check import check_config, scene_seconds
from precursors.model.config_file import check_config_file
from precursors.model.scenes import (
    scene_chain,
    scene_duration,
    scene_model,
    scene_names,
    scene_outputs,
    scene_quantities,
    scene_slider,
)
from precursors.solver.simulate import TransitionLimitError, simulate

SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
# 10,000 in all: from a grammar of what YAML can hold, and drawn by hypothesis.
FROM_GRAMMAR, BY_HYPOTHESIS = 8_000, 2_000
AT_ONCE = 100
THROUGH_SNAKEMAKE = 60
# A configuration is judged, and the first transitions of its scenes are found, in so many seconds of a core;
# a scene that is expected to take less than `CHEAP` runs to its end.
PATIENCE = 20
FIRST = 40
CHEAP = 0.03
# Scenes that are expected to take so long [s] may take this many times as long.
COSTED, FROM, TO, FACTOR = 30, 0.2, 1.0, 10.0
TRACED = 50  # one scene of so many


# The loader that Snakemake has of YTE, compiled where it is.
LOADER: Any = getattr(yaml, "CFullLoader", yaml.FullLoader)


class Hang(Exception):
    """A configuration took longer than it may."""


def verdict(content: bytes, ran: Counter[str] | None = None) -> str:
    """Judge a configuration file as the workflow does, and run what is accepted, counting how far."""

    def too_long(*_: object) -> None:
        raise Hang

    # Processor time, as the machine may be busy; again each second, as Python may swallow the first.
    before = signal.signal(signal.SIGPROF, too_long)
    signal.setitimer(signal.ITIMER_PROF, PATIENCE, 1)
    # Compiled code hears no signal: this ends the process.
    faulthandler.dump_traceback_later(20 * PATIENCE, exit=True)
    try:
        with tempfile.TemporaryDirectory() as directory:
            return _verdict(content, Path(directory), Counter() if ran is None else ran)
    except Hang:
        return f"hangs: no end after {PATIENCE} s"
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:200]}"
    finally:
        faulthandler.cancel_dump_traceback_later()
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def _verdict(content: bytes, directory: Path, ran: Counter[str]) -> str:
    path = directory / "config.yaml"
    path.write_bytes(content)
    try:
        check_config_file(path)
        config = as_snakemake_reads(path)
        check_config(config, SCHEMA)
    except ValueError as error:
        line = str(error)
        one_line = len(line.splitlines()) == 1 and len(line) < 700
        return "refused" if one_line and line.isprintable() else f"refused in {line[:300]!r}"
    for name in scene_names(config):
        if re.fullmatch("[A-Za-z][A-Za-z0-9_-]{0,63}", name) is None:
            return f"the scene {name!r} was accepted"
    for name in scene_names(config):
        # A trace takes a hundred times as long as its run.
        ran[run_scene(config, name, directory, with_trace=ran.total() % TRACED == TRACED - 1)] += 1
    return "survived"


def as_snakemake_reads(path: Path) -> Any:
    """What `snakemake.common.configfile` makes of a file without `__use_yte__`, by a compiled parser."""
    text = path.read_text(encoding="utf-8")
    try:
        return json.loads(text)
    except ValueError:
        return yaml.load(text, LOADER)


@cache
def as_in_the_paper() -> dict[str, Any]:
    """Sliders and durations of the paper's scenes, which need not be run again and again."""
    return {
        name: (scene_slider(papers(), name), scene_duration(papers(), name)) for name in papers()["scenes"]
    }


def run_scene(config: Mapping[str, Any], name: str, directory: Path, with_trace: bool = False) -> str:
    """Run a scene by the scripts of the workflow, or only its first transitions; return how far it came."""
    slider, model = scene_slider(config, name), scene_model(config, name)
    plain = scene_outputs(config, name) != ("answers",) and scene_model(config, name) == "chain"
    if plain and as_in_the_paper().get(name) == (slider, scene_duration(config, name)):
        return "as in the paper"
    if scene_seconds(config, name) > CHEAP:
        first_transitions(scene_chain(config, name), FIRST, duration=scene_duration(config, name))
        return f"to {FIRST} transitions"
    if scene_outputs(config, name) == ("answers",):
        answer_scene.main(slider, model, scene_quantities(config, name), directory / f"{name}_answers.csv")
        return "answered"
    run = directory / f"{name}.h5"
    simulate_scene.main(slider, scene_duration(config, name), run)
    tabulate_slips.main(run, directory / f"{name}_slips.csv")
    if with_trace:
        tabulate_trace.main(run, directory / f"{name}_trace.csv")
    return "to the end"


def judge(first: int, last: int) -> tuple[Outcome, Counter[str]]:
    """Judge the configurations of the grammar with numbers from `first` up to `last`."""
    judged, ran = Outcome("configuration: grammar"), Counter[str]()
    for number in range(first, last):
        answer = verdict(configuration(number), ran)
        good = answer in ("survived", "refused")
        judged.count(answer if good else f"configuration({number}): {answer}")
    return judged, ran


def judge_drawn(number: int, seed: int) -> tuple[Outcome, Counter[str]]:
    """Judge so many configurations that hypothesis draws."""
    judged, ran = Outcome("configuration: hypothesis"), Counter[str]()

    @hypothesis.seed(seed)
    @hypothesis.settings(
        max_examples=number,
        database=None,
        deadline=None,
        phases=[hypothesis.Phase.generate],
        suppress_health_check=list(hypothesis.HealthCheck),
    )
    @hypothesis.given(drawn())
    def each(content: bytes) -> None:
        answer = verdict(content, ran)
        judged.count(answer if answer in ("survived", "refused") else f"{answer}: {content[-400:]!r}")

    each()
    return judged, ran


def expected(number: int) -> float:
    """Time that the scene of another size with a number is expected to take [s], NaN if it is refused."""
    try:
        scene_chain(of_another_size(number), "odd")
        return scene_seconds(of_another_size(number), "odd")
    except ValueError:
        return math.nan


def measured(number: int) -> float:
    """Processor time that it takes [s], once all is compiled and loaded."""
    config = of_another_size(number)
    chain, duration = scene_chain(config, "odd"), scene_duration(config, "odd")
    first_transitions(chain, FIRST, duration=duration)
    begin = time.process_time()
    with contextlib.suppress(TransitionLimitError):
        simulate(chain, duration=duration)
    return time.process_time() - begin


def cost(numbers: list[int]) -> tuple[Outcome, list[float]]:
    """Hold the expected time of some scenes against what they take."""
    judged, ratios = Outcome("configuration: cost"), []
    for number in numbers:
        ratios.append(measured(number) / expected(number))
        good = ratios[-1] < FACTOR
        judged.count(
            "survived"
            if good
            else f"of_another_size({number}) took {ratios[-1]:.1f} times as long as expected"
        )
    return judged, ratios


def as_config_file(number: int) -> tuple[list[str], dict[str, bytes]]:
    """A hostile config.yaml in the directory."""
    return [], {"config.yaml": configuration(number)}


def as_file_of_the_command_line(number: int) -> tuple[list[str], dict[str, bytes]]:
    """The paper's config.yaml, and a hostile file on the command line."""
    paper = (ROOT / "config.yaml").read_bytes()
    return ["--configfile", "odd.yaml"], {"config.yaml": paper, "odd.yaml": configuration(number)}


def as_value_of_the_command_line(number: int) -> tuple[list[str], dict[str, bytes]]:
    """The paper's config.yaml, and an oddity on the command line."""
    rng = default_rng([SEED, number])
    key = rng.choice(["duration", "longest_run", "chain", "scenes", "fig13", "unknown"])
    oddity = str(rng.choice(ODDITIES)).replace("\0", "")
    value = {"chain": f"{{mu_s: {oddity}}}", "scenes": f"{{odd: {{title: odd, theta: {oddity}}}}}"}.get(
        key, oddity
    )
    return ["--config", f"{key}={value}"], {"config.yaml": (ROOT / "config.yaml").read_bytes()}


def as_name(number: int) -> tuple[list[str], dict[str, bytes]]:
    """A scene with an odd name."""
    config = a_copy()
    config["scenes"][NAMES[number % len(NAMES)]] = {"title": "odd", "theta": 0.1}
    return [], {"config.yaml": yaml.safe_dump(config, allow_unicode=True).encode()}


WAYS = (as_name, as_config_file, as_file_of_the_command_line, as_value_of_the_command_line)


def through_snakemake(number: int) -> str:
    """Give a hostile configuration to Snakemake itself: it plans all jobs or refuses, and writes nothing."""
    arguments, files = WAYS[number % len(WAYS)](number)
    with tempfile.TemporaryDirectory() as directory:
        for name, content in files.items():
            (Path(directory) / name).write_bytes(content)
        command = [sys.executable, "-m", "snakemake", "-c1", "-n", "--quiet", "rules", "host"]
        try:
            run = subprocess.run(
                [*command, "--snakefile", str(ROOT / "Snakefile"), "--directory", ".", *arguments],
                capture_output=True,
                text=True,
                errors="replace",
                cwd=directory,
                timeout=20 * PATIENCE,
            )
        except subprocess.TimeoutExpired:
            return f"hangs: no end after {20 * PATIENCE} s"
        left = {p.name for p in Path(directory).iterdir()} - {".snakemake"}
    if left != set(files):
        return f"wrote {sorted(left)}"
    if run.returncode == 0:
        return "survived"
    text = run.stdout + run.stderr
    said = [line for line in text.splitlines() if "onfig" in line and "WorkflowError" not in line]
    if "Traceback" in text or not said:
        return f"Snakemake ended with {run.returncode}: {text[-600:]!r}"
    return "refused"


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Judge a share of the configurations, and give some to Snakemake."""
    drawn_number = max(AT_ONCE, round(BY_HYPOTHESIS * share))
    last = round(FROM_GRAMMAR * share)
    ranges = [(first, min(first + AT_ONCE, last)) for first in range(0, last, AT_ONCE)]
    outcomes = {
        name: Outcome(f"configuration: {name}") for name in ("grammar", "hypothesis", "Snakemake", "cost")
    }
    ran = Counter[str]()
    with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
        drawings = [pool.submit(judge_drawn, AT_ONCE, seed) for seed in range(drawn_number // AT_ONCE)]
        of_grammar = [pool.submit(judge, *numbers) for numbers in ranges]
        given = {
            number: pool.submit(through_snakemake, number)
            for number in range(max(len(WAYS), round(THROUGH_SNAKEMAKE * share)))
        }
        likely = (number for number in itertools.count() if FROM < expected(number) < TO)
        costed = list(itertools.islice(likely, max(processes, round(COSTED * share))))
        costs = [pool.submit(cost, costed[i::processes]) for i in range(processes)]
        ratios: list[float] = []
        for name, futures in (("hypothesis", drawings), ("grammar", of_grammar), ("cost", costs)):
            for future in futures:
                try:
                    outcome, found = future.result()
                except BrokenProcessPool:
                    outcomes[name].count("the interpreter crashed, or did not come back from compiled code")
                    continue
                outcomes[name] += outcome
                if isinstance(found, Counter):
                    ran += found
                else:
                    ratios += found
        for number, answered in given.items():
            error = answered.exception()
            answer = str(error) if error else answered.result()
            good = answer in ("survived", "refused")
            outcomes["Snakemake"].count(answer if good else f"through_snakemake({number}): {answer}")
    if ratios:
        outcomes["cost"].note = f"took {min(ratios):.2g} to {max(ratios):.2g} of what was expected"
    outcomes["grammar"].note = "scenes run " + ", ".join(f"{how}: {n}" for how, n in sorted(ran.items()))
    return list(outcomes.values())
