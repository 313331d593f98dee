# ruff: noqa: E501
"""The modules that a script uses are what Python's parser finds that it imports, and no others."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from conftest import ROOT

from precursors.support.imports import Import, files_used, imports, uses_of

LIBRARY = ROOT / "src/precursors"
SCRIPTS = ROOT / "workflow/scripts"
SOURCES = sorted([*LIBRARY.rglob("*.py"), *SCRIPTS.glob("*.py")])
COMMON = (ROOT / "workflow/rules/common.smk").read_text(encoding="utf-8")
ASIDE: dict[str, list[str]] = ast.literal_eval(re.search(r"^ASIDE = (\{.*?^\})", COMMON, re.M | re.S)[1])
SOLVER = {"chain.py", "compile_cache.py", "exact.py", "kernel", "run.py", "storage.py"}


def parsed(text: str) -> set[Import]:
    """The imports from the library, but those for type checkers, as Python's parser finds them."""
    tree = ast.parse(text)
    for_types = {
        inner
        for node in tree.body
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    found = set()
    for node in ast.walk(tree):
        if node in for_types:
            continue
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports are not followed"
            if (node.module or "").split(".")[0] == "precursors":
                found |= {Import(node.module or "", name.name) for name in node.names}
        elif isinstance(node, ast.Import):
            found |= {Import(name.name, "") for name in node.names if name.name.split(".")[0] == "precursors"}
    return found


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_the_imports_read_are_those_that_the_parser_finds(path):
    text = path.read_text(encoding="utf-8")
    assert set(imports(text)) == parsed(text)


@pytest.mark.parametrize(
    "text",
    [
        "from precursors.model.chain import (\n    Chain,  # with a remark, and a comma\n    whole as w,\n)\n",
        "def f():\n    from precursors import kernel, lanes\n",
        "import precursors.solver.simulate\nimport precursorsless\nfrom precursors2 import x\n",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from precursors.solver.run import Run\n\nA = 1\n",
        "if not TYPE_CHECKING:\n    from precursors.solver.run import Run\n",
        "TEXT = 'from precursors.solver.run import Run'\n",
    ],
)
def test_imports_of_every_form_are_read(text):
    assert set(imports(text)) == parsed(text)


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """A package with two in it: one hands names on, the other imports its modules by computed names."""
    files = {
        "__init__.py": "",
        "a.py": "",
        "b.py": "from precursors.hands import Name\n",
        "c.py": "from precursors import by_name\n",
        "d.py": "def f():\n    from precursors import b\n",
        "e.py": "from precursors.hands import TABLE\n",
        "hands/__init__.py": (
            "from precursors.hands.one import Name\nfrom precursors.hands.two import X\nTABLE = 1\n"
        ),
        "hands/one.py": "from precursors import a\n",
        "hands/two.py": "",
        "by_name/__init__.py": "import importlib\nM = importlib.import_module('precursors.by_name.x')\n",
        "by_name/x.py": "",
        "by_name/y.py": "",
    }
    for name, text in files.items():
        path = tmp_path / "precursors" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path / "precursors"


@pytest.mark.parametrize(
    ("line", "used"),
    [
        ("from precursors.hands import Name", "a hands/__init__ hands/one"),
        ("from precursors.hands import two", "hands/two"),
        ("from precursors.hands.two import X", "hands/two"),
        ("from precursors.hands import TABLE", "a hands/__init__ hands/one hands/two"),
        ("import precursors.e", "a e hands/__init__ hands/one hands/two"),
        ("from precursors import d", "a b d hands/__init__ hands/one"),
        ("from precursors import c", "by_name/__init__ by_name/x by_name/y c"),
        ("import json", ""),
    ],
)
def test_a_name_leads_to_the_module_that_it_comes_from_and_to_no_other(library, tmp_path, line, used):
    (tmp_path / "script.py").write_text(f"{line}\n", encoding="utf-8")
    expected = [f"{module}.py" for module in used.split()]
    assert files_used(tmp_path / "script.py", library) == expected


def test_an_import_that_does_not_count_is_not_followed_from_where_it_stands(library, tmp_path):
    script = tmp_path / "script.py"
    script.write_text("from precursors import b, d\n", encoding="utf-8")
    assert "a.py" in files_used(script, library, {"hands/two": ["a"]})
    assert files_used(script, library, {"hands/one": ["a"]}) == [
        "b.py",
        "d.py",
        "hands/__init__.py",
        "hands/one.py",
    ]
    assert files_used(script, library, {"scripts/script": ["b", "d"]}) == []


def test_what_the_workflow_leaves_aside_is_imported_there():
    for module, left_out in ASIDE.items():
        path = (
            SCRIPTS / f"{Path(module).name}.py" if module.startswith("scripts/") else LIBRARY / f"{module}.py"
        )
        assert set(left_out) <= {use.module for use in uses_of(path, LIBRARY)}, module


@pytest.mark.parametrize("name", [path.stem for path in sorted(SCRIPTS.glob("*.py"))])
def test_only_scripts_that_draw_use_figures(name):
    used = set(files_used(SCRIPTS / f"{name}.py", LIBRARY, ASIDE))
    drawn = {file for file in used if file.startswith("figures/")}
    assert not drawn or name.startswith("draw_") or name == "write_explorer"


def test_a_scene_is_simulated_again_for_the_solver_and_nothing_else():
    used = set(files_used(SCRIPTS / "simulate_scene.py", LIBRARY, ASIDE))
    assert {re.sub(r"^kernel/.*", "kernel", file) for file in used} == SOLVER
