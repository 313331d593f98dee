"""The report shows every figure and table of the workflow, in a browser and without a network."""

import json
import re
import shutil
from collections import Counter

import pytest
from browser import browser, find_browser
from conftest import ROOT, Workspace

from precursors.figures.table_page import table_page

CATEGORIES = {
    "Reproduction",
    "Speed and accuracy",
    "Proof and horizon",
    "Sensitivity",
    "Models",
    "Tables",
}
FIGURES = ["results/figures/fig09.svg", "results/figures/fig10.svg"]
TABLE, PAGE = "results/tables/fig10_slips.csv", "results/pages/fig10_slips.html"
# Versions of the JavaScript inside Snakemake's report, of no consequence to a reader.
KNOWN_COMPLAINTS = (
    "cdn.tailwindcss.com should not be used in production",
    "The input spec uses Vega-Lite v3",
)

ROWS = "[...document.querySelectorAll('nav tbody tr')]"


def results_in(report):
    """What the report holds, by path."""
    text = report.read_text(encoding="utf-8")
    (found,) = re.findall(r"^    var results = (\{.*\});$", text, flags=re.MULTILINE)
    return json.loads(found)


def write_report(workspace, *targets):
    outcome = workspace.run("--report", "report.html", *targets)
    assert outcome.code == 0, outcome.text
    return workspace.path / "report.html"


@pytest.fixture(scope="module")
def whole(_finished, tmp_path_factory):
    """A copy of the workflow with stand-ins for all results, and the report on them."""
    workspace = Workspace(tmp_path_factory.mktemp("whole") / "copy")
    shutil.copytree(_finished.path, workspace.path)
    for page in re.findall(r"output: (results/pages/\S+)", workspace.run("-n", "table_pages").text):
        (workspace.path / page).parent.mkdir(exist_ok=True)
        (workspace.path / page).write_text("a table", encoding="utf-8")
    return workspace.path, write_report(workspace, "all", "table_pages")


def test_every_figure_and_every_table_of_the_workflow_is_in_the_report(whole):
    path, report = whole
    results = results_in(report)
    figures = {file.relative_to(path).as_posix() for file in path.glob("results/figures/*.svg")}
    pages = {file.relative_to(path).as_posix() for file in path.glob("results/pages/*.html")}
    assert len(figures) > 20
    assert len(pages) > 15
    assert set(results) == figures | pages
    snakefile = (path / "Snakefile").read_text(encoding="utf-8")
    asked = {
        name
        for names in re.findall(r"table=\[(.*?)\]", snakefile, flags=re.DOTALL)
        for name in re.findall(r'"(\w+)"', names)
    }
    assert asked
    assert {f"results/pages/{name}.html" for name in asked} <= pages


def test_everything_in_the_report_has_a_caption_a_category_and_a_label_of_its_own(whole):
    _, report = whole
    results = results_in(report)
    for path, result in results.items():
        words = re.sub("<[^>]+>", " ", result["caption"]).split()
        assert len(words) >= 10, path
        assert "{{" not in result["caption"], path
        # A second label with two values would be taken for a switch, and Snakemake's page would stay white.
        assert len(result["labels"]) == 1, path
    labels = Counter(tuple(result["labels"].items()) for result in results.values())
    assert max(labels.values()) == 1


def test_the_categories_of_the_report_are_few(whole):
    (found,) = re.findall(
        r"^    var categories = (\{.*\});$", whole[1].read_text("utf-8"), flags=re.MULTILINE
    )
    assert set(json.loads(found)) == CATEGORIES


@pytest.fixture(scope="module")
def open_page():
    path = find_browser()
    if path is None:
        pytest.skip("no Chromium here")
    with browser(path) as opened:
        yield opened


@pytest.fixture
def page(open_page, finished):
    """The report on two figures and a table that `make results` has made."""
    for name in (*FIGURES, TABLE):
        shutil.copy(ROOT / name, finished.path / name)
    outcome = finished.run("-c1", PAGE)
    assert outcome.code == 0, outcome.text
    assert outcome.jobs == {"write_table_page"}
    page = open_page()
    page.open(write_report(finished, *FIGURES, PAGE).as_uri())
    return page


