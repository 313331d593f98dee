"""The pages of docs/ as one, for `make docs`."""

import re
from pathlib import Path

PAGES = (
    "customise",
    "recipes",
    "numbers",
    "proof",
    "adding",
    "models",
    "benchmark",
    "performance",
    "reliability",
    "troubleshooting",
)
__all__: list[str] = []

text = "\n\n".join(
    Path(__file__).with_name(f"{page}.md").read_text(encoding="utf-8") for page in PAGES
)
# A link to another page stays in this one, and a link to a file begins in results/docs.
__doc__ = re.sub(r"\]\(\w+\.md#", "](#", text).replace("](../", "](../../")
