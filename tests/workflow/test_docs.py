"""The examples in docs/ work: their code runs in a copy of the repository."""

import ast
import os
import re
import shlex
import shutil
import subprocess
import sys
from textwrap import dedent

import pytest
import write_paper
from colours import SIGHTS, alike
from pdf_text import pages_of
from places import GOLDEN, RESULTS, ROOT, made
from workflow_copy import copy_workflow

from maegawa2010.paper.documents import cited_results
from precursors import cli

DOCS = ROOT / "docs"
RECIPES = DOCS / "recipes.md"
EXAMPLES = sorted(DOCS.glob("examples/*.py"))
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", flags=re.MULTILINE | re.DOTALL)


def blocks(section):
    """Language, file name (or None) and text of each block of a section of adding.md."""
    text = (DOCS / "adding.md").read_text(encoding="utf-8")
    (body,) = [
        part for part in text.split("\n## ")[1:] if part.startswith(f"{section}\n")
    ]
    for language, code in BLOCK.findall(body):
        named = re.match(r"# ([\w./]+\.\w+|Snakefile|\w+/Snakefile)\n", code)
        yield language, named and named[1], code[named.end() :] if named else code


CLAIM = "A claim, and a number in the article"
SECTIONS = (
    "A scene",
    "A study",
    "A model",
    "A method",
    CLAIM,
)


@pytest.fixture(scope="module")
def documented(tmp_path_factory):
    """A copy of the workflow with the new files and changes of all sections."""
    workspace = copy_workflow(tmp_path_factory.mktemp("documented") / "copy")
    for language, name, code in (
        block for section in SECTIONS for block in blocks(section)
    ):
        if name and language == "diff":
            lines = code.splitlines(keepends=True)
            old, new = (
                "".join(line[1:] for line in lines if line[0] in signs)
                for signs in (" -", " +")
            )
            # A reader may have applied it to this repository.
            if new not in (workspace.path / name).read_text(encoding="utf-8"):
                workspace.edit(name, old, new)
        elif name:
            (workspace.path / name).parent.mkdir(parents=True, exist_ok=True)
            (workspace.path / name).write_text(code, encoding="utf-8")
    return workspace


def command(section):
    (words,) = [
        code.split() for language, _, code in blocks(section) if language == "sh"
    ]
    return words[1:]


def test_the_example_scene_and_study_are_built(documented):
    planned = documented.run("-n", *command("A scene"))
    assert planned.jobs == {"simulate_scene steep", "draw_scene steep"}, planned.text
    assert "tabulate_durations" in documented.would_run()
    (documented.path / "results/tables").mkdir(parents=True)
    slips = ROOT / "tests/golden/fig10_slips.csv"
    shutil.copy(slips, documented.path / "results/tables")
    outcome = documented.run(*command("A study"))
    assert outcome.code == 0, outcome.text
    assert (documented.path / "results/tables/durations.csv").is_file()


