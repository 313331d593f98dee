"""Snakemake refuses a wrong configuration or directory in one line, and changes no
file."""

import sys

import pytest

from precursors import Run


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("mu_k: 0.45", "mu_k: 0.8", "configuration: chain: "),
        (
            "    title: uniform",
            "    titel: uniform",
            "config.yaml: scenes.fig10 has no key 'titel': did you mean 'title'?",
        ),
        (
            "figure: {}",
            "figure: {width_mm: 17}",
            "the width must be between 40 and 400 mm, but is 17",
        ),
        (
            "scenes:",
            "scenes:\n  speed: {title: a, theta: 0}",
            "scenes.speed has the name of a target or a figure",
        ),
        (
            "  mu_k: 0.45",
            "  mu_k: 0.45\n  mu_k: 0.46",
            "the key 'mu_k' is repeated in line 9, column 3",
        ),
    ],
)
def test_a_wrong_configuration_is_refused_in_one_line(finished, old, new, words):
    finished.edit("config.yaml", old, new)
    before = finished.results()
    outcome = finished.run("-c1", "all")
    assert outcome.code != 0
    assert "Traceback" not in outcome.text
    assert len([line for line in outcome.text.splitlines() if words in line]) == 1, (
        outcome.text
    )
    assert finished.results() == before


def test_paths_with_spaces_and_loads_beside_the_config_work(workspace, monkeypatch):
    """Values of the command line apply, too."""
    place = workspace.path / "Büro Müller"
    place.mkdir()
    python = place / "python"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n', encoding="utf-8")
    python.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(python))
    mine = "scenes: {mine: {title: a, weights: loads.csv}}\nchain: {mu_k: 0.4}\n"
    (place / "mine.yaml").write_text(mine, encoding="utf-8")
    configured = ("--configfile", "Büro Müller/mine.yaml", "--config", "duration=0.1")
    command = ("-c1", *configured, "--", "results/runs/mine.h5")
    refusal = workspace.run(*command).text
    assert "Büro Müller/loads.csv: No such file" in refusal
    (place / "loads.csv").write_text("20\n30\n", encoding="utf-8")
    outcome = workspace.run(*command)
    assert outcome.code == 0, outcome.text
    run = Run.load(workspace.path / command[-1])
    assert run.chain.weights.tolist() == [20, 30]
    assert (run.duration, run.chain.mu_k) == (0.1, 0.4)


def test_a_wrong_file_of_the_command_line_is_named(workspace):
    (workspace.path / "mine.yaml").write_text(
        "duration: 3\nduration: 4\n", encoding="utf-8"
    )
    outcome = workspace.run("-n", "--configfile", "mine.yaml")
    assert outcome.code != 0
    assert "mine.yaml: the key 'duration' is repeated" in outcome.text


def test_a_file_in_place_of_the_results_directory_is_refused(workspace):
    (workspace.path / "results").write_text("mine", encoding="utf-8")
    outcome = workspace.run("-c1", "all")
    assert outcome.code != 0
    assert "results must be a directory that can be written to" in outcome.text
    assert (workspace.path / "results").read_text(encoding="utf-8") == "mine"