def menu(page, name):
    """Click on an entry of the menu, from the first page."""
    page.evaluate("app.setView({navbarMode: 'menu', content: 'metadata'})")
    page.settle()
    page.evaluate(f"[...document.querySelectorAll('nav li a')].find(a => a.innerText === {name!r}).click()")
    page.settle()


def button(page, row, number):
    page.evaluate(f"{ROWS}[{row}].querySelectorAll('a')[{number}].click()")
    page.settle()


def test_the_report_is_clicked_through_in_a_browser_and_shows_everything(page):
    assert page.evaluate("[...document.querySelectorAll('nav li a span')].map(a => a.innerText)") == [
        "Workflow",
        "Statistics",
        "About",
        "Reproduction",
        "Tables",
    ]
    assert "reproduced" in page.evaluate("workflow_desc")

    menu(page, "Reproduction")
    assert page.evaluate(f"{ROWS}.length") == 2
    sizes = set()
    for row, name in enumerate(["fig09", "fig10"]):
        assert name in page.evaluate(f"{ROWS}[{row}].innerText")
        button(page, row, 0)
        page.wait_for("document.querySelector('.p-3 > img').complete")
        image = "document.querySelector('.p-3 > img')"
        width, height, shown = page.evaluate(
            f"[{image}.naturalWidth, {image}.naturalHeight, {image}.getBoundingClientRect().width]"
        )
        assert min(width, height, shown) > 100
        sizes.add((width, height))
        assert colours(page, image) > 10
        button(page, row, 1)
        assert "draw_" in page.evaluate("document.querySelector('nav').innerText")
        menu(page, "Reproduction")
    assert len(sizes) == 2

    menu(page, "Tables")
    assert page.evaluate(f"{ROWS}.length") == 1
    button(page, 0, 0)
    page.wait_for("document.querySelector('iframe')")
    assert "<th>load_before_N</th>" in page.evaluate(
        "atob(document.querySelector('iframe').src.split(',')[1])"
    )

    menu(page, "Statistics")
    page.wait_for("document.querySelector('#runtimes canvas, #runtimes svg')")
    assert "simulate_scene" in page.evaluate("JSON.stringify(runtimes_spec)")
    menu(page, "Workflow")
    page.wait_for("document.querySelector('#brand').parentElement.nextElementSibling")

    assert [request for request in page.requests if not request.startswith("file:")] == []
    assert [c for c in page.complaints if not any(known in c for known in KNOWN_COMPLAINTS)] == []


def colours(page, image):
    """Number of colours that a picture has when it is drawn."""
    return page.evaluate(
        f"(picture => {{ const c = document.createElement('canvas').getContext('2d');"
        "c.canvas.width = 300; c.canvas.height = 200; c.drawImage(picture, 0, 0, 300, 200);"
        "const d = new Uint32Array(c.getImageData(0, 0, 300, 200).data.buffer);"
        f"return new Set(d).size; }})({image})"
    )


def test_a_table_in_the_report_keeps_every_digit_and_sorts_by_a_click(open_page, tmp_path):
    page = open_page()
    text = "scene,load_N\nb,0.1234567890123\na <i>,12\nc,3.5\n"
    (tmp_path / "table.html").write_text(table_page("loads", text), encoding="utf-8")
    page.open((tmp_path / "table.html").as_uri())
    cells = "[...document.querySelectorAll('tbody tr')].map(row => row.innerText.split('\\t'))"
    assert page.evaluate(cells) == [["b", "0.123457"], ["a <i>", "12"], ["c", "3.5"]]
    page.evaluate("document.querySelectorAll('th')[1].click()")
    assert [row[0] for row in page.evaluate(cells)] == ["b", "c", "a <i>"]
    page.evaluate("document.querySelectorAll('th')[1].click()")
    assert [row[0] for row in page.evaluate(cells)] == ["a <i>", "c", "b"]
    assert page.evaluate("atob(document.querySelector('a').href.split(',')[1])") == text
    assert page.complaints == []


@pytest.mark.parametrize("text", ["", "a,b\n1\n"])
def test_a_broken_table_makes_no_page(text):
    with pytest.raises(ValueError, match="loads: "):
        table_page("loads", text)
