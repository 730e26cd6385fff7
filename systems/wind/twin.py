"""Twins: the GLSL of winds, found beside their classes and put together for a program."""

import re
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from itertools import accumulate, chain
from pathlib import Path

import numpy as np

from ...components.wind import TwinValues, WindPrimitive
from ...engine.gl.shaders import Line

PLACE = "systems/wind/twins.glsl"
"""The file that the twins of a program stand in for."""

MOST_NUMBERS, MOST_SHEETS, MOST_SIDE = 64, 4, 2048
"""How many numbers and sheets a twin may read, and how many texels a side of a sheet may have."""

TOLD, ANY = -1, -2
"""In place of a twin's number: a wind without one; a run of winds of any."""

MOST_RUNS = 12
"""How many runs a program may have: drivers take long over large ones."""

LARGEST = 1e30
"""No number may be this large: single precision ends there."""

_TYPE = r"(?:float|int|uint|bool|[biu]?vec[234]|mat[234]|void|struct)"
_FUNCTION = re.compile(rf"^{_TYPE}\s+(\w+)\s*[({{]")
_CONSTANTS = re.compile(rf"^const\s+{_TYPE}\s+(.*)")
_CONSTANT = re.compile(r"(\w+)\s*(?:\[[^\]]*\]\s*)?=(?!=)")
_MACRO = re.compile(r"^\s*#\s*define\s+(\w+)")
_NUMBER, _SHEET = (re.compile(rf"\b{name}\s*\(\s*wind\s*,\s*(\d+)\b") for name in ("value", "(?:sheet|smooth_noise)"))


class TwinError(Exception):
    """A twin cannot be used; the message says why."""


@dataclass(frozen=True, slots=True)
class Twin:
    """The GLSL of a wind: `float mask(vec2 place, Wind wind)` and `vec2 action(vec2 place, Wind wind)`."""

    file: str
    """What messages call it: the module that it stands beside, and its name."""

    text: tuple[str, ...]
    """Its lines."""

    numbers: int
    """How many numbers it reads, as far as its text tells."""

    sheets: int
    """How many sheets it reads, as far as its text tells."""

    @classmethod
    def of(cls, file: str, text: Sequence[str]) -> "Twin":
        """Return the twin of a file with these lines."""
        return cls(file, tuple(text), _most(_NUMBER, text), _most(_SHEET, text))

    @property
    def names(self) -> list[str]:
        """The functions, records and constants that it defines at its top level, each once."""
        found = [match[1] for line in self.text if (match := _FUNCTION.match(line))]
        constants = (_CONSTANT.findall(match[1]) for line in self.text if (match := _CONSTANTS.match(line)))
        return list(dict.fromkeys([*found, *chain.from_iterable(constants)]))


@lru_cache(maxsize=256)
def twin_of(primitive: type[WindPrimitive], /) -> Twin | None:
    """Return the twin of a class of winds, None where it has none; raises TwinError where its file is missing.

    A class that says `mask` or `action` anew has no part in the twin of those that it derives from.
    """
    order = primitive.__mro__
    owner = next(each for each in order if "twin" in vars(each))
    anew = [each for each in order[: order.index(owner)] if {"mask", "action"} & vars(each).keys()]
    name = vars(owner)["twin"]
    if name is None or anew:
        return None
    source = _beside(owner.__module__, name)
    if source is None or not source.is_file():
        raise TwinError(f"there is no file '{name}' beside its module {owner.__module__}")
    return Twin.of(f"{owner.__module__}/{name}", source.read_text("utf-8").splitlines())


def check_values(twin: Twin, values: TwinValues, /) -> None:
    """Raise TwinError unless these are what a twin can read."""
    numbers, sheets = values.numbers, values.sheets
    if not twin.numbers <= len(numbers) <= MOST_NUMBERS:
        due = f"{twin.numbers} are read" if len(numbers) < twin.numbers else f"{MOST_NUMBERS} is the most"
        raise TwinError(f"twin_values returned {len(numbers)} numbers where {due}")
    if not all(-LARGEST < number < LARGEST for number in numbers):
        raise TwinError("twin_values returned numbers that are not finite")
    if not twin.sheets <= len(sheets) <= MOST_SHEETS:
        due = f"{twin.sheets} are read" if len(sheets) < twin.sheets else f"{MOST_SHEETS} is the most"
        raise TwinError(f"twin_values returned {len(sheets)} sheets where {due}")
    for sheet in sheets:
        if sheet.dtype != np.float32 or sheet.ndim != 3 or not 1 <= sheet.shape[2] <= 4:
            found = f"{sheet.dtype} of shape {sheet.shape}"
            raise TwinError(f"twin_values returned a sheet of {found}, not float32 of (rows, columns, 1 to 4)")
        if not 1 <= min(sheet.shape[:2]) <= max(sheet.shape[:2]) <= MOST_SIDE:
            raise TwinError(f"twin_values returned a sheet of shape {sheet.shape}; {MOST_SIDE} is the longest side")


