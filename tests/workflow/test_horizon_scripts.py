"""The scripts of the horizon: proofs are taken over only where they fit, and tables say what they should."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pandas as pd
import prove_again
import pytest
import tabulate_certificates
import tabulate_horizon
import tabulate_lyapunov
import take_certificates

from precursors.accuracy.proof import Certificate, CertificateError, ExactChain, certify

CHAIN = ExactChain.from_slider(n_blocks=2, theta="1/2", drive_velocity="1e-3")
DURATION = 0.5


@pytest.fixture(scope="module")
def committed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("committed") / "pair.json.gz"
    certify(CHAIN, DURATION).save(path)
    return path


def test_a_fitting_certificate_is_taken_over(committed: Path, tmp_path: Path) -> None:
    output = tmp_path / "pair.json.gz"
    take_certificates.main([committed], [CHAIN.as_text()], [DURATION], [output])
    assert output.read_bytes() == committed.read_bytes()


@pytest.mark.parametrize(
    ("chain", "duration"),
    [(CHAIN, 0.3), (dataclasses.replace(CHAIN, mu_k="0.4"), DURATION)],
    ids=["duration", "chain"],
)
def test_another_chain_or_duration_is_proved(
    committed: Path, tmp_path: Path, chain: ExactChain, duration: float
) -> None:
    output = tmp_path / "other.json.gz"
    take_certificates.main([committed], [chain.as_text()], [duration], [output])
    certificate = Certificate.load(output)
    assert (certificate.chain, float(certificate.duration)) == (chain, duration)


def test_a_certificate_is_proved_again_and_an_altered_one_refused(committed: Path, tmp_path: Path) -> None:
    prove_again.main(committed, tmp_path / "pair.csv")
    row = pd.read_csv(tmp_path / "pair.csv").iloc[0]
    certificate = Certificate.load(committed)
    assert (row["chain"], row["transitions"]) == ("pair", len(certificate.transitions))
    last = certificate.transitions[-1]
    wrong = last._replace(time=last.time._replace(midpoint=last.time.midpoint + last.time.radius * 3))
    altered = dataclasses.replace(certificate, transitions=(*certificate.transitions[:-1], wrong))
    altered.save(tmp_path / "altered.json.gz")
    with pytest.raises(CertificateError, match="its time is not proved"):
        prove_again.main(tmp_path / "altered.json.gz", tmp_path / "altered.csv")
    assert not (tmp_path / "altered.csv").exists()


def test_the_tables_hold_what_is_proved_and_what_the_solver_gets_right(
    committed: Path, tmp_path: Path
) -> None:
    effort, output = tmp_path / "effort.csv", tmp_path / "certificates.csv"
    effort.write_text("chain,transitions,cpu_s\nelse,1,1.0\n")
    tabulate_certificates.main({"pair": committed}, effort, output)
    row = pd.read_csv(output).iloc[0]
    certificate = Certificate.load(committed)
    assert row["transitions"] == len(certificate.transitions)
    assert row["largest_time_width_s"] == float(2 * certificate.widest[0])
    # The time of another proof is not taken for that of this one.
    assert pd.isna(row["cpu_s"])

    tabulate_horizon.main({"pair": committed}, 1e-9, tmp_path / "horizon.csv", tmp_path / "solver.csv")
    facts = pd.read_csv(tmp_path / "solver.csv").iloc[0]
    assert facts["agreeing_transitions"] == facts["transitions"] == len(certificate.transitions)
    assert facts["horizon_s"] == facts["right_until_s"] == facts["duration_s"] == DURATION
    errors = pd.read_csv(tmp_path / "horizon.csv")
    assert errors["actual_error_s"].iloc[-1] == facts["time_error_while_agreeing_s"]


def test_a_scene_without_an_exponent_has_an_empty_row(tmp_path: Path) -> None:
    sliders = {"alone": {"theta": 0.0, "n_blocks": 1, "drive_velocity": 0.02}}
    sliders["ten"] = {"theta": 0.5, "drive_velocity": 0.002}
    tabulate_lyapunov.main(sliders, 2.0, tmp_path / "lyapunov.csv")
    table = pd.read_csv(tmp_path / "lyapunov.csv").set_index("scene")
    assert table["theta"].to_dict() == {"alone": 0.0, "ten": 0.5}
    assert table.loc["alone"].drop("theta").isna().all()
    assert table.loc["ten"].notna().all()
    assert table.loc["ten", "uncertainty_per_s"] > 0
