"""Fuzzing of scene files: mutations of existing scenes are read.

The suite tries a few. `TALLGRASS_FUZZ=20000 pytest tests/scenes/test_fuzz.py` tries more, `TALLGRASS_FUZZ_SEED` others.
A case follows from its number alone, which a failure names: `TALLGRASS_FUZZ_FROM=N` with `TALLGRASS_FUZZ=1` tries it
again.
"""

import json
import os
import re
import resource
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from pathlib import Path
from time import perf_counter
from typing import Any

import fastjsonschema
import numpy as np
import pytest
from pydantic import Field, field_validator

from tallgrass.app.check import described
from tallgrass.components.arrays import Floats
from tallgrass.components.declaration import Declaration, Pair
from tallgrass.components.wind import Grass, WindPrimitive, WindSource
from tallgrass.engine.plugins import wind, wind_kinds
from tallgrass.engine.scene import LoadedScene, SceneError, bundled_scenes, load_maps, printable, read_scene
from tallgrass.engine.scene.compose import read_document
from tallgrass.systems.wind.blow import blowing, hear, lone_receivers
from tallgrass.systems.wind.quarantine import Quarantine

COUNT = int(os.environ.get("TALLGRASS_FUZZ", "300"))
SEED = int(os.environ.get("TALLGRASS_FUZZ_SEED", "1"))
FIRST = int(os.environ.get("TALLGRASS_FUZZ_FROM", "0"))
LONGEST = 10.0
"""Longest time of reading or refusing a scene, with its maps and winds [s]."""
MOST_MEMORY = 150.0
"""Most memory of a whole run [MB]: that of the case that needs most."""

HERE = Path(__file__).parent
Random = np.random.Generator

ODD: list[Any] = [
    None, True, False, 0, 1, -1, 2, 3, 0.5, -0.0, 1e-9, 1e9, 1e308, -1e308, 10**30, float("nan"), float("inf"), 2**31,
    36000, 36000.1, "", " ", "x", "yes", "1e3", "1,5", "2 m", "#fff", "#ffffff", "a\tb", "\u2028", "\x85", "\U0001f33e",
    "../../etc", "/dev/null", "/dev/zero", ".", "density.png", "nothing.png", "a\0b", "x" * 5000, [], [[]], {},
    {"": ""}, [0], [0, 0], [0, 0, 0], [1, -1], [9, 5], [0.5, 0.5], [1e300, 1e300], [None], ["a", "b"], [[0, 0]] * 3,
    [0] * 400,
    [[0, 0], [4, 0], [0, 4]], [[0, 0], [1e3, 1e3], [0, 1e3], [1e3, 0]], {"kind": "gust"}, {"at": 0, "position": [0, 0]},
    {"disc": 2}, {"ellipse": [2, 1e3]}, {"image": "density.png"}, {"map": "density.png"}, "gust", "saucer", "breeze",
]  # fmt: skip
FRAGMENTS = [
    "{", "}", "[", "]", ":", ": ", "- ", "-", "#", "&a ", "*a", "<<: *a", "!!python/object:os.system ", "!tag ", "|\n",
    ">\n", "'", '"', "\\", "?", "? ", ",", "%YAML 9.9\n", "---\n", "...\n", "\t", "  ", "\n", "\r", "\0", "\x7f",
    "\ufeff", "\ud7ff", "é", "\u2029", "1e999", "-.inf", ".nan", "0x1F", "0o17", "1_000", "12:30", "~", "null",
    "wind:\n", "seed: 1\n", "tallgrass: 2\n", "tallgrass: 2\n", "kind: ", "&b [*b]", "{a: &c {b: *c}}", "@", "`",
    "9" * 70,
]  # fmt: skip


class Puff(Declaration):
    """A part of the plugin's wind."""

    at: Pair = Field(default=[0.0, 0.0])
    size: float = Field(1.0, gt=0.0, le=9.0)


