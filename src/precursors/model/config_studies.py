"""What a configuration asks for beside its scenes, and cannot have: values that no schema can compare."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from precursors.ensembles.cost import PROOF_PER_RUN, seconds_of_run, too_long
from precursors.ensembles.maps import AXES, map_study
from precursors.model.chain import Chain, parse_theta
from precursors.model.scenes import Config, scene_slider
from precursors.model.slider import PROVED_FOR, SLIDER, Slider, loading_time

# Names that a table would give back as something else than text.
NO_TEXT = ("na", "nan", "null", "none", "true", "false", "inf", "infinity")


def wrong_studies(config: Config) -> Iterator[str]:
    """Complaints about a configuration that fits the schema and whose scenes are right."""
    yield from _wrong_names(config)
    yield from _wrong_degrees(config)
    yield from _wrong_orders(config)
    yield from _wrong_changes(config)
    yield from _wrong_proofs(config)
    yield from _too_short(config)
    yield from _unknown_chains(config)
    for where, slider, duration in _runs(config):
        yield from _wrong_run(config, where, slider, seconds_of_run(slider, duration))


def _wrong_run(config: Config, where: str, slider: Slider, seconds: float) -> Iterator[str]:
    """Why a run cannot be made, or takes too long."""
    try:
        Chain.from_slider(**slider)
    except ValueError as error:
        yield f"{where}: {error}"
    except OverflowError:
        yield f"{where}: numbers so far apart cannot be computed with: allowed are those of a slider"
    yield from too_long(config, where, seconds)


def _wrong_names(config: Config) -> Iterator[str]:
    tables = {
        "scenes": config["scenes"],
        "horizon.chains": config["horizon"]["chains"],
        "resolution_models.models": config["resolution_models"]["models"],
    }
    for where, table in tables.items():
        met: dict[str, str] = {}
        for name in table:
            if name.lower() in NO_TEXT:
                others = ", ".join(NO_TEXT)
                yield f"{where}.{name}: a table would not give this name back: allowed is any but {others}"
            if name.lower() in met:
                yield (
                    f"{where}.{name} differs from {met[name.lower()]} in capitals alone, "
                    "and would share its files on some machines: allowed is one of the two"
                )
            met[name.lower()] = name


def _wrong_degrees(config: Config) -> Iterator[str]:
    """Values of theta, whose fractions are text to the schema."""
    met: dict[float, object] = {}
    degrees = {f"definitions.theta[{i}]": theta for i, theta in enumerate(config["definitions"]["theta"])}
    for where, written in {
        "resolution_models.theta": config["resolution_models"]["theta"],
        **degrees,
    }.items():
        try:
            theta = parse_theta(written)
        except ValueError as error:
            yield f"{where}: {error}"
            continue
        if where not in degrees:
            continue
        if theta <= 0:
            yield f"{where} = {written!r} is a size of theta: allowed is 0 < theta <= 1"
        if theta in met:
            yield f"{where} = {written!r} stands there as {met[theta]!r} too: allowed is each theta once"
        met[theta] = written


def _wrong_orders(config: Config) -> Iterator[str]:
    """Pairs of values of which one must not be above the other."""
    for axis in ("theta", *(axis for axis, _ in AXES.values())):
        low, high = config["maps"][axis]
        if low >= high:
            yield f"maps.{axis} = {[low, high]!r}: allowed is the lower value, then the upper"
    for section in ("default", "full"):
        steps = config["step_sweep"][section]
        for finest in ("finest", "finest_every_step"):
            if steps[finest] > steps["coarsest"]:
                yield (
                    f"step_sweep.{section}.{finest} = {steps[finest]!r} [s] is longer than "
                    f"coarsest = {steps['coarsest']!r} s: allowed is {finest} <= coarsest"
                )
    runs = config["resolution"]
    if runs["least_runs"] > runs["most_runs"]:
        yield (
            f"resolution.least_runs = {runs['least_runs']!r} is more than "
            f"most_runs = {runs['most_runs']!r}: allowed is least_runs <= most_runs"
        )


def _wrong_changes(config: Config) -> Iterator[str]:
    """Relative changes by which mu_k comes above mu_s."""
    for scene in config["fig13"]:
        slider = scene_slider(config, scene)
        mu_s, mu_k = slider["mu_s"], slider["mu_k"]
        for i, size in enumerate(config["spread"]["parameters"]):
            if mu_k > mu_s * (1.0 - size) or mu_k * (1.0 + size) > mu_s:
                most = (mu_s - mu_k) / mu_s
                yield (
                    f"spread.parameters[{i}] = {size!r} makes mu_k larger than mu_s in {scene}: "
                    f"allowed is up to {most:.3g}"
                )


def _unknown_chains(config: Config) -> Iterator[str]:
    """Chains to compare methods on that have no proof."""
    proved = config["horizon"]["chains"]
    for name in config["accuracy"]["chains"]:
        if name not in proved:
            yield (
                f"accuracy.chains names {name!r}, which is no chain of horizon.chains: "
                f"allowed are {', '.join(proved)}"
            )


def _too_short(config: Config) -> Iterator[str]:
    """Long runs too short for a global slip, which the load mu_s F_Z brings about at the latest."""
    duration = config["long_runs"]["duration"]
    for scene in config["fig13"]:
        shortest = loading_time(scene_slider(config, scene))
        if duration < shortest:
            yield (
                f"long_runs.duration = {duration!r} [s] is too short for a global slip of {scene}: "
                f"allowed is at least {shortest:.6g} s"
            )


def _wrong_proofs(config: Config) -> Iterator[str]:
    """Chains that are proved: what they do not give is the paper's, whatever `chain` says."""
    for name, values in config["horizon"]["chains"].items():
        where = f"horizon.chains.{name}"
        slider: dict[str, Any] = {**SLIDER, **values}
        duration = slider.pop("duration", PROVED_FOR)
        try:
            slider["theta"] = parse_theta(slider["theta"])
        except ValueError as error:
            yield f"{where}: {error}"
        yield from _wrong_run(config, where, slider, PROOF_PER_RUN * seconds_of_run(slider, duration))
        chain = Chain.from_slider(**slider)
        first_slip = float(chain.strength[0] / chain.loading_rate)
        if duration <= first_slip:
            yield (
                f"{where}.duration = {duration!r} [s] ends before block 1 slips: "
                f"allowed is more than {first_slip:.3g} s"
            )