def test_a_study_is_removed_by_the_commands_shown(workspace):
    (commands,) = [code for _, _, code in blocks("Removing a study")]
    shutil.copytree(
        ROOT / "tests/studies",
        workspace.path / "tests/studies",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    subprocess.run("sh", input=commands, text=True, cwd=workspace.path)
    assert list(workspace.path.rglob("*step_sweep*")) == []
    jobs = workspace.would_run()
    assert "write_paper" in jobs
    assert "tabulate_step_sweep" not in jobs


# Run the test of the example study and compare the example model with the chain. Draw a
# chart with the example method, and print its number of points, the colour of its line,
# and the colours of other methods.
MORE = """
from runpy import run_path
run_path("tests/studies/durations/test_durations.py")["test_short_slips_are_left_out"]()
from maegawa2010.studies.models.answers import MODELS
from maegawa2010.studies.models.stepwise import stepwise_answers
from maegawa2010.studies.models.tables import compare_models
models = {"stepwise": stepwise_answers, "chain": MODELS["chain"]}
assert compare_models({"uniform": {"theta": 0}}, models, rounds=1)["is_answer"].all()
from matplotlib.colors import to_hex
from precursors import Chain, simulate
from precursors.benchmark.compare import Truth
from maegawa2010.studies.work_precision.tables import charted_values, measure_methods
from maegawa2010.studies.work_precision import figure as speed
from maegawa2010.methods import ROWS

chain = Chain.from_slider(drive_velocity=0.01)
truth = Truth.exact(chain, 0.01, simulate(chain, 0.01).transitions.tolist())
table = measure_methods(truth, 0.01, {"scipy_rk23": charted_values(False)["scipy_rk23"]}, 1)
lines = [line for axes in speed.draw(table).axes for line in axes.lines if line.get_marker() != "None"]
print(len(table), *{to_hex(line.get_color()).upper() for line in lines})
print(*(row["color"] for name, row in ROWS.items() if name != "scipy_rk23"))
"""


def test_the_example_model_and_method_run(documented):
    done = subprocess.run(
        [sys.executable, "-c", MORE],
        cwd=documented.path,
        env=os.environ | {"PYTHONPATH": str(documented.path / "src")},
        capture_output=True,
        text=True,
        check=True,
    )
    line, others = done.stdout.splitlines()
    points, color = line.split()
    assert int(points) == 2
    for sight in SIGHTS:
        assert alike({name: name for name in {color, *others.split()}}, sight) == []
    assert done.stderr == ""


def test_the_example_claim_is_evaluated_and_set_in_the_paper(
    documented, tmp_path, monkeypatch
):
    texts = {language: code for language, name, code in blocks(CLAIM) if not name}
    checked = subprocess.run(
        [
            sys.executable,
            "workflow/scripts/check_claims.py",
            RESULTS,
            GOLDEN / "claims.csv",
        ],
        cwd=documented.path,
        env=os.environ | {"PYTHONPATH": str(documented.path / "src")},
        capture_output=True,
        text=True,
    )
    assert (checked.returncode, checked.stderr) == (1, texts["text"])
    source = documented.path / "paper/mine.typ"
    source.write_text(f'#import "lib.typ": *\n{texts["typst"]}', encoding="utf-8")
    monkeypatch.chdir(ROOT)
    write_paper.main(source, cited_results(source), tmp_path / "mine.pdf")
    (load,) = made("reproduction").query(
        "scene == 'fig10' and quantity == 'global_slip_load_N'"
    )["reproduced"]
    (page,) = pages_of((tmp_path / "mine.pdf").read_bytes())
    assert page.startswith(f"At {load:.1f} N")


def test_the_example_workflow_uses_this_one_as_a_module(workspace):
    example = workspace.path / "docs/examples/module.smk"
    example.parent.mkdir(parents=True)
    shutil.copy(DOCS / "examples" / example.name, example)
    (elsewhere := workspace.path / "elsewhere").mkdir()
    outcome = workspace.run(*command("Within another workflow"))
    assert outcome.code == 0, outcome.text
    assert "precursors_simulate_scene soft" in outcome.jobs
    assert float(
        (elsewhere / "first_slip.txt").read_text().split(",")[0]
    ) == pytest.approx(2.8)


def test_the_examples_of_the_page_on_changes_work(workspace, monkeypatch, capsys):
    examples: dict[str, list[str]] = {}
    for language, code in BLOCK.findall(
        (DOCS / "customise.md").read_text(encoding="utf-8")
    ):
        examples.setdefault(language, []).append(code)
    monkeypatch.chdir(workspace.path)
    (workspace.path / "mine.yaml").write_text(examples["yaml"][0], encoding="utf-8")
    for table in examples["csv"]:
        (workspace.path / table.split()[1]).write_text(table, encoding="utf-8")
    for line in "".join(examples["sh"]).splitlines():
        program, *arguments = shlex.split(line, comments=True)
        if program == "precursors":
            assert cli.main(arguments) == cli.DONE
            assert (workspace.path / arguments[-1]).stat().st_size > 0
        else:
            outcome = workspace.run("-n", *arguments)
            assert outcome.code == 0, outcome.text
    capsys.readouterr()
    code, shown = (text for _, text in BLOCK.findall(RECIPES.read_text("utf-8")))
    exec(code, {})
    assert capsys.readouterr().out == shown


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_prints_what_it_says(script, tmp_path, monkeypatch, capsys):
    source = script.read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    exec(compile(source, script, "exec"), {})
    _, output = ast.get_docstring(ast.parse(source)).split("Prints:\n")
    assert dedent(capsys.readouterr().out).rstrip() == dedent(output)
    assert script.name in RECIPES.read_text(encoding="utf-8")
    for path in re.findall(r'savefig\("(.+?)"', source):
        assert (tmp_path / path).stat().st_size > 10_000


def test_every_page_is_rendered_with_title_and_working_links(tmp_path):
    from pdoc import pdoc, render  # slow

    render.configure(docformat="numpy")
    pdoc(DOCS / "guide.py", output_directory=tmp_path)
    guide = (tmp_path / "guide.html").read_text(encoding="utf-8")
    titles = [
        page.read_text(encoding="utf-8").splitlines()[0].removeprefix("# ")
        for page in DOCS.glob("*.md")
    ]
    assert [title for title in titles if f">{title}</h1>" not in guide] == []
    linked = re.findall(r'href="#([^"]+)"', guide)
    assert [anchor for anchor in linked if f'id="{anchor}"' not in guide] == []


PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_that_a_page_links_to_exist(page):
    links = re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8"))
    here = [
        link
        for link in links
        if "://" not in link and not link.startswith("../../actions")
    ]
    assert [link for link in here if not (page.parent / link).exists()] == []
