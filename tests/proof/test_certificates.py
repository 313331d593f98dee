"""Certificates round-trip through their files, and are refused if they differ from
their proof."""

import dataclasses
import gzip
import sys
from collections.abc import Callable
from fractions import Fraction

import pytest
from benchmark.made_up import tied_certificate

from precursors.proof import (
    Certificate,
    CertificateError,
    CertifiedTransition,
    Enclosure,
    ExactChain,
    certify,
    verify,
)

SLIDER = ExactChain.from_slider


@pytest.fixture(scope="module")
def small() -> Certificate:
    return certify(SLIDER(n_blocks=3, theta="1/2"), 4)


def test_certificate_file_round_trips_and_is_reproducible(small, tmp_path):
    path = tmp_path / "small.json.gz"
    for certificate in (small, tied_certificate()):
        certificate.save(path)
        assert verify(path) == certificate
        first = path.read_bytes()
        certificate.save(path)
        assert path.read_bytes() == first


def test_foreign_or_damaged_certificate_is_refused_in_one_line(small, tmp_path):
    path = tmp_path / "damaged.json.gz"
    small.save(path)
    whole = path.read_bytes()
    text = gzip.decompress(whole)
    damaged = {
        whole[: len(whole) // 2]: "Compressed file ended",
        b"no gzip": "Not a gzipped file",
        gzip.compress(
            text.replace(b"certificate 2", b"certificate 3")
        ): "its format must be 'precursors certificate 2', but is ",
        gzip.compress(
            text.replace(b"Every run", b"No run")
        ): "its claim differs from that of a certificate",
    }
    for content, why in damaged.items():
        path.write_bytes(content)
        with pytest.raises(
            CertificateError,
            match=f"damaged.json.gz is not a complete certificate: {why}",
        ) as e:
            verify(path)
        assert "\n" not in str(e.value)


def one_digit(enclosure: Enclosure) -> Enclosure:
    return enclosure._replace(midpoint=enclosure.midpoint + Fraction(1, 10**43))


SPOILED: dict[str, tuple[Callable[[CertifiedTransition], CertifiedTransition], str]] = {
    "time": (
        lambda t: t._replace(time=one_digit(t.time)),
        "its time is not proved within",
    ),
    "load": (
        lambda t: t._replace(tangential_load=one_digit(t.tangential_load)),
        "its load is not proved within",
    ),
    "mode": (
        lambda t: t._replace(mode=-1),
        "block 2 goes to mode .1, which differs from the certificate",
    ),
    "slope": (
        lambda t: t._replace(slope=t.slope * Fraction(102, 100)),
        "a slope of .* is not proved",
    ),
}


@pytest.mark.parametrize(("spoil", "words"), SPOILED.values(), ids=SPOILED)
def test_changed_transition_is_refused(small, spoil, words):
    wrong = [
        *small.transitions[:7],
        spoil(small.transitions[7]),
        *small.transitions[8:],
    ]
    with pytest.raises(
        CertificateError,
        match=f"it differs from the proof with 256 bits: transition 8, .*{words}",
    ):
        verify(dataclasses.replace(small, transitions=tuple(wrong)))


def test_changed_end_or_tie_is_refused(small):
    tied = tied_certificate()
    assert tied.tie
    early = tied.tie._replace(time=Enclosure(Fraction(1, 10), Fraction(0)))
    for wrong, words in (
        (
            dataclasses.replace(small, transitions=small.transitions[:-1]),
            "23 transitions instead of 24",
        ),
        (
            dataclasses.replace(tied, tie=None),
            r"a tie of blocks none instead of \(2, 6\)",
        ),
        (dataclasses.replace(tied, tie=early), "the tie is at t = 8.20659253e-06 s"),
    ):
        with pytest.raises(CertificateError, match=words):
            verify(wrong)


def test_one_block_carries_the_whole_load_for_any_theta():
    assert SLIDER(n_blocks=1, theta="5/6").weights == (400,)


@pytest.mark.parametrize(
    ("slider", "argument", "message"),
    [
        (
            {"theta": "1e999999999"},
            {},
            'theta must be a finite number, or one in quotes such as "5/6", but is ',
        ),
        ({}, {"duration": 0}, "duration must be above 0 s, but is 0 s"),
        (
            {},
            {"start_velocities": [0] * 9},
            r"start_velocities .* \[m/s\] for each of the 10",
        ),
    ],
)
def test_bad_argument_is_named(slider, argument, message):
    with pytest.raises(ValueError, match=message):
        certify(SLIDER(**slider), **argument)


def test_missing_python_flint_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "flint", None)
    for name in ("tube", "motion", "event_roots"):
        monkeypatch.delitem(sys.modules, f"precursors.proof.{name}", raising=False)
    with pytest.raises(ModuleNotFoundError, match=r'pip install "precursors\[proof\]"'):
        certify(SLIDER(), 1)
