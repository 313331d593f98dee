"""A browser for the tests of the explorer, and the page of the build."""

import pytest
from browser import browser, find_browser
from explorer.example import PAGE


@pytest.fixture(scope="session")
def file():
    return PAGE


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