class Bellows(WindPrimitive):
    """A plugin's wind with nested parts, and validators that raise any error."""

    puffs: list[Puff] = Field(default=[], max_length=20)
    table: dict[str, Puff] = {}  # noqa: RUF012 - pydantic copies it
    power: float = Field(0.5, ge=0.0, le=1.0)
    name: str | None = Field(None, pattern="^[a-z]+$")

    @field_validator("name")
    @classmethod
    def _fragile(cls, name: str | None) -> str | None:
        if name == "x":
            raise KeyError(name)
        return name

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.full(len(place), 0.5, np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full((len(place), 2), 0.5 * self.power, np.float32)


PLUGIN = """\
tallgrass: 2
grass: { lawn: {} }
wind:
  - { kind: test-bellows, power: 0.25, name: abc, puffs: [{ at: [1, 2], size: 3 }, { size: 0.5 }] }
  - { kind: test-bellows, table: { first: { at: [0, 1] }, second: {} }, start: 3, stop: 5 }
"""
SOURCES = [path.read_text("utf-8") for path in bundled_scenes().values()]
SOURCES += [(HERE / "format-2" / "full.yaml").read_text("utf-8"), PLUGIN]
BROKEN = [path.read_text("utf-8") for path in sorted((HERE / "broken").glob("*.yaml"))]
WORDS = sorted({word for text in SOURCES for word in re.findall(r"[\w.-]+|[^\w\s]", text)})


def pick(random: Random, things: Any) -> Any:
    return things[int(random.integers(len(things)))]


def places(values: object, here: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the ways to all values inside a value, except the empty way."""
    steps = values.items() if isinstance(values, dict) else enumerate(values) if isinstance(values, list) else ()
    for step, value in steps:
        yield (*here, step)
        yield from places(value, (*here, step))


def in_words(text: str, random: Random) -> str:
    """Return a text with one random change."""
    return in_lines(text, random) if random.random() < 0.25 else in_place(text, random)


def in_place(text: str, random: Random) -> str:
    """Return a text changed at one place."""
    at, size = int(random.integers(len(text) + 1)), int(random.geometric(0.1))
    start, end = pick(random, [match.span() for match in re.finditer(r"[\w.-]+", text)] or [(0, 0)])
    word = text[start:end]
    first, last, new = pick(random, [
        (at, at + size, ""),
        (at, len(text), ""),
        (at, at, pick(random, FRAGMENTS)),
        (at, at, chr(int(random.integers(0xD7FF)))),
        (at, at, pick(random, ["[", "{a: ", "- ", "&a [*a, "]) * int(pick(random, [3, 70, 20000]))),
        (start, end, pick(random, WORDS)),
        (start, end, json.dumps(pick(random, ODD))),
        (start, end, word[: max(1, size // 2)] * 2),
    ])  # fmt: skip
    return f"{text[:first]}{new}{text[last:]}"


def in_lines(text: str, random: Random) -> str:
    """Return a text with one change of its lines."""
    lines = text.split("\n")
    row, other = random.integers(len(lines), size=2).tolist()
    match int(random.integers(3)):
        case 0:
            lines[row], lines[other] = lines[other], lines[row]
        case 1:
            lines[row] = lines[row][1:] if random.random() < 0.5 else " " * int(random.integers(1, 5)) + lines[row]
        case _:
            lines[row:row] = [lines[row]] * int(pick(random, [1, 1, 2, 300]))
    return "\n".join(lines)


def in_values(text: str, random: Random) -> str:
    """Return a scene's text with some changed values; a text that is no mapping is changed as a text."""
    try:
        values = deepcopy(read_document(text, file="<scene>").root.data)
    except SceneError:
        return in_words(text, random)
    for _ in range(int(pick(random, [1, 1, 2, 4]))):
        ways = list(places(values))
        if not ways:
            break
        *above, step = pick(random, ways)
        inside = values
        for each in above:
            inside = inside[each]
        _change(inside, step, values, random)
    return json.dumps(values, ensure_ascii=False, indent=pick(random, [None, 1]))


def _change(inside: Any, step: Any, values: Any, random: Random) -> None:
    match int(random.integers(7)):
        case 0:
            del inside[step]
        case 1 if isinstance(inside, dict):
            inside[step[: len(step) // 2] + step[len(step) // 2 + 1 :]] = inside.pop(step)
        case 2 if isinstance(inside, list):
            inside.extend(deepcopy(inside[step]) for _ in range(int(pick(random, [1, 2, 250]))))
        case 3 if isinstance(inside[step], int | float):
            inside[step] = inside[step] * pick(random, [-1, 0, 0.5, 2, 10, 1e6])
        case 4 if isinstance(values, dict):
            values["wind"] = [_any_wind(random) for _ in range(int(random.integers(1, 5)))]
        case 5:
            inside[step] = [deepcopy(inside[step])]
        case _:
            inside[step] = deepcopy(pick(random, ODD))


def _any_wind(random: Random) -> dict[str, Any]:
    """Return a wind of any kind with some of its keys, each with a fitting or an unfitting value."""
    kind = pick(random, wind_kinds().names())
    made: dict[str, Any] = {"kind": kind}
    for name, field in wind_kinds().find(kind).model_fields.items():
        chance = random.random()
        if name == "kind" or chance < 0.6:
            continue
        limits = {key: getattr(one, key) for one in field.metadata for key in ("ge", "le") if hasattr(one, key)}
        if limits and chance < 0.97:
            made[name] = limits[pick(random, sorted(limits))]
        elif chance > 0.9:
            made[name] = deepcopy(pick(random, ODD))
    return made


def case(number: int) -> bytes:
    """Return the text of a case's scene file."""
    random = np.random.default_rng((SEED, number))
    text = pick(random, SOURCES if random.random() < 0.8 else BROKEN)
    for _ in range(int(pick(random, [1, 1, 1, 2, 3]))):
        text = pick(random, [in_words, in_values])(text, random)[: 2**21]
    data = bytearray(text.encode("utf-8", "surrogatepass"))
    if data and random.random() < 0.1:
        data[int(random.integers(len(data)))] = int(random.integers(256))
    return bytes(data)


def refused(error: SceneError, path: Path, data: bytes) -> None:
    """Assert that problems name the file, existing lines and columns, and what is wrong there."""
    lines = data.decode("utf-8-sig", "replace").splitlines() or [""]
    assert 1 <= len(error.problems) <= 201
    assert len(str(error)) < 200 * 1000
    for problem in error.problems:
        assert problem.file == str(path)
        assert 1 <= problem.line <= len(lines) + 1
        assert 1 <= problem.column <= max(map(len, lines)) + 1
        assert problem.message
        head = str(problem).splitlines()[0]
        assert head.startswith(f"{printable(str(path))}:{problem.line}:{problem.column}: ")
        assert not re.search(r"Traceback|Error\(|0x[0-9a-f]{8}|pydantic|\bobject at\b", problem.message), (
            problem.message
        )


def blown(loaded: LoadedScene) -> None:
    """Assert that the winds of a scene blow: none fails, and all messages are valid."""
    place = np.array([[0, 0], [3, -4], [-14, 2], [60, 90], [-5000, 5000]], np.float32)
    curve = np.linspace(0.0, 1.0, 8, dtype=np.float32)[None]
    grass = Grass(np.zeros(len(place), np.intp), np.ones(1, np.float32), curve, 1 - curve)
    sources = [WindSource(wind, f"wind[{number}]") for number, wind in enumerate(loaded.scene.wind)]
    quarantine, seed = Quarantine(), loaded.scene.seed
    for time in (0.0, 4.75, 36000.0):
        winds = blowing(sources, quarantine, time=time, seed=seed)
        heard = hear(winds, lone_receivers(place, grass), quarantine, time=time, seed=seed, mixing=loaded.scene.mixing)
        assert heard.shape == (5, 2)
        assert np.hypot(*heard.T).max() <= 1.0 + 1e-5
    failed = [reason for reason in quarantine.reasons.values() if " raised " in reason or " returned " in reason]
    assert not failed, failed


def tried(number: int, path: Path, fits: Callable[[object], object]) -> bool:
    """Read a case; return whether it is a scene. Then its winds must blow, and it must fit the schema."""
    data = case(number)
    path.write_bytes(data)
    try:
        loaded = read_scene(path)
        load_maps(loaded)
    except SceneError as error:
        refused(error, path, data)
        return False
    blown(loaded)
    fits(loaded.document.root.data)
    return True


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Interrupt what hangs."""

    def stop(*_: object) -> None:
        raise TimeoutError(f"still busy after {seconds} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """Folder for scenes with pictures that they may name; a plugin's wind is registered meanwhile."""
    shutil.copy(bundled_scenes()["meadow"].with_name("meadow-density.png"), tmp_path / "density.png")
    shutil.copy(tmp_path / "density.png", tmp_path / "meadow-density.png")
    shutil.copy(HERE / "broken" / "text.png", tmp_path / "shape.png")
    wind_kinds.cache_clear()
    wind("test-bellows")(Bellows)
    yield tmp_path
    wind_kinds.cache_clear()


def megabytes() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def test_d4_no_file_at_all_ends_in_a_traceback_a_hang_or_a_crash(folder: Path) -> None:
    path, scenes, slowest = folder / "case.yaml", 0, (0.0, 0)
    fits = fastjsonschema.compile(described(wind_kinds())[0], use_default=False)
    tried(FIRST, path, fits)
    before = megabytes()
    for number in range(FIRST, FIRST + COUNT):
        start = perf_counter()
        try:
            with at_most(LONGEST):
                scenes += tried(number, path, fits)
        except Exception as error:
            raise AssertionError(f"case {number} of seed {SEED}: {path} {path.read_bytes()[:2000]!r}") from error
        slowest = max(slowest, (perf_counter() - start, number))
    print(f"{COUNT} cases, {scenes} of them scenes; slowest {slowest}; {megabytes() - before:.0f} MB more")  # noqa: T201
    assert megabytes() - before < MOST_MEMORY
    if COUNT >= 1000:
        assert 0.02 * COUNT < scenes < 0.9 * COUNT


def test_a_case_depends_on_its_number_alone(folder: Path) -> None:
    assert folder
    assert case(7) == case(7)
    assert len({case(number) for number in range(50)}) == 50
