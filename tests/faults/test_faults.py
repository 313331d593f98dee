"""A small share of every fault, and each one that was ever lost under its own name."""

import gzip
import json
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import yaml
from tables import read_table, write_table

from faults import configuration, damage, physics
from faults.outcome import Outcome, table
from precursors import Chain, simulate
from precursors.config import check_config, scene_seconds
from precursors.proof.certificate import Certificate, CertificateError
from precursors.storage import CHECKSUMS, open_checked, write_sealed
from precursors.tables import slip_table

GOOD = {"survived", "refused"}
# Not the first ones, which `make test-faults` tries again.
FEW_CHAINS = range(15_000, 15_040)
FEW_CONFIGURATIONS = range(60)
FEW = 0.02


def papers(**changes):
    return configuration.a_copy() | changes


def refusal(config) -> str:
    with pytest.raises(ValueError, match="configuration: ") as error:
        check_config(config, configuration.SCHEMA)
    assert len(str(error.value).splitlines()) == 1
    return str(error.value)


@pytest.mark.parametrize("number", FEW_CHAINS)
def test_a_hostile_chain_moves_as_the_model_does_or_is_refused(number):
    assert physics.judged(number)[1] in GOOD


def test_the_auditor_sees_a_hostile_run_that_is_wrong(monkeypatch):
    """Without this, `survived` would say nothing: one release of each run comes late, by a millionth."""

    def delayed(chain, most, **options):
        run = right(chain, most, **options)
        intervals, times, shift = run.intervals.copy(), run.transitions.copy(), 0.0
        late = np.flatnonzero(intervals[:-1] > 0)
        if late.size:
            shift = 1e-6 * intervals[late[-1]]
            intervals[late[-1]] += shift
            times["time"][late[-1] :] += shift
        return replace(run, intervals=intervals, transitions=times, duration=run.duration + shift)

    right = physics.first_transitions
    numbers = [n for n in range(30) if physics.trial_kind(n) == "slider"]
    assert {physics.judged(n)[1] for n in numbers} == {"survived"}
    monkeypatch.setattr(physics, "first_transitions", delayed)
    assert not any(physics.judged(n)[1] in GOOD for n in numbers)


# Friction is a hundred-thousandth of the spring forces, or K/k a millionth: what is rounding is not a fault.
@pytest.mark.parametrize("number", [327, 477, 1034, 2918, 3787])
def test_roundings_of_large_forces_are_not_taken_for_faults(number):
    assert physics.verdict(physics.trial(number)[1]) == "survived"


@pytest.mark.parametrize("kind", [kind.name for kind in damage.KINDS])
def test_a_damaged_file_is_refused_in_a_sentence_that_names_it(kind):
    outcome = damage.try_kind(kind, FEW)
    assert outcome.tried > 20
    assert not outcome.lost


def test_a_table_that_was_changed_by_hand_is_refused(tmp_path):
    write_table(slip_table(simulate(Chain.from_slider(), 1.0)), tmp_path / "slips.csv")
    (tmp_path / "slips.csv").write_text((tmp_path / "slips.csv").read_text().replace("28.0", "28.1"))
    with pytest.raises(ValueError, match="not what was written there"):
        read_table(tmp_path / "slips.csv")


def test_a_table_of_someone_else_has_no_checksum_and_is_read(tmp_path):
    (tmp_path / "mine.csv").write_text("a\n1\n")
    assert read_table(tmp_path / "mine.csv")["a"].tolist() == [1]


def test_the_checksum_beside_a_table_is_what_sha256sum_writes(tmp_path):
    write_table(pd.DataFrame({"a": [1.0]}), tmp_path / "a.csv")
    digest, name = (tmp_path / CHECKSUMS / "a.csv.sha256").read_text().split("  ")
    assert name == "a.csv\n"
    assert re.fullmatch("[0-9a-f]{64}", digest)
    assert open_checked(tmp_path / "a.csv").read() == b"a\n1.0\n"


def test_a_sealed_file_that_fails_half_way_leaves_the_old_one(tmp_path):
    path = tmp_path / "x.h5"
    path.write_bytes(b"old")

    def fail():
        with write_sealed(path, "precursors run 0") as memory:
            memory.write(b"new")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["x.h5"]


def test_a_certificate_that_does_not_decompress_is_refused(tmp_path):
    """zlib.error, which is neither a ValueError nor an OSError, came through."""
    (tmp_path / "c.json.gz").write_bytes(b"\x1f\x8b\x08\x00" + bytes(50))
    with pytest.raises(CertificateError, match=r"c\.json\.gz is not a whole certificate"):
        Certificate.load(tmp_path / "c.json.gz")


def test_a_certificate_of_json_inside_json_without_end_is_refused(tmp_path):
    (tmp_path / "c.json.gz").write_bytes(gzip.compress(b"[" * 100_000))
    with pytest.raises(CertificateError, match=r"c\.json\.gz is not a whole certificate"):
        Certificate.load(tmp_path / "c.json.gz")


@pytest.mark.parametrize("number", FEW_CONFIGURATIONS)
def test_a_hostile_configuration_is_refused_in_one_line_or_runs(number):
    assert configuration.verdict(configuration.configuration(number)) in GOOD


def test_a_configuration_that_holds_itself_is_refused():
    assert "without end" in refusal(yaml.safe_load("&a {chain: *a}"))


def test_a_number_of_a_thousand_digits_is_refused():
    assert "bits" in refusal(papers(duration=10**1000))


def test_loads_too_far_apart_for_a_quotient_are_refused():
    """The straight line through the load cells overflowed."""
    config = papers(load_cells={"spacing": 5e-324})
    assert "scenes.fig1" in refusal(config)


def test_a_key_of_two_lines_is_refused_in_one():
    assert "a b" in refusal(papers(**{"a\nb": 1}))


def test_a_name_without_end_is_shortened():
    assert len(refusal(papers(fig13=["x" * 100_000] * 3))) < 600


@pytest.mark.parametrize("absurd", [{"n_blocks": 1000, "duration": 1e6}, {"duration": 1e9}])
def test_a_scene_that_would_take_days_is_refused_with_what_to_do(absurd):
    config = papers()
    config["scenes"]["fig10"] |= absurd
    line = refusal(config)
    assert "scenes.fig10 would take about" in line
    assert "longest_run = 3600 s" in line


@pytest.mark.parametrize("blocks", [10**6, 10**18])
def test_a_chain_that_no_memory_holds_is_refused(blocks):
    config = papers()
    config["scenes"]["fig10"]["n_blocks"] = blocks
    assert f"n_blocks = {blocks}: allowed" in refusal(config)


def test_the_user_can_allow_a_long_scene():
    config = papers(longest_run=1e7)
    config["scenes"]["fig10"]["duration"] = 1e9
    check_config(config, configuration.SCHEMA)


def test_the_papers_scenes_are_expected_to_take_milliseconds():
    assert all(1e-4 < scene_seconds(papers(), name) < 0.1 for name in papers()["scenes"])


def test_the_table_counts_what_was_lost():
    outcome = Outcome("cut")
    for verdict in ("survived", "refused", "a wrong content was read"):
        outcome.count(verdict)
    assert re.search(r"cut +3 +1 +1 +1", table([outcome]))
    assert json.dumps(outcome.lost) == '["a wrong content was read"]'