def joined_twins(twins: Sequence[Twin], order: Sequence[int], /) -> dict[str, list[Line]]:
    """Return the lines that stand in for `PLACE`: winds go by runs, each of one twin's number.

    `TOLD` stands for those without one, `ANY` for all. Runs of one twin are loops without a choice, because a software
    rasteriser goes through every branch of it. What a twin defines has a name of its own here, and no two can clash.
    """
    lines: list[Line] = []
    for number in range(len(twins)) if ANY in order else sorted(set(order) - {TOLD}):
        twin = twins[number]
        lines += _head(f"#define {name} {name}_{number}" for name in twin.names)
        lines += [(twin.file, at, text) for at, text in enumerate(twin.text, 1)]
        macros = (_MACRO.match(text) for text in twin.text)
        lines += _head(f"#undef {name}" for name in [*twin.names, *(macro[1] for macro in macros if macro)])
    runs = chain.from_iterable(_run(run, number, len(twins)) for run, number in enumerate(order))
    lines += _head([_HEAD, "    int row = 1;", *runs, "}"])
    return {PLACE: lines}


def fitted(order: Sequence[int], numbers: Sequence[int], /) -> tuple[list[int], list[int]]:
    """Return the order of runs that winds of these twins fit into, and in which row each run ends, from row 1 on.

    It is `order` with as many runs more as it lacks; runs may be empty.
    """
    found, counts, run = list(order), [0] * len(order), -1
    for number in numbers:
        if run < 0 or found[run] != number:
            run += 1
            if number in found[run:]:
                run = found.index(number, run)
            else:
                found.insert(run, number)
                counts.insert(run, 0)
        counts[run] += 1
    return found, list(accumulate(counts, initial=1))[1:]


def fitted_few(order: Sequence[int], numbers: Sequence[int], /) -> tuple[list[int], list[int]]:
    """Return what `fitted` does, with no more than `MOST_RUNS` runs: those needed alone, or one for all winds."""
    for before in (order, ()):
        found, ends = fitted(before, numbers)
        if len(found) <= MOST_RUNS:
            return found, ends
    return [ANY], [len(numbers) + 1]


_HEAD = "void blow(inout Claims claims, vec2 place, int kind, int receiver) {"


def _run(run: int, number: int, twins: int) -> list[str]:
    loop = f"    for (int end = end_of({run}); row < end && claims.left > 0.0; ++row) {{"
    told = "        lay_told(claims, row, receiver);"
    if number == TOLD:
        return [loop, told, "    }"]
    if number != ANY:
        return [loop, *_sent(number), "    }"]
    cases = ((f"        case {each}: {{", *_sent(each), "        } break;") for each in range(twins))
    choice = "        switch (twin_of(row)) {"
    return [loop, choice, *chain.from_iterable(cases), f"        default: {told.strip()}", "        }", "    }"]


def _sent(number: int) -> list[str]:
    return [
        "        Asked one = asked(row, place, kind);",
        "        vec2 message = vec2(0.0);",
        f"        float weight = one.held ? mask_{number}(one.own, one.wind) : 0.0;",
        "        if (weight > 0.0) {",
        f"            message = action_{number}(one.own, one.wind);",
        "        }",
        "        lay_sent(claims, one, weight, message);",
    ]


def _head(texts: Iterable[str]) -> list[Line]:
    return [(PLACE, 0, text) for text in texts]


def _most(reads: re.Pattern[str], text: Sequence[str]) -> int:
    return max((int(number) + 1 for line in text for number in reads.findall(line)), default=0)


def _beside(module: str, name: str) -> Traversable | None:
    """Return the file of a name in the folder that a module is in; None where it is in none, as typed code is."""
    found = sys.modules.get(module)
    spec = getattr(found, "__spec__", None)
    if spec is not None and spec.parent:
        return files(spec.parent).joinpath(name)
    place = getattr(found, "__file__", None)
    return None if place is None else Path(place).with_name(name)
