"""The mission in boxes: what each file of rules makes, and which files need it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from html import escape

from precursors.figures import style

WIDTH, HEIGHT, GAP_X, GAP_Y = 116, 46, 22, 10  # of a box, and between boxes [px]
START = "configuration"

Edge = tuple[str, str]


def draw(boxes: Mapping[str, str], edges: Collection[Edge]) -> str:
    """Draw boxes from left to right as SVG.

    Parameters
    ----------
    boxes : mapping
        What is made, by the name of the file of rules that makes it.
    edges : collection of (str, str)
        A file, and one that needs what it makes; without circles.
    """
    starts = [(START, name) for name in boxes if not any(after == name for _, after in edges)]
    drawn = direct([*edges, *starts])
    place = {
        name: (column * (WIDTH + GAP_X), row * (HEIGHT + GAP_Y))
        for name, (column, row) in places([START, *boxes], drawn).items()
    }
    width, height = (
        max(side) + box for side, box in zip(zip(*place.values(), strict=True), (WIDTH, HEIGHT), strict=True)
    )
    texts = {START: "config.yaml", **boxes}
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-2 -2 {width + 4} {height + 4}" '
            f'style="width:100%;max-width:{width + 4}px" '
            'font-family="sans-serif" font-size="12" text-anchor="middle">',
            '<marker id="tip" orient="auto" markerWidth="8" markerHeight="8" refX="7" refY="4">'
            f'<path d="M0 0 8 4 0 8z" fill="{style.GREY}"/></marker>',
            *(_arrow(*place[before], *place[after]) for before, after in drawn),
            *(_box(name, text, *place[name]) for name, text in texts.items()),
            "</svg>\n",
        ]
    )


def direct(edges: Collection[Edge]) -> list[Edge]:
    """Edges that no longer way replaces, each once."""

    def leads(start: str, end: str) -> bool:
        return any(before == start and (after == end or leads(after, end)) for before, after in edges)

    return [
        (start, end)
        for start, end in dict.fromkeys(edges)
        if not any(before == start and after != end and leads(after, end) for before, after in edges)
    ]


def places(names: Collection[str], edges: Collection[Edge]) -> dict[str, tuple[int, float]]:
    """Column and row of each name: right of what it needs, and in the middle of its neighbours."""

    def column(name: str) -> int:
        return max((1 + column(before) for before, after in edges if after == name), default=0)

    columns = {name: column(name) for name in names}
    widest = max(columns.values(), key=list(columns.values()).count)
    rows = {name: float(row) for row, name in enumerate(name for name in names if columns[name] == widest)}
    for name in sorted(names, key=columns.__getitem__):
        near = [rows[before] for before, after in edges if after == name and before in rows]
        near = near or [rows[after] for before, after in edges if before == name and after in rows]
        rows.setdefault(name, sum(near) / len(near))
    return {name: (columns[name], rows[name]) for name in names}


def _arrow(x1: float, y1: float, x2: float, y2: float) -> str:
    start, end, middle = x1 + WIDTH, x2, x2 - GAP_X / 2
    y1, y2 = y1 + HEIGHT / 2, y2 + HEIGHT / 2
    path = f"M{start:g} {y1:g}H{middle - GAP_X / 2:g}C{middle:g} {y1:g} {middle:g} {y2:g} {end:g} {y2:g}"
    return f'<path d="{path}" fill="none" stroke="{style.GREY}" marker-end="url(#tip)"/>'


def _box(name: str, text: str, x: float, y: float) -> str:
    x_text, look = x + WIDTH / 2, f'fill="#fff" stroke="{style.BLUE}"'
    return (
        f'<rect x="{x:g}" y="{y:g}" width="{WIDTH}" height="{HEIGHT}" rx="6" {look}/>'
        f'<text x="{x_text:g}" y="{y + 19:g}" font-weight="bold" fill="#000">{escape(name)}</text>'
        f'<text x="{x_text:g}" y="{y + 36:g}" fill="#000">{escape(text)}</text>'
    )
