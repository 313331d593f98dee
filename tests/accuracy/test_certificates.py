"""Certificates come back from their files, are what is proved, and are refused if they are not."""

from __future__ import annotations

import csv
import dataclasses
import gzip
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest
import yaml
from reference import Transition
from reference.goldens import GOLDEN, SCENE_DIGITS, SCENES, csv_rows

from precursors.accuracy.proof import (
    Certificate,
    CertificateError,
    CertifiedTransition,
    Enclosure,
    ExactChain,
    certify,
    verify,
)
from precursors.accuracy.proof.chains import chain_duration, exact_chain, is_about, scene_exact_chain

CHAINS = yaml.safe_load((Path(__file__).parents[2] / "config.yaml").read_text())["accuracy"]["proved"]
# A committed certificate is smaller [bytes].
LARGEST_FILE = 300_000
COMMITTED = Path(__file__).parents[2] / "workflow" / "certificates"
# The chains of the three scenes in horizon.chains of the configuration.
PROVED_SCENES = {"fig10": "uniform", "fig11": "trailing", "fig12": "leading"}


@pytest.mark.parametrize(("scene", "chain"), PROVED_SCENES.items())
def test_the_golden_tables_are_the_proof_rounded_digit_for_digit(scene: str, chain: str) -> None:
    certificate = Certificate.load(COMMITTED / f"{chain}.json.gz")
    assert certificate.chain == ExactChain.from_slider(theta=SCENES[scene])
    assert certificate.proved_until == 10
    with (GOLDEN / f"reference_{scene}.csv").open(newline="") as file:
        _, *golden = csv.reader(file)
    # Both ends of every enclosure round to the digits of the golden table.
    for end in ("lower", "upper"):
        ends = [
            Transition(getattr(t.time, end), t.block, t.mode, getattr(t.tangential_load, end))
            for t in certificate.transitions
        ]
        assert csv_rows(ends, SCENE_DIGITS) == golden


@pytest.mark.parametrize("name", CHAINS)
def test_the_committed_certificates_are_about_the_chains_of_the_configuration(name: str) -> None:
    certificate = Certificate.load(COMMITTED / f"{name}.json.gz")
    assert is_about(certificate, exact_chain(CHAINS[name]), chain_duration(CHAINS[name]))
    assert not is_about(certificate, exact_chain(CHAINS[name]), 2 * chain_duration(CHAINS[name]))
    assert (COMMITTED / f"{name}.json.gz").stat().st_size < LARGEST_FILE


@pytest.fixture(scope="module")
def small() -> Certificate:
    return certify(ExactChain.from_slider(n_blocks=3, theta="1/2"), 4)


def test_a_certificate_comes_back_from_its_file(small: Certificate, tmp_path: Path) -> None:
    path = tmp_path / "small.json.gz"
    small.save(path)
    assert verify(path) == small
    assert verify(small) is small
    first = path.read_bytes()
    small.save(path)
    assert path.read_bytes() == first


FOREIGN = {
    "empty": (b"", "Expecting value"),
    "text": (b"no gzip", "Not a gzipped file"),
    "object": (gzip.compress(b"{}"), "'format'"),
    "list": (gzip.compress(b"[1, 2]"), "list indices must be integers"),
    "nested": (gzip.compress(b"[" * 100_000), "maximum recursion depth exceeded"),
    "another format": (
        gzip.compress(b'{"format": "else"}'),
        "its format must be 'precursors certificate 1', but is 'else'",
    ),
}


@pytest.mark.parametrize(("content", "why"), FOREIGN.values(), ids=FOREIGN)
def test_a_foreign_file_is_refused_in_one_line(content: bytes, why: str, tmp_path: Path) -> None:
    path = tmp_path / "foreign.json.gz"
    path.write_bytes(content)
    with pytest.raises(
        CertificateError, match=rf"foreign\.json\.gz is not a whole certificate: {why}"
    ) as error:
        Certificate.load(path)
    assert "\n" not in str(error.value)


