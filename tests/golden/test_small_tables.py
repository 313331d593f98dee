"""The library gives the small tables kept here; failures and models are compared beside
their tests."""

import pytest
from golden.small_tables import TABLES, assert_kept


@pytest.mark.parametrize("name", TABLES)
def test_a_small_table_is_the_one_that_is_kept(name):
    assert_kept(name, TABLES[name]())
