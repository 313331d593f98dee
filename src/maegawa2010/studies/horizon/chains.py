"""The configuration's chains with a proof, and the numbers of their certificates."""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from maegawa2010.scenes import scene_as_written
from precursors.model.chain import Chain
from precursors.proof.certificate import Certificate
from precursors.proof.exact_chain import ExactChain

# Default duration of a proof [s].
PROVED_FOR = 10.0


def exact_chain(name: str, values: Mapping[str, Any]) -> ExactChain:
    """A chain of the configuration's `horizon.proved`, from its values there.

    Raises
    ------
    ValueError
        If a value is wrong.
    """
    slider = {key: x for key, x in values.items() if key != "duration"}
    try:
        Chain.from_slider(**slider)
    except (ValueError, OverflowError) as error:
        raise ValueError(f"horizon.proved.{name}: {error}") from None
    return ExactChain.from_slider(**slider)


def chain_duration(values: Mapping[str, Any]) -> float:
    """Duration of the proof of a chain of the configuration's `horizon.proved` [s]."""
    return float(values.get("duration", PROVED_FOR))


def scene_exact_chain(config: Mapping[str, Any], name: str) -> ExactChain:
    """The exact chain of a scene of the configuration; theta from load cells is not
    rounded (Sect. 5.2).

    Raises
    ------
    ValueError
        If the scene has measured weights.
    """
    if "weights" in config["scenes"][name]:
        raise ValueError(
            f"scenes.{name} must have theta or load cells for a proof, but has weights"
        )
    return ExactChain.from_slider(**scene_as_written(config, name))


def is_about(certificate: Certificate, chain: ExactChain, duration: float) -> bool:
    """Whether a certificate is about the whole run of a chain from rest for `duration`
    [s]."""
    return (
        certificate.chain == chain
        and certificate.duration == Fraction(repr(duration))
        and certificate.until is None
        and not any(certificate.start_positions + certificate.start_velocities)
    )


def certificate_row(certificate: Certificate) -> dict[str, float]:
    """Numbers of a proof: a row of certificates.csv."""
    return {
        "proved_until_s": float(certificate.proved_until),
        "transitions": len(certificate.transitions),
        "largest_time_width_s": float(
            max(t.time.upper - t.time.lower for t in certificate.transitions)
        ),
        **least_slopes(certificate),
        "bits": certificate.bits,
    }


def least_slopes(certificate: Certificate) -> dict[str, float]:
    """Smallest proved slopes of all releases, and of all stops and turns; NaN if none."""
    releases: list[float] = []
    stops: list[float] = []
    mode: dict[int, int] = {}
    for t in certificate.transitions:
        was_sliding = mode.get(t.block, 0) != 0
        mode[t.block] = t.mode
        if t.slope:
            (stops if was_sliding else releases).append(float(t.slope))
    return {
        "least_release_slope_N_per_s": min(releases, default=math.nan),
        "least_stop_slope_m_per_s2": min(stops, default=math.nan),
    }
