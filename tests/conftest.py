"""Property tests: the same examples on every run; others, and more, with --hypothesis-profile=explore."""

from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, database=None, deadline=None, max_examples=200)
settings.register_profile("explore", deadline=None, max_examples=20_000)
settings.load_profile("repeatable")
