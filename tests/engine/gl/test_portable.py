"""No shader depends on behaviour that GLSL leaves undefined, and drivers choose differently."""

import random
import re
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import pytest

from tallgrass.engine.gl.shaders import Line, compose

ROOT = Path(str(files("tallgrass")))
STAGES = sorted(
    path.relative_to(ROOT).as_posix() for stage in ("vert", "frag") for path in (ROOT / "systems").rglob(f"*.{stage}")
)
PIXELS = [name for name in STAGES if name.endswith(".frag")]

DIFFERENCE = re.compile(r"\b(?:dFdx|dFdy|fwidth|texture)\(")
"""Functions that read neighbouring pixels, which must have reached the same line."""

SAME = re.compile(r"anything_is_cut\(\)|any_maps\(\)|earth_side|over_hosts|\bform ==|\bmixed\.|\brow_told\.|\brough <")
"""What is the same for all pixels of a draw, or of a flat card: a condition on these parts none from its neighbours."""

FUNCTION = re.compile(r"^[a-z]\w*\s+(\w+)\([^;]*\)\s*\{")
CONSTANT = re.compile(r"const (?:float|vec[234]) ([^;]+);")


def lines_of(name: str) -> list[tuple[str, str]]:
    """The lines of a stage without comments, each with its place."""
    found: list[Line] = compose(name)[1]
    told = [(f"{file}:{line}", text.split("//")[0].rstrip()) for file, line, text in found]
    return [(place, text) for place, text in told if not text.startswith("#")]


def arguments(text: str) -> list[str]:
    """Return a call's arguments from the text after its opening bracket."""
    depth, found = 0, [""]
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        if depth < 0:
            break
        if letter == "," and depth == 0:
            found.append("")
        else:
            found[-1] += letter
    return found


def constants(name: str) -> dict[str, list[float]]:
    """The numbers of a stage's constants, those of vectors in their order."""
    known: dict[str, list[float]] = {}
    for _, text in lines_of(name):
        for constant, _, value in (each.partition("=") for said in CONSTANT.findall(text) for each in arguments(said)):
            parts = arguments(value.partition("(")[2]) if "vec" in value else [value]
            if not re.search(r"[A-Za-z_]\w*", re.sub(r"\d\.?\d*e-?\d+", "", "".join(parts))):
                known[constant.strip()] = [float(eval(part)) for part in parts]  # noqa: S307 - our own numbers
    return known


def worth(text: str, known: dict[str, list[float]], some: random.Random) -> float:
    """Return the value of an expression in which every unknown is some positive number."""
    drawn: dict[str, float] = {}

    def number(match: re.Match[str]) -> str:
        name, _, part = match[0].partition(".")
        if name in known:
            return repr(known[name]["xyzw".index(part)] if part else known[name][0])
        return repr(drawn.setdefault(match[0], some.uniform(0.05, 8.0)))

    plain = re.sub(r"(?<![\w.])(?!max\b|min\b)[A-Za-z_]\w*(?:\.\w+)?", number, text)
    return float(eval(plain, {"max": max, "min": min}))  # noqa: S307 - our own shaders


@pytest.mark.parametrize("name", STAGES)
def test_d6_the_edges_of_smooth_steps_are_in_their_order(name: str) -> None:
    known, some = constants(name), random.Random(1)  # noqa: S311
    for place, text in lines_of(name):
        for call in re.finditer(r"\bsmoothstep\(", text):
            low, high, _ = arguments(text[call.end() :])
            for _ in range(20):
                state = some.getstate()
                first = worth(low, known, some)
                some.setstate(state)  # what both name is the same for both
                assert first < worth(high, known, some), f"{place}: {low}, {high}"


@pytest.mark.parametrize("name", STAGES)
def test_d6_angles_are_asked_of_no_sine_above_1(name: str) -> None:
    for place, text in lines_of(name):
        for call in re.finditer(r"\ba(?:sin|cos)\(", text):
            (sine,) = arguments(text[call.end() :])
            assert re.fullmatch(r"clamp\(.*, -1\.0, 1\.0\)", sine), f"{place}: {sine}"


def functions(name: str) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """The functions of a stage in their order, each with its lines."""
    body: list[tuple[str, str]] | None = None
    for place, text in lines_of(name):
        begun = FUNCTION.match(text)
        if begun:
            called, body = begun[1], []
        elif text.startswith("}") and body is not None:
            yield called, body
            body = None
        elif body is not None:
            body.append((place, text))


def parted(body: list[tuple[str, str]], enders: set[str], asks: re.Pattern[str]) -> list[str]:
    """Return the places where a function takes derivatives that some pixels of a quad may not reach."""
    found, inside, is_narrow, are_gone = list[str](), list[bool](), False, False
    for place, text in body:
        if text.lstrip().startswith("}"):
            inside.pop()
        parts = bool(re.search(r"\b(?:if|for|while|else|do)\b", text)) and not SAME.search(text)
        asked, is_apart = asks.search(text), any(inside) or is_narrow
        before = text[: asked.start()] if asked else ""
        if asked and (is_apart or are_gone or ("?" in before and not SAME.search(before))):
            found.append(place)
        are_gone = are_gone or any(f"{each}(" in text for each in enders)
        are_gone = are_gone or bool(is_apart and re.search(r"\b(?:return|discard)\b", text))
        is_narrow = parts and not text.endswith(("{", ";"))
        if text.endswith("{"):
            inside.append(parts)
    return found


@pytest.mark.parametrize("name", PIXELS)
def test_d6_pixels_ask_their_neighbours_where_all_of_them_come(name: str) -> None:
    asking, enders, wrong = set[str](), set[str](), list[str]()
    for called, body in functions(name):
        asks = re.compile("|".join([DIFFERENCE.pattern, *(rf"\b{each}\(" for each in asking)]))
        wrong += parted(body, enders, asks)
        if any(asks.search(text) for _, text in body):
            asking.add(called)
        if any("discard" in text for _, text in body):
            enders.add(called)
    assert not wrong