def _runs(config: Config) -> Iterator[tuple[str, Slider, float]]:
    """Where a run is asked for, its slider and its duration [s]: of each study the longest or the oddest."""
    duration = config["duration"]
    yield "chain", {**config["chain"], "theta": 0.0}, duration
    for scene in (scene_slider(config, name) for name in config["fig13"]):
        yield "long_runs.duration", scene, config["long_runs"]["duration"]
        yield "horizon.lyapunov_duration", scene, config["horizon"]["lyapunov_duration"]
        yield "scaling.durations", scene, max(config["scaling"]["durations"])
    for where, slider in _up_to_a_global_slip(config):
        yield where, slider, min(duration, loading_time(slider))
    corners = {**config, "maps": {**config["maps"], "points": 4}}
    for name, (axis, _) in AXES.items():
        with np.errstate(all="ignore"):
            study = map_study(corners, name)
        for i, longest in enumerate(study.column("duration").tolist()):
            corner = {key: study.column(key)[i].item() for key in SLIDER}
            yield f"maps.{axis}", corner, longest


def _up_to_a_global_slip(config: Config) -> Iterator[tuple[str, Slider]]:
    for slider in (scene_slider(config, name) for name in config["fig13"]):
        for section in ("resolution", "scaling"):
            yield f"{section}.n_blocks", slider | {"n_blocks": max(config[section]["n_blocks"])}
