"""Certificates belong to the configured chains, and the Lyapunov exponent is that of the
linearised motion."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import scipy
from chains import SLIDER
from places import CERTIFICATES
from settings import CONFIG

from maegawa2010.studies.horizon import figure, lyapunov
from maegawa2010.studies.horizon.chains import (
    chain_duration,
    exact_chain,
    is_about,
    scene_exact_chain,
)
from maegawa2010.studies.horizon.lyapunov import lyapunov_exponent, lyapunov_table
from maegawa2010.studies.horizon.tables import proof_tables
from precursors import simulate
from precursors.proof import Certificate, ExactChain, certify

CHAINS = CONFIG["horizon"]["proved"]
# Largest size of a committed certificate [bytes].
LARGEST_FILE = 300_000
# Exponents of the linearised motion of the scenes [1/s].
LINEARISED = {"-5/6": 1.657, "0": 2.164, "5/6": 1.909}


@pytest.fixture
def exponent_of(monkeypatch):
    """A function that computes the exponent of made-up events from the numbers of their
    first transitions, their growth, and the times of transitions."""

    def exponent(onset, growth, time):
        monkeypatch.setattr(lyapunov, "_growth", lambda _: (time[onset], growth))
        return lyapunov_exponent(None)

    return exponent


@pytest.mark.parametrize("theta", LINEARISED)
def test_the_exponents_are_those_of_the_linearised_motion(theta):
    exponent = lyapunov_exponent(simulate(SLIDER(theta=theta), 100.0))
    # Beyond the predictability time the run depends on rounding, and so does its mean.
    assert exponent["exponent_per_s"] == pytest.approx(
        LINEARISED[theta], abs=exponent["uncertainty_per_s"]
    )
    assert exponent["uncertainty_per_s"] < exponent["exponent_per_s"]


def test_the_exponent_scales_with_time_and_not_with_distance(monkeypatch):
    """With four times the mass and half the drive velocity the motion is the same, but
    twice as slow."""
    chain = SLIDER(theta="5/6", drive_velocity=1e-3)
    slow = replace(chain, mass=4 * chain.mass, drive_velocity=chain.drive_velocity / 2)
    run = simulate(chain, 2.0)
    one = lyapunov_exponent(run)
    other = lyapunov_exponent(simulate(slow, 4.0))
    assert other["exponent_per_s"] == pytest.approx(
        one["exponent_per_s"] / 2, rel=1e-12
    )
    monkeypatch.setattr(lyapunov, "DISTANCE", 100 * lyapunov.DISTANCE)
    assert lyapunov_exponent(run)["exponent_per_s"] == pytest.approx(
        one["exponent_per_s"], rel=1e-3
    )


@pytest.mark.parametrize(("n", "used"), [(21, 20), (40, 20), (41, 40), (400, 380)])
def test_the_uncertainty_is_that_of_the_mean_of_20_stretches(n, used, exponent_of):
    """Events last 0.3 s and have 7 transitions each; the first tenth is left out."""
    n_all = n + round(n * lyapunov.TRANSIENT / (1 - lyapunov.TRANSIENT))
    growth = np.cumsum(np.random.default_rng(n).normal(0.5, 1.0, n_all))
    exponent = exponent_of(7 * np.arange(n_all), growth, 0.3 / 7 * np.arange(7 * n_all))
    means = np.diff(growth[n_all - 1 - used :: used // 20]) / (used // 20)
    low, high = scipy.stats.t.interval(0.95, 19, means.mean(), scipy.stats.sem(means))
    assert exponent["events"] == used
    assert exponent["exponent_per_s"] == pytest.approx(means.mean() / 0.3)
    assert exponent["uncertainty_per_s"] == pytest.approx((high - low) / 0.6)


def test_a_run_of_one_block_or_of_few_events_has_no_exponent(exponent_of):
    with pytest.raises(ValueError, match="all differences die out"):
        lyapunov_exponent(simulate(SLIDER(1, drive_velocity=0.02), 5.0))
    with pytest.raises(
        ValueError, match="more than 20 slip events after its transient, but has 20"
    ):
        exponent_of(np.arange(22), np.arange(22.0), np.arange(22.0))


def test_the_tables_compare_the_solver_with_the_proof():
    chain = ExactChain.from_slider(n_blocks=2, theta="1/2", drive_velocity="1e-3")
    certificate = certify(chain, 0.5)
    n = len(certificate.transitions)
    tables = proof_tables({"pair": certificate}, 1e-9)
    row = tables["certificates"].iloc[0]
    facts = tables["solver_vs_proof"].iloc[0]
    width = float(2 * max(t.time.radius for t in certificate.transitions))
    assert (row["transitions"], row["largest_time_width_s"]) == (n, width)
    assert facts["agreeing_transitions"] == facts["transitions"] == n
    until = facts[["horizon_s", "right_until_s", "duration_s"]]
    assert until.tolist() == [0.5] * 3
    last = tables["horizon"]["actual_error_s"].iloc[-1]
    assert last == facts["time_error_while_agreeing_s"]


def test_a_scene_without_an_exponent_has_an_empty_row():
    sliders = {"alone": {"theta": 0.0, "n_blocks": 1, "drive_velocity": 0.02}}
    sliders["ten"] = {"theta": 0.5, "drive_velocity": 0.002}
    table = lyapunov_table(sliders, 2.0).set_index("scene")
    assert table.loc["alone"].drop("theta").isna().all()
    assert table.loc["ten"].notna().all()


def predicted_errors():
    errors = {"time_s": [0.05, 0.1, 0.15], "predicted_error_s": [1e-16, 1e-12, np.nan]}
    errors |= {"actual_error_s": [1e-17, 1e-13, 1e-10]}
    thetas = {"trailing": -5 / 6, "steep": 0.9}
    tables = [pd.DataFrame(errors).assign(chain=name) for name in thetas]
    return figure.draw(pd.concat(tables), thetas, 1e-9)


PICTURES = {"horizon": predicted_errors}


@pytest.mark.parametrize("name", CHAINS)
def test_committed_certificates_belong_to_the_configured_chains(
    name,
):
    certificate = Certificate.load(CERTIFICATES / f"{name}.json.gz")
    chain = exact_chain(name, CHAINS[name])
    duration = chain_duration(CHAINS[name])
    assert is_about(certificate, chain, duration)
    assert not is_about(certificate, chain, 2 * duration)
    assert not is_about(certificate, replace(chain, mu_k=0), duration)
    assert (CERTIFICATES / f"{name}.json.gz").stat().st_size < LARGEST_FILE


def test_theta_of_a_scene_is_not_rounded():
    config = {
        "chain": {"n_blocks": 10, "normal_load": 400.0, "length": 0.1},
        "load_cells": {"spacing": 0.06},
        "scenes": {
            "cells": {"load_cell_a": 100.0, "load_cell_b": 300.0},
            "fraction": {"theta": "5/6"},
        },
    }
    for name in config["scenes"]:
        assert scene_exact_chain(config, name) == ExactChain.from_slider(theta="5/6")


def test_a_scene_with_measured_loads_is_not_proved():
    config = {"chain": {}, "scenes": {"measured": {"weights": [30.0, 40.0, 50.0]}}}
    with pytest.raises(
        ValueError, match=r"^scenes\.measured must have .* has weights$"
    ):
        scene_exact_chain(config, "measured")
