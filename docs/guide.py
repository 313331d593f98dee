"""All pages of docs/ on one page, for `make docs`."""

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
# Links to other pages become anchors, and links to files start from results/docs.
__doc__ = re.sub(r"\]\(\w+\.md#", "](#", text).replace("](../", "](../../")
