"""A browser for the tests of the explorer, and a page with the paper's scenes."""

import pytest
from browser import browser, find_browser
from explorer.example import write_example


@pytest.fixture(scope="session")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("explorer") / "explorer.html"
    write_example(path)
    return path


@pytest.fixture(scope="session")
def page():
    path = find_browser()
    if path is None:
        pytest.skip(
            "no Chromium or Chrome here: the explorer is not tried in a browser"
        )
    with browser(path) as page:
        page.open("about:blank")
        yield page