def test_a_damaged_file_is_refused(small: Certificate, tmp_path: Path) -> None:
    path = tmp_path / "small.json.gz"
    small.save(path)
    whole = path.read_bytes()
    # The first ten bytes are gzip's header, some of which mean nothing.
    flipped = [whole[:i] + bytes([whole[i] ^ 1]) + whole[i + 1 :] for i in range(10, len(whole), 97)]
    for damaged in [whole[:-1], whole[: len(whole) // 2], *flipped]:
        path.write_bytes(damaged)
        with pytest.raises(CertificateError, match="is not a whole certificate"):
            Certificate.load(path)


Transitions = list[CertifiedTransition]
Spoil = Callable[[Transitions], Transitions]


def changed(number: int, part: str, shift: Callable[[Enclosure], Fraction], shrink: int = 1) -> Spoil:
    """Move and shrink one enclosure of a transition."""

    def spoil(transitions: Transitions) -> Transitions:
        old = getattr(transitions[number], part)
        new = Enclosure(old.midpoint + shift(old), old.radius / shrink)
        transitions[number] = transitions[number]._replace(**{part: new})
        return transitions

    return spoil


def with_other(**changes: int) -> Spoil:
    """Give a transition another block or mode."""
    return lambda ts: [*ts[:7], ts[7]._replace(**changes), *ts[8:]]


WRONG_TIME, WRONG_ORDER = "its time is not proved within", "which is not what is stated"
SPOILED: dict[str, tuple[Spoil, str]] = {
    "narrower than proved": (changed(-1, "time", lambda _: Fraction(0), shrink=1000), WRONG_TIME),
    "another load": (
        changed(5, "tangential_load", lambda old: 2 * old.radius),
        "its load is not proved within",
    ),
    **{
        f"digit {n}": (changed(7, "time", lambda _, n=n: Fraction(1, 10**n)), WRONG_TIME)
        for n in (2, 9, 20, 35, 43)
    },
    "swapped": (lambda ts: [*ts[:7], ts[8], ts[7], *ts[9:]], WRONG_ORDER),
    "another block": (with_other(block=3), WRONG_ORDER),
    "another mode": (with_other(mode=-1), WRONG_ORDER),
    "without its first": (lambda ts: ts[2:], r"not what is proved with \d+ bits"),
    "without its last": (lambda ts: ts[:-1], r"not what is proved with \d+ bits"),
}


@pytest.mark.parametrize(("spoil", "words"), SPOILED.values(), ids=SPOILED)
def test_what_is_not_proved_is_refused(small: Certificate, spoil: Spoil, words: str) -> None:
    with pytest.raises(CertificateError, match=words):
        verify(dataclasses.replace(small, transitions=tuple(spoil(list(small.transitions)))))


def test_theta_of_a_scene_is_not_rounded() -> None:
    slider = {"n_blocks": 10, "normal_load": 400.0, "length": 0.1}
    scenes = {
        "cells": {"load_cell_a": 100.0, "load_cell_b": 300.0},
        "fraction": {"theta": "5/6"},
        "number": {"theta": 0.5},
    }
    config = {"chain": slider, "load_cells": {"spacing": 0.06}, "scenes": scenes}
    assert scene_exact_chain(config, "cells") == ExactChain.from_slider(theta=Fraction(5, 6))
    assert scene_exact_chain(config, "fraction") == ExactChain.from_slider(theta="5/6")
    assert scene_exact_chain(config, "number") == ExactChain.from_slider(theta=Fraction(1, 2))


def test_one_block_has_the_whole_load_whatever_theta_is():
    assert ExactChain.from_slider(n_blocks=1, theta="5/6").weights == (400,)


@pytest.mark.parametrize(
    ("argument", "message"),
    [
        ({"theta": "7/6"}, "theta"),
        ({"theta": 1 + Fraction(1, 10**30)}, "weights"),
        ({"mu_s": "0.4"}, "mu_k"),
        ({"mu_k": Fraction(7, 10) + Fraction(1, 10**30)}, "mu_k must be at most mu_s = 7/10"),
        ({"slider_mass": 0}, "mass"),
        ({"length": "0"}, "length"),
        ({"theta": "1e999999999"}, "theta must be a finite number"),
        ({"normal_load": float("nan")}, "normal_load must be a finite number"),
        ({"n_blocks": 0}, "n_blocks"),
    ],
)
def test_a_bad_parameter_is_named(argument: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ExactChain.from_slider(**argument)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("argument", "message"),
    [
        ({"duration": 0}, "must be above 0 s, but is 0 s"),
        ({"width": 0}, "must be above 0 s, but is 0 s"),
        ({"until": "slip"}, "until"),
        ({"start_positions": ["0"]}, "start_positions must have one value"),
        ({"start_velocities": [0] * 9}, r"start_velocities must have one value \[m/s\] for each of the 10"),
    ],
)
def test_a_bad_argument_is_named(argument: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        certify(ExactChain.from_slider(), **argument)  # type: ignore[arg-type]


def test_without_python_flint_the_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "flint", None)
    for name in ("tube", "motion", "event_roots"):
        monkeypatch.delitem(sys.modules, f"precursors.accuracy.proof.{name}", raising=False)
    with pytest.raises(ModuleNotFoundError, match=r'pip install "precursors\[proof\]"'):
        certify(ExactChain.from_slider(), 1)


def test_something_else_than_a_chain_is_named() -> None:
    with pytest.raises(TypeError, match="what is proved must be a chain, but is dict"):
        certify({})  # type: ignore[arg-type]
