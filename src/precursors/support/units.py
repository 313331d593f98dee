"""Columns of measured tables: words that name them, and units that are read."""

import re
import unicodedata
from collections.abc import Sequence

# The columns,
TIME = "t [s]"
LOAD = "F_X [N]"
LENGTH = "L_p/L [-]"
NORMAL_LOAD = "normal load of each block [N]"
# their own names and words for them,
_LOADS = r"f|load|force|fuerza|forza|last|[^\W\d_]*kraft|сила|нагрузка|荷重"
WORDS = {
    TIME: (
        "t|x_value",
        "time(?:stamp)?|zeit(?:stempel)?|temps|tiempo|tempo|время|時間",
    ),
    LOAD: ("f_?x|tangential[a-z]*|friction(?! coef)", _LOADS),
    LENGTH: ("l_?p", "l|length|länge|longueur"),
    NORMAL_LOAD: ("w", _LOADS),
}
# words for other columns, which are not taken for them by their order,
OTHERS = (
    "samples?|index|n[or]|number|points?|displacement|distance|position|weg|course|変位"
    "|pressure|druck|pression|cof|coefficient|reibwert"
)
# and how many of the unit above their units are.
_NEWTONS = {"[NН]|(?i:newtons?)": 1.0, "(?i:kN|кН)": 1e3, "mN|мН": 1e-3, "[uμ]N": 1e-6}
UNITS = {
    TIME: {
        r"(?i:[sс秒]|secs?|seconds?|sek(?:unden?)?|secondes?|seg(?:undos?)?|second[io]|сек)": 1.0,
        r"(?i:ms|msecs?|milliseconds?|millisekunden?|мс)": 1e-3,
        r"(?i:[uμ]s|usecs?|microseconds?|мкс)": 1e-6,
        r"(?i:mins?|minut[eo]s?|minuten|minuti|мин|分)": 60.0,
    },
    LOAD: _NEWTONS,
    LENGTH: {"1|-": 1.0, "%": 0.01},
    NORMAL_LOAD: _NEWTONS,
}
BRACKET = re.compile(r"[\[({]\s*(?:in\s+(?=\w))?([^\])}]*?)\.?\s*[\])}]")
# Units without a bracket, in any case but for single letters: known ones, ...
_KNOWN = "|".join([*UNITS[TIME], *_NEWTONS])
_OTHER = (
    "MN|daN|kgf?|gf|tf|grams?|lbs?|k?lbf|kips?|oz|dyn|Nm|[hkM]?Pa|psi|m?bar|[uμm]V|volts?"
    "|[cmuμ]m|ns|hrs?|hours?|days?|кгс?"
)
BARE = re.compile(
    r"(?:^|[\s_,./:=|-]|(?<=[a-z])(?=[A-Z]|[kmu]N))"
    rf"([NНsсhm%秒分]|N/\w+|10\^\S+(?: \w+)?|(?=[^\W\d_]{{2}})(?i:{_KNOWN}|{_OTHER}))"
    r"(?=$|[\s_,:;]|\.(?!\w))"
    # letters after a comma (Load_A and Load A are names), and what is not Latin there.
    r"|(?:^|[,/]|\s(?=g))\s*([gAV])$|[,/]\s*(\S*[^\x00-\xff]\S*|[^\x00-\x7f]+)$"
)


def has_word(name: str, words: str) -> bool:
    """Whether a name has one of these words."""
    return bool(re.search(rf"(?i)(?<![^\W\d_])({words})(?![^\W\d_])", name))


def units(name: str) -> list[str]:
    """Whatever stands as a unit in a name: in brackets, or else a known unit."""
    name = unicodedata.normalize("NFKC", name)
    bare = ["".join(filter(None, found)) for found in BARE.findall(name)]
    return list(filter(None, BRACKET.findall(name))) or bare


def factors(name: str, kind: str) -> set[float]:
    """How many of the unit of a column the units in a name are."""
    return {
        factor
        for unit in units(name)
        for pattern, factor in UNITS[kind].items()
        if re.fullmatch(pattern, unit)
    }


def candidates(names: Sequence[str], kind: str) -> list[int]:
    """Which names may be those of a column: by its unit, its own name, a word for
    it."""
    places: list[int] = []
    for fit in (
        [i for i, name in enumerate(names) if factors(name, kind)],
        *(
            [i for i, name in enumerate(names) if has_word(name, words)]
            for words in WORDS[kind]
        ),
    ):
        places = [i for i in places or fit if i in fit] or places
    return places


def is_named(names: Sequence[str]) -> bool:
    """Whether a line names any column by a word."""
    words = "|".join(sum(WORDS.values(), ()))
    return any(has_word(BRACKET.sub("", name), words) for name in names)
