"""Proved transitions, the growth of errors, and the predictability time. Claims,
`work_precision` and the page rest on it."""
