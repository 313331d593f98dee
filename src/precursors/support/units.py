"""What the name of a column says: which quantity, and in which unit."""

import re
import unicodedata
from collections.abc import Mapping, Sequence

TIME = "t [s]"
LOAD = "F_X [N]"
LENGTH = "L_p/L [-]"
NORMAL_LOAD = "w [N]"
PROFILE = "p [any unit]"


def spelling(unit: str) -> str:
    """A unit in lower case, but mega, which would be milli then."""
    return unit if unit[:2] in ("MN", "Mn") else unit.casefold()


def _values(units: Mapping[float, str]) -> dict[str, float]:
    """What one of each spelling of a unit is."""
    return {
        spelling(name): value
        for value, names in units.items()
        for name in names.split()
    }


# Without what separates words, in lower case but for single letters: first names of one
# quantity, then those before which the first are chosen.
_LOADS = (
    "F force load kraft last charge fuerza forza carga carico сила нагрузка 荷重 力"
)
_NORMAL = "w W fn fz normalforce normalload forcenormale fuerzanormal normalkraft"
NAMES = {
    TIME: (
        "t time timestamp zeit zeitstempel temps tiempo tempo время 時間 时间 xvalue onset",
    ),
    LOAD: (
        "fx ft frictionforce tangentialforce tangentialload shearforce loadbefore reibkraft "
        "reibungskraft tangentialkraft forcetangentielle",
        _LOADS,
    ),
    LENGTH: ("lp/l", "lp propagationlength frontlength length länge longueur"),
    NORMAL_LOAD: (_NORMAL, _LOADS),
    PROFILE: (
        "p pressure contactpressure druck pression presión pressione",
        f"{_NORMAL} {_LOADS}",
    ),
}
KNOWN_NAMES = {name for ranks in NAMES.values() for name in " ".join(ranks).split()}
# How well a name says a quantity, after its places in `NAMES`: by its unit alone, or with
# another unit; not at all.
HALF = 2
NOT = 3

NEWTONS = _values(
    {1.0: "N newton newtons Н", 1e3: "kN кН", 1e-3: "mN мН", 1e-6: "uN μN"}
)
METRES = _values({1.0: "m", 0.01: "cm", 1e-3: "mm", 1e-6: "um μm"})
UNITS = {
    TIME: _values(
        {
            1.0: "s sec secs second seconds sek sekunde sekunden seconde secondes segundo "
            "segundos secondo secondi с сек 秒",
            1e-3: "ms msec msecs millisecond milliseconds millisekunden мс",
            1e-6: "us μs usec microseconds мкс",
            60.0: "min mins minute minutes minuten minuto minutos minuti мин 分",
        }
    ),
    LOAD: NEWTONS,
    LENGTH: _values({1.0: "1 -", 0.01: "%"}),
    NORMAL_LOAD: NEWTONS,
    PROFILE: _values({1.0: "Pa hPa kPa MPa bar mbar psi N/mm2 N kN mN"}),
}
KNOWN_UNITS = set(METRES).union(*UNITS.values())
BRACKETS = "[({})] "
IN_BRACKETS = re.compile(
    r"(.*?)[\s_./,-]*[\[({]\s*(?:in\s+)?([^\[\](){}]*?)\.?\s*[\])}]"
)
AT_THE_END = re.compile(r"(.+?)(?:[\s_./,-]+in)?[\s_./,-]+([^\W\d_]+|%)\.?")
# Where a unit alone says what a column is: words and a last number, as x1e3 or ^2 would
# change the value; not of another force, or of less than the force itself.
WORDS = re.compile(r"[^\W\d_]+(?:[\s_-]+[^\W\d_]+)*[\s_-]*\d{0,2}")
OTHER = re.compile(
    r"normal|нормал|vert|垂直|法向|(?<![a-z])(f[ _]?[nyz]|df)(?![a-z])|(?<![a-z_])x(?![a-z])"
    r"|x[ _-]*\d|std|dev|err|offset|delta|diff|m[ai][xn]|mean|mittel|limit|target|soll",
    re.IGNORECASE,
)


def parts_of(name: str) -> tuple[str, str]:
    """Words of a name, and its unit: in brackets, or a known one after a known name."""
    name = unicodedata.normalize("NFKC", name).strip(" :=,;")
    found = IN_BRACKETS.fullmatch(name)
    if not found and _key(name) not in KNOWN_NAMES:
        at_end = AT_THE_END.fullmatch(name)
        if at_end and _key(at_end[1]) in KNOWN_NAMES and is_unit(at_end[2]):
            found = at_end
    words, unit = found.groups() if found else (name, "")
    return words, spelling(unit)


def meaning(
    name: str, kind: str, length: float | None = None
) -> tuple[int, float | None]:
    """How well a name says a kind of column, the smaller the better, and what one of its
    unit is in that of the kind; None if it is no unit of it. The `length` [m] of the
    slider turns front lengths into shares."""
    words, unit = parts_of(name)
    units = UNITS[kind]
    scale = units.get(unit)
    if kind == PROFILE or (not unit and (kind != LENGTH or "/" in words)):
        scale = 1.0
    elif kind == LENGTH and length and unit in METRES:
        scale = METRES[unit] / length
    key = _key(words)
    for rank, names in enumerate(NAMES[kind]):
        if key in names.split():
            return HALF if scale is None else rank, scale
    is_plain = WORDS.fullmatch(words) and not OTHER.search(words)
    is_by_unit = unit in units and is_plain and key not in KNOWN_NAMES
    return HALF if is_by_unit else NOT, scale


def places(
    kinds: Sequence[str],
    choice: Mapping[str, str] | None,
    length: float | None,
    names: Sequence[str],
) -> list[int]:
    """Where columns of these kinds are in a table. `choice` has names of some by their
    symbols, or numbers of those without a name.

    Raises
    ------
    ValueError
        If one is not known, or several may be it.
    """
    called = [name or str(i) for i, name in enumerate(names, 1)]
    found = []
    for kind in kinds:
        symbol = kind.split()[0]
        if chosen := (choice or {}).get(symbol):
            ranks = [0 if name == chosen else NOT for name in called]
        elif len(kinds) == 1 and called == ["1"]:
            ranks = [0]
        else:
            ranks = [meaning(name, kind, length)[0] for name in names]
        best = [i for i, rank in enumerate(ranks) if rank == min(ranks)]
        if min(ranks) == NOT or len(best) > 1:
            number = "none" if min(ranks) == NOT else "each"
            told = ", ".join(repr(called[i]) for i in best)
            raise ValueError(
                f"{number} of {told} is known as {kind}: choose one with --columns "
                f'"{symbol}=NAME"'
            )
        found += best
    return found


def is_unit(text: str) -> bool:
    """Whether a text is a known unit, or one in brackets."""
    return spelling(text.strip(BRACKETS)) in KNOWN_UNITS


def _key(words: str) -> str:
    """Words as in `NAMES`."""
    joined = re.sub(r"(?<=\w)[\s_.-]+(?=\w)", "", words.strip())
    return joined if len(joined) == 1 else joined.casefold()
