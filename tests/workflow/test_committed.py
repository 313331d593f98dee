"""Committed tables in a build: checked before they are shown, and made by one target."""

import pandas as pd

TABLE = "paper/tables/balance_loads.csv"
FULL = ("--configfile", "config.yaml", "workflow/full.yaml", "--")


def test_a_build_names_a_committed_row_that_was_changed_by_hand(workspace):
    table = pd.read_csv(workspace.path / TABLE)
    table.loc[3, "first_events"] += 1
    table.to_csv(workspace.path / TABLE, index=False)
    outcome = workspace.run("-c1", "results/tables/balance_loads.csv")
    assert outcome.code != 0
    line = "balance_loads.csv, line 5, load = even, n_blocks = 160: first_events is"
    assert line in outcome.text
    assert not (workspace.path / "results/tables/balance_loads.csv").exists()


def test_a_fresh_clone_plans_no_long_study(untouched):
    _, outcome = untouched
    assert {"check_balance", "check_resolution", "check_speed"} <= outcome.jobs
    long = {"tabulate_long_balance", "run_resolution", "tabulate_speed", "publish"}
    assert not long & outcome.jobs


def test_the_article_makes_every_committed_table(workspace):
    outcome = workspace.run("-n", *FULL, "article")
    assert outcome.code == 0, outcome.text
    tables = {path.name for path in workspace.path.glob("paper/tables/*")}
    assert tables == {path.split("/")[-1] for path in outcome.made if "paper/" in path}
    (published,) = [job for job, made in outcome.plan if f"{TABLE}" in made]
    assert published == "publish"


def test_settings_of_ones_own_are_run_without_the_article(workspace):
    workspace.edit("config.yaml", "", "\nresolution: {seed: 1}\n")
    outcome = workspace.run("-n", "all")
    assert outcome.code == 0, outcome.text
    assert "run_resolution" in outcome.jobs
    assert not {"check_resolution", "check_balance", "write_paper"} & outcome.jobs
