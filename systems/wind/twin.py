"""Twins: the GLSL of winds, found beside their classes and assembled into a program."""

import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from itertools import accumulate, chain
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

import numpy as np

from ...components.arrays import Floats
from ...components.wind import TwinValues, WindPrimitive
from ...components.words import guess
from ...engine.gl.shaders import Line

PLACE = "systems/wind/twins.glsl"
"""File that the assembled twins of a program replace."""

MOST_NUMBERS, MOST_SHEETS, MOST_SIDE = 64, 4, 2048
"""Most numbers and sheets that a twin may read; most texels along a side of a sheet."""

NO_TWIN, ANY = -1, -2
"""In place of a twin's number: a wind that has none; a run of winds with any twins."""

MOST_RUNS = 12
"""Most runs in a program: drivers take long over large ones."""

LARGEST = 1e30
"""Bound of all numbers: single precision ends near it."""

PLAIN, SEVERAL = frozenset({float, int}), frozenset({tuple, list})
"""Types of numbers, and of vectors of them, that nearly all winds have."""

_TYPE = r"(?:float|int|uint|bool|[biu]?vec[234]|mat[234]|void|struct)"
_FUNCTION = re.compile(rf"^{_TYPE}\s+(\w+)\s*[({{]")
_CONSTANTS = re.compile(rf"^const\s+{_TYPE}\s+(.*)")
_CONSTANT = re.compile(r"(\w+)\s*(?:\[[^\]]*\]\s*)?=(?!=)")
_MACRO = re.compile(r"^\s*#\s*define\s+(\w+)")
_SHEET = re.compile(r"\b(?:sheet|smooth_noise)\s*\(\s*[\w.]+\s*,\s*(\d+)\b")
_ACTION = re.compile(r"\bvec2\s+action\s*\(\s*(?:in\s+)?vec2\s+\w+\s*,\s*(?:in\s+)?(\w+)\s+\w+\s*\)")
_COMMENT = re.compile(r"//.*")
_INCLUDE = re.compile(r"^\s*#\s*include\b")
_VECTOR = ("", "float", "vec2", "vec3", "vec4")


class TwinError(Exception):
    """A twin cannot be used; the message says why."""


@dataclass(frozen=True, slots=True)
class Twin:
    """The GLSL of a wind: `float mask(vec2 place, Gust gust)` and `vec2 action(vec2 place, Gust gust)`.

    `Gust` is the type of its record, which a twin may name freely.
    """

    file: str
    """Its name in messages: the module that it stands beside, and the file's name."""

    text: tuple[str, ...]
    """Lines of the file."""

    sheets: int
    """Number of sheets that it reads, by the literal arguments in its text."""

    record: str
    """Name of its record's type; empty where it has no `action`."""

    reads: tuple[str, ...]
    """Names of the record's members that it reads, each once."""

    @classmethod
    def of(cls, file: str, text: Sequence[str]) -> "Twin":
        """Return the twin of a file with these lines."""
        bare = "\n".join(_COMMENT.sub("", line) for line in text)
        found = _ACTION.search(bare)
        record = found[1] if found else ""
        sheets = max((int(number) + 1 for number in _SHEET.findall(bare)), default=0)
        return cls(file, tuple(text), sheets, record, _read_of(record, bare) if record else ())

    @property
    def names(self) -> list[str]:
        """Names of the functions, records and constants that it defines at its top level, each once."""
        found = [match[1] for line in self.text if (match := _FUNCTION.match(line))]
        constants = (_CONSTANT.findall(match[1]) for line in self.text if (match := _CONSTANTS.match(line)))
        return list(dict.fromkeys([*found, *chain.from_iterable(constants), self.record]))


@lru_cache(maxsize=256)
def twin_of(primitive: type[WindPrimitive], /) -> Twin | None:
    """Return the twin of a class of winds, None where it has none; raises TwinError where its file is missing.

    A class that overrides `mask` or `action` does not use the twin of a base.
    """
    order = primitive.__mro__
    owner = next(each for each in order if "twin" in vars(each))
    overriding = [each for each in order[: order.index(owner)] if {"mask", "action"} & vars(each).keys()]
    name = vars(owner)["twin"]
    if name is None or overriding:
        return None
    source = _beside(owner.__module__, name)
    if source is None or not source.is_file():
        raise TwinError(f"there is no file '{name}' beside its module {owner.__module__}")
    return Twin.of(f"{owner.__module__}/{name}", source.read_text("utf-8").splitlines())


