"""The jobs that run: at first all, and after an edit those that depend on it."""

import re
from collections import Counter
from itertools import product

import pytest
from places import ROOT

PAPERS = {"simulate_scene fig10", "simulate_scene fig11", "simulate_scene fig12"}
# Rules that `all` does not need, and write_provenance, which `Outcome.jobs` leaves out.
ON_DEMAND = {"certify_scene", "prove_again", "write_provenance"}
# The paper depends on nearly all tables and figures.
PAPER = {"write_paper"}
LISTS_OF_SCENES = {"mu_sapp", "judge_claims"} | PAPER
CODE = "\nADDED = 1\n"  # appended to a module


def scene(name: str, line: str) -> str:
    return f'  {name}:\n    title: nearly all at the leading edge\n    theta: "9/10"\n    {line}\n'


def test_a_dry_run_lists_the_papers_jobs_and_writes_nothing(untouched):
    workspace, outcome = untouched
    assert outcome.code == 0, outcome.text
    assert outcome.jobs >= PAPERS
    assert not ON_DEMAND & outcome.jobs
    assert workspace.results() == {}


def test_the_arrows_in_readme_are_those_of_the_rule_graph(untouched):
    workspace, _ = untouched
    graph = workspace.run("--rulegraph", "mermaid-js", "all").text
    rules = dict(re.findall(r"(id\d+)\[(\w+)\]", graph))
    real = {
        (rules[start], rules[end])
        for start, end in re.findall(r"(id\d+) --> (id\d+)", graph)
    }
    (shown,) = re.findall(
        r"```mermaid\n(.*?)```", (ROOT / "README.md").read_text(), re.S
    )
    arrows = {
        arrow
        for starts, ends in re.findall(r" +(.+) --> (.+)", shown)
        for arrow in product(starts.split(" & "), ends.split(" & "))
    }
    assert len(arrows) > 10
    assert arrows - real == set()


def test_comments_format_and_touch_run_nothing_again(finished):
    before = finished.results()
    for file in [
        *finished.path.glob("src/**/*.py"),
        *finished.path.glob("workflow/**/*.py"),
    ]:
        text = file.read_text(encoding="utf-8").replace('"""', '"""Other words. ', 1)
        file.write_text(f"{text}\n\n# more words\n", encoding="utf-8")
    finished.edit("config.yaml", "", "# more words\n")
    outcome = finished.run("-c2", "all")
    assert outcome.code == 0
    assert "Nothing to be done" in outcome.text
    assert finished.results() == before


def test_results_that_were_deleted_are_made_again(finished):
    kinds = ("runs/*", "ensembles/*/*", "certificates/*/*")
    files = [file for kind in kinds for file in finished.path.glob(f"results/{kind}")]
    for file in files:
        file.unlink()
    made = finished.run("-n", "all").made
    assert {str(file.relative_to(finished.path)) for file in files} <= made


@pytest.mark.parametrize(
    ("module", "run", "left"),
    [
        (
            "precursors/figures/scene",
            {"draw_scene fig10"},
            {"tabulate", "simulate", "draw_horizon", "fig13"},
        ),
        (
            "maegawa2010/methods/moreau_jean",
            {"tabulate_work_precision", "draw_work_precision"},
            {"take", "run_", "simulate"},
        ),
        ("precursors/solver/kernel/events", PAPERS | {"run_noise"}, set()),
    ],
)
def test_an_edit_of_a_module_runs_only_jobs_that_import_it(finished, module, run, left):
    finished.edit(f"src/{module}.py", "", CODE)
    jobs = finished.would_run()
    assert run <= jobs
    assert not [job for job in jobs if job.startswith(tuple(left))]


@pytest.mark.parametrize(
    ("old", "new", "jobs"),
    [
        (
            "figure: {}",
            "figure: {width_mm: 85, font_size: 9}",
            {"draw_scene fig10", "draw_scene fig11", "draw_scene fig12"}
            | {"draw_scene steep", "fig13", "draw_slips"},
        ),
        (
            'theta: "9/10"',
            'theta: "8/10"',
            {"simulate_scene steep", "draw_scene steep"} | LISTS_OF_SCENES,
        ),
    ],
)
def test_an_edit_of_paper_or_configuration_runs_what_reads_it(finished, old, new, jobs):
    finished.edit("paper/paper.typ", "", "\n// edited\n")
    finished.edit("config.yaml", old, new)
    assert finished.would_run() == jobs | PAPER


def test_four_lines_make_a_new_scene_of_any_name(finished):
    finished.add_scenes(
        scene("fig10_slips", "duration: 1.0")
    )  # a name like that of a table
    new = {"simulate_scene fig10_slips", "draw_scene fig10_slips"}
    assert finished.would_run() == new | LISTS_OF_SCENES


def test_larger_studies_are_an_overlay_of_the_configuration(finished):
    outcome = finished.run(
        "-n", "--configfile", "config.yaml", "workflow/full.yaml", "--", "all"
    )
    assert outcome.code == 0, outcome.text
    longer = {"tabulate_speed", "tabulate_long_balance", "run_resolution"}
    assert longer <= outcome.jobs
    # Only `article` writes to paper/tables.
    assert not {"simulate_scene fig10", "mu_sapp", "publish"} & outcome.jobs


def test_without_the_papers_scenes_there_is_no_paper(
    workspace,
):
    workspace.edit("config.yaml", "  fig12:\n    title", "  mine:\n    title")
    workspace.edit(
        "config.yaml", "fig13: [fig11, fig10, fig12]", "fig13: [fig11, fig10, mine]"
    )
    jobs = workspace.would_run()
    assert "mu_sapp" in jobs
    assert not {"judge_claims", "write_paper"} & jobs


def test_an_interrupted_study_continues_and_an_edit_reruns_it(
    finished,
):
    digits = "digits_members"
    noise = "noise_members"
    tables = [f"results/tables/{study}.csv" for study in (digits, noise)]
    next((finished.path / "results/ensembles" / digits).iterdir()).unlink()
    (finished.path / tables[0]).unlink()
    for study, old, new, expected in (
        ("noise", "seed: 2010", "seed: 2011", {digits: 1, noise: 2}),
        ("printed_digits", "draws: 400", "draws: 300", {digits: 2, noise: 2}),
    ):
        finished.edit(f"workflow/studies/{study}/settings.yaml", old, new)
        made = finished.run("-n", *tables).made
        assert (
            Counter(name.split("/")[2] for name in made if "/ensembles/" in name)
            == expected
        )
