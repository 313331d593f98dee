"""The text of a PDF, page by page."""

import re
from io import BytesIO

from pypdf import PdfReader
from pypdf.generic import DecodedStreamObject, NameObject

# Text is between BT and ET; to parse the rest, such as the lines of figures, would take
# seconds.
TEXT = re.compile(rb"\bBT\b.*?\bET\b", re.DOTALL)


def pages_of(pdf: bytes) -> list[str]:
    """Text of each page on one line, without the text of its figures."""
    texts = []
    for page in PdfReader(BytesIO(pdf)).pages:
        content = DecodedStreamObject()
        content.set_data(b"\n".join(TEXT.findall(page.get_contents().get_data())))
        page[NameObject("/Contents")] = content
        page["/Resources"].pop("/XObject", None)
        texts.append(" ".join(page.extract_text().split()))
    return texts
