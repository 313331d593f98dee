"""What the name of a column says: which quantity, and in which unit."""

import re
import unicodedata
from collections.abc import Mapping, Sequence
from typing import NamedTuple

TIME = "t [s]"
LOAD = "F_X [N]"
LENGTH = "L_p/L [-]"
NORMAL_LOAD = "w [N]"
PROFILE = "p [any unit]"
# How `--columns` calls them.
SYMBOLS = {"t": TIME, "F_X": LOAD, "L_p": LENGTH, "w": NORMAL_LOAD, "p": PROFILE}

# Names without what separates words, in lower case but for single letters: first those
# of one quantity, then those that the first are chosen before.
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
_NEWTONS = {
    1.0: "N newton newtons Н",
    1e3: "kN кН",
    1e-3: "mN мН",
    1e-6: "uN μN",
}
# What one of a unit is in the unit of the quantity.
UNITS = {
    TIME: {
        1.0: "s sec secs second seconds sek sekunde sekunden seconde secondes segundo segundos "
        "secondo secondi с сек 秒",
        1e-3: "ms msec msecs millisecond milliseconds millisekunden мс",
        1e-6: "us μs usec microseconds мкс",
        60.0: "min mins minute minutes minuten minuto minutos minuti мин 分",
    },
    LOAD: _NEWTONS,
    LENGTH: {1.0: "1 -", 0.01: "%"},
    NORMAL_LOAD: _NEWTONS,
    PROFILE: {1.0: "Pa hPa kPa MPa bar mbar psi N/mm² N/mm2 N kN mN"},
}
METRES = {1.0: "m", 0.01: "cm", 1e-3: "mm", 1e-6: "um μm"}
IN_BRACKETS = re.compile(
    r"(.*?)[\s_./,-]*[\[({]\s*(?:in\s+)?([^\[\](){}]*?)\.?\s*[\])}]"
)
AT_THE_END = re.compile(r"(.+?)(?:[\s_./,-]+in)?[\s_./,-]+([^\W\d_]+|%)\.?")
# What a unit alone tells: words and a last number. x1e3 or ^2 would change the value.
WORDS = re.compile(r"[^\W\d_]+(?:[\s_-]+[^\W\d_]+)*[\s_-]*\d{0,2}")
# Another force, or not the force itself.
OTHER = re.compile(
    r"normal|нормал|vert|垂直|法向|(?<![a-z])(f[ _]?[nyz]|df)(?![a-z])|(?<![a-z_])x(?![a-z])"
    r"|x[ _-]*\d|std|dev|err|offset|delta|diff|m[ai][xn]|mean|mittel|limit|target|soll",
    re.IGNORECASE,
)


class Name(NamedTuple):
    """The name of a column, in parts."""

    words: str
    unit: str | None
    in_brackets: bool


def parts_of(name: str) -> Name:
    """A name and its unit, in brackets or a known one at the end."""
    name = unicodedata.normalize("NFKC", name).strip(" :=,;")
    if found := IN_BRACKETS.fullmatch(name):
        return Name(found[1], found[2], in_brackets=True)
    found = AT_THE_END.fullmatch(name)
    if found and _key(name) not in KNOWN_NAMES and _spelling(found[2]) in KNOWN_UNITS:
        return Name(found[1], found[2], in_brackets=False)
    return Name(name, None, in_brackets=False)


def factor(name: Name, kind: str, length: float | None = None) -> float | None:
    """What one of a column's unit is in that of a kind; None if it is no unit of it.
    The `length` [m] of the slider turns front lengths into shares."""
    if name.unit is None:
        return None if kind == LENGTH and "/" not in name.words else 1.0
    units = _spelled(UNITS[kind])
    if kind == LENGTH and length:
        units |= {unit: metres / length for unit, metres in _spelled(METRES).items()}
    return units.get(_spelling(name.unit))


def rank(text: str, kind: str, length: float | None = None) -> int | None:
    """How well a name says a kind of column: 0 best, None not at all; as the number of
    its `NAMES`, if they and the unit do not say the same."""
    name = parts_of(text)
    has_unit = factor(name, kind, length) is not None
    by_unit = len(NAMES[kind])
    key = _key(name.words)
    for place, names in enumerate(NAMES[kind]):
        if key in names.split():
            return place if has_unit or kind == PROFILE else by_unit
    is_plain = WORDS.fullmatch(name.words) and not OTHER.search(name.words)
    if has_unit and name.in_brackets and is_plain and key not in KNOWN_NAMES:
        return by_unit
    return None


def _key(words: str) -> str:
    """Words as in `NAMES`."""
    joined = re.sub(r"(?<=\w)[\s_.-]+(?=\w)", "", words.strip())
    return joined if len(joined) == 1 else joined.casefold()


def _spelling(unit: str) -> str:
    """A unit in lower case, but mega, which would be milli then."""
    return unit if unit[:2] in ("MN", "Mn") else unit.casefold()


def _spelled(units: Mapping[float, str]) -> dict[str, float]:
    """The value of each spelling of a unit."""
    return {
        _spelling(unicodedata.normalize("NFKC", unit)): value
        for value, spellings in units.items()
        for unit in spellings.split()
    }


KNOWN_NAMES = {name for ranks in NAMES.values() for name in " ".join(ranks).split()}
KNOWN_UNITS = {unit for units in (*UNITS.values(), METRES) for unit in _spelled(units)}


class Wanted(NamedTuple):
    """Columns that are needed; `choice` has names of some by their `SYMBOLS`, or numbers
    where a table has no names."""

    kinds: Sequence[str]
    choice: Mapping[str, str] = {}
    length: float | None = None

    def places(self, names: Sequence[str]) -> list[int]:
        """Where they are among the columns of a table; a ValueError says what is not
        known."""
        return [self._place(names, kind) for kind in self.kinds]

    def _place(self, names: Sequence[str], kind: str) -> int:
        symbol = next(key for key, value in SYMBOLS.items() if value == kind)
        if chosen := self.choice.get(symbol):
            called = names if any(names) else [str(i + 1) for i in range(len(names))]
            found = [i for i, name in enumerate(called) if name == chosen]
        elif not any(names):
            found = [0] if len(names) == len(self.kinds) == 1 else []
        else:
            ranks = [rank(name, kind, self.length) for name in names]
            best = min((r for r in ranks if r is not None), default=None)
            found = [i for i, r in enumerate(ranks) if r == best is not None]
        if len(found) == 1:
            return found[0]
        told = ", ".join(repr(names[i]) for i in found or range(len(names)) if names[i])
        problem = f"no column is known as {kind} among {told}"
        if not told:
            problem = f"no column has a name, and {kind} is needed"
        elif found:
            problem = f"{told} may each be {kind}"
        how = "NAME" if told else "NUMBER"
        raise ValueError(f'{problem}: choose one with --columns "{symbol}={how}"')
