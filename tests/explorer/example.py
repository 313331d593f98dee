"""The page of the build, and its picture for README."""

import hashlib
import zlib

from browser import browser, find_browser
from places import ROOT

SOURCE = ROOT / "src/maegawa2010/explorer"
PAGE = ROOT / "results/explorer.html"
PICTURE = ROOT / "docs/explorer.png"
THETAS = {"fig10": 0.0, "fig11": -5 / 6, "fig12": 5 / 6}
TOLERANCE = 1e-9  # s, error of a time up to which a run counts as predictable
LAPTOP = (1280, 800)  # px
MARGIN = 8  # px, above the picture
END = 12  # bytes of the last chunk of a PNG
SETTLED = (
    "run && !state.playing && request.isShown && !request.next && run.isFinal"
    " && run.id === request.id && !dirty.size"
)


def drawn_from() -> str:
    """Digest of the sources of the page."""
    parts = sorted(
        path for kind in ("js", "css", "html") for path in SOURCE.glob(f"*.{kind}")
    )
    return hashlib.sha256(b"".join(file.read_bytes() for file in parts)).hexdigest()


def picture() -> bytes:
    """The row and the slips over time in the middle of the second step's precursor, as a
    PNG that contains the digest `drawn_from`."""
    path = find_browser()
    if path is None:
        raise FileNotFoundError("no Chromium or Chrome here")
    with browser(path) as page:
        page.open(PAGE.as_uri(), *LAPTOP)
        page.evaluate("goToStep(2), state.isToPlay = false, stop()")
        page.wait_for(SETTLED)
        middle = "0.6 * (event().end - event().onset)"
        page.evaluate(f"state.time = event().onset + {middle}, redraw()")
        page.wait_for(f"run.motions.has(state.event) && {SETTLED}")
        page.evaluate("document.querySelector('header').style.visibility = 'hidden'")
        page.evaluate("redraw()")
        page.settle()
        place = "element('{}').getBoundingClientRect().{}"
        top, right, bottom = (
            page.evaluate(place.format(*side))
            for side in (("row", "top"), ("row", "right"), ("slips", "bottom"))
        )
        height = bottom - top + MARGIN
        png = page.picture(x=0, y=top - MARGIN, width=right + 8, height=height, scale=1)
    chunk = b"tEXtSource\0" + drawn_from().encode()
    size, check = (n.to_bytes(4) for n in (len(chunk) - 4, zlib.crc32(chunk)))
    return png[:-END] + size + chunk + check + png[-END:]