@dataclass(frozen=True, slots=True)
class Layout:
    """Layout of a twin's record in the numbers of a wind: the members' names and sizes, in this order."""

    record: str
    sizes: tuple[tuple[str, int], ...]

    @property
    def lines(self) -> list[str]:
        """GLSL that defines the record, and a function `read_` plus its name that fetches each texel once."""
        members = [f"    {_VECTOR[size]} {name};" for name, size in self.sizes]
        ends = list(accumulate((size for _, size in self.sizes), initial=0))
        read = "    vec4 texel{k} = texelFetch(winds, ivec2(HEAD + {k}, wind.row), 0);"
        texels = [read.format(k=k) for k in range(-(-ends[-1] // 4))]
        vectors = [f"{_VECTOR[size]}({_texels(end, size)})" for end, (_, size) in zip(ends, self.sizes, strict=False)]
        return [
            f"struct {self.record} {{", "    Wind wind;", *members, "};",
            f"{self.record} read_{self.record}(Wind wind) {{", *texels,
            f"    return {self.record}({', '.join(['wind', *vectors])});", "}",
        ]  # fmt: skip

    def packed(self, wind: WindPrimitive, values: TwinValues, /) -> list[float]:
        """Return the numbers of a wind's record in this layout; raises TwinError where a size has changed."""
        _must_be_values(values)
        plain = self._plain(wind, values)
        if plain is not None:
            return plain
        found = [_member(name, wind, values) for name, _ in self.sizes]
        for (name, size), each in zip(self.sizes, found, strict=True):
            if len(each) != size:
                raise TwinError(f"'{name}' has {len(each)} numbers where it had {size} before")
        return [*chain.from_iterable(found)]

    def _plain(self, wind: WindPrimitive, values: TwinValues) -> list[float] | None:
        """Return the numbers in this layout, or None unless all types and sizes are the usual ones: a fast path."""
        found, named = list[float](), values.numbers
        for name, size in self.sizes:
            number: Any = named[name] if name in named else getattr(wind, name, None)
            if size == 1 and type(number) in PLAIN:
                found.append(number)
            elif type(number) in SEVERAL and len(number) == size > 1:
                found += number
            else:
                return None
        return found if PLAIN.issuperset(map(type, found)) else None


def layout_of(twin: Twin, wind: WindPrimitive, values: TwinValues, /) -> Layout:
    """Return the layout of a twin's record, with the sizes of a wind's values.

    Raises TwinError for a twin that lacks a function or includes a file, for unknown names, and for invalid values.
    """
    _must_be_whole(twin)
    _must_be_values(values)
    sizes = {name: len(_member(name, wind, values)) for name in twin.reads}
    return Layout(twin.record, tuple(sorted(sizes.items(), key=lambda row: -row[1])))


def check_values(twin: Twin, numbers: Sequence[float], sheets: Sequence[Floats], /) -> None:
    """Raise TwinError unless a twin can read these numbers, which are packed by its layout, and these sheets."""
    if len(numbers) > MOST_NUMBERS:
        raise TwinError(f"it reads {len(numbers)} numbers where {MOST_NUMBERS} is the most")
    are_numbers = PLAIN.issuperset(map(type, numbers)) or all(isinstance(n, float | int | np.number) for n in numbers)
    if not (are_numbers and all(map(LARGEST.__gt__, map(float, map(abs, numbers))))):
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


def joined_twins(twins: Sequence[Twin], order: Sequence[int], layouts: Sequence[Layout], /) -> dict[str, list[Line]]:
    """Return the lines that replace `PLACE`: a loop for each run of winds, where `order` has each run's twin number.

    `NO_TWIN` stands for winds without one, `ANY` for all. Runs of one twin are loops without a branch, because a
    software rasteriser executes every branch. Names that a twin defines get its number as a suffix, so that they clash
    with no others. `layouts` has the layout of each twin's record.
    """
    lines: list[Line] = []
    for number in range(len(twins)) if ANY in order else sorted(set(order) - {NO_TWIN}):
        twin = twins[number]
        own = re.compile(rf"(?<![\w.])(?:{'|'.join(_own_names(twin))})\b")
        lines += _generated(own.sub(rf"\g<0>_{number}", text) for text in layouts[number].lines)
        lines += [(twin.file, at, own.sub(rf"\g<0>_{number}", text)) for at, text in enumerate(twin.text, 1)]
    runs = chain.from_iterable(_run(run, number, twins) for run, number in enumerate(order))
    lines += _generated([_BLOW, "    int row = 1;", *runs, "}"])
    return {PLACE: lines}


def fit_runs(order: Sequence[int], numbers: Sequence[int], /) -> tuple[list[int], list[int]]:
    """Fit winds of these twins into `order`; return the order with the runs it lacked, and the row after each run.

    The first wind has row 1. Runs may be empty.
    """
    fitted, counts, run = list(order), [0] * len(order), -1
    for number in numbers:
        if run < 0 or fitted[run] != number:
            run += 1
            if number in fitted[run:]:
                run = fitted.index(number, run)
            else:
                fitted.insert(run, number)
                counts.insert(run, 0)
        counts[run] += 1
    return fitted, list(accumulate(counts, initial=1))[1:]


def fit_few_runs(order: Sequence[int], numbers: Sequence[int], /) -> tuple[list[int], list[int]]:
    """Return `fit_runs`, but with `MOST_RUNS` runs at most: else of the needed runs alone, or of one for all winds."""
    for before in (order, ()):
        fitted, ends = fit_runs(before, numbers)
        if len(fitted) <= MOST_RUNS:
            return fitted, ends
    return [ANY], [len(numbers) + 1]


_BLOW = "void blow(inout Claims claims, vec2 place, int kind, int receiver) {"


def _run(run: int, number: int, twins: Sequence[Twin]) -> list[str]:
    """Return the GLSL of a run: a loop over its winds."""
    loop = f"    for (int end = end_of({run}); row < end && claims.unclaimed > 0.0; ++row) {{"
    untwinned = "        lay_untwinned(claims, row, receiver);"
    if number == NO_TWIN:
        return [loop, untwinned, "    }"]
    if number != ANY:
        return [loop, *_call(number, twins[number]), "    }"]
    cases = ((f"        case {each}: {{", *_call(each, twin), "        } break;") for each, twin in enumerate(twins))
    switch = "        switch (twin_of(row)) {"
    return [loop, switch, *chain.from_iterable(cases), f"        default: {untwinned.strip()}", "        }", "    }"]


def _call(number: int, twin: Twin) -> list[str]:
    """Return GLSL that calls a twin for a wind and lays its message."""
    record = f"{twin.record}_{number}"
    return [
        "        Query query = query_of(row, place, kind);",
        "        vec2 message = vec2(0.0);",
        "        float weight = 0.0;",
        "        if (query.inside) {",
        f"            {record} record = read_{record}(query.wind);",
        f"            weight = mask_{number}(query.place, record);",
        "            if (weight > 0.0) {",
        f"                message = action_{number}(query.place, record);",
        "            }",
        "        }",
        "        lay_twin(claims, query, weight, message);",
    ]


def _own_names(twin: Twin) -> list[str]:
    """Return the names that a twin defines, without those of its record's members."""
    macros = [match[1] for text in twin.text if (match := _MACRO.match(text))]
    return [*twin.names, *macros, f"read_{twin.record}"]


def _texels(first: int, size: int) -> str:
    """Return the GLSL of `size` numbers from the `first` on, as components of fetched texels."""
    return ", ".join(f"texel{k // 4}.{'xyzw'[k % 4]}" for k in range(first, first + size))


def _must_be_whole(twin: Twin) -> None:
    """Raise TwinError for a twin that lacks one of its functions or includes a file."""
    for number, text in enumerate(twin.text, 1):
        if _INCLUDE.match(text):
            raise TwinError(f"{twin.file}:{number} includes a file, which a twin cannot")
    for head in ("float mask", "vec2 action"):
        if head.partition(" ")[2] not in _own_names(twin):
            raise TwinError(f"{twin.file} has no line that begins with '{head}(vec2 place, '")
    if twin.record == "Wind":
        raise TwinError(f"{twin.file} calls its record Wind, which is the engine's: choose another, such as Gust")


def _must_be_values(values: object) -> None:
    if not isinstance(values, TwinValues):
        raise TwinError(f"twin_values returned {type(values).__name__}, not TwinValues")
    if not isinstance(values.numbers, Mapping):
        raise TwinError("twin_values returned numbers without names: write TwinValues({'share': 0.5})")


def _read_of(record: str, text: str) -> tuple[str, ...]:
    """Return the names of the record's members that a text reads, each once."""
    variables = "|".join(dict.fromkeys(re.findall(rf"\b{record}\s+(\w+)", text)))
    members = re.findall(rf"\b(?:{variables})\s*\.\s*(\w+)", text)
    return tuple(name for name in dict.fromkeys(members) if name != "wind")


def _member(name: str, wind: WindPrimitive, values: TwinValues) -> Sequence[float]:
    """Return the numbers of a member, from `twin_values` or else a field of the wind; raises TwinError for neither."""
    named, fields = values.numbers, type(wind).model_fields
    if name not in named and name not in fields:
        near = guess(name, [*named, *fields], cutoff=0.7) or f", as in TwinValues({{'{name}': 0.5}})"
        raise TwinError(f"it reads '{name}', which is no field and no name that twin_values returned{near}")
    found = _as_list(named[name] if name in named else getattr(wind, name))
    if not 1 <= len(found) <= 4 or not all(isinstance(number, float | int | np.number) for number in found):
        what = shortened(found[0] if len(found) == 1 else found)
        raise TwinError(f"it reads '{name}', which is {what} and not one to four numbers")
    return found


def _as_list(number: Any) -> Sequence[Any]:
    return list(number) if isinstance(number, list | tuple | np.ndarray) else [number]


def _generated(texts: Iterable[str]) -> list[Line]:
    """Return lines that come from no twin's file."""
    return [(PLACE, 0, text) for text in texts]


def _beside(module: str, name: str) -> Traversable | None:
    """Return a file in the folder of a module; None for a module without one, such as an interactive session."""
    loaded = sys.modules.get(module)
    spec = getattr(loaded, "__spec__", None)
    if spec is not None and spec.parent:
        return files(spec.parent).joinpath(name)
    path = getattr(loaded, "__file__", None)
    return None if path is None else Path(path).with_name(name)
