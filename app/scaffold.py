"""The files of a new wind plugin: what works already, for its author to change."""

import re
from keyword import iskeyword
from pathlib import Path
from string import Template

from ..components.wind import INTERFACE
from ..engine.plugins import wind_kinds
from .studio.errors import InputError

_NAME = re.compile(r"[a-z][a-z0-9]*(?:[-_][a-z0-9]+)*")
_TAKEN = {"Extent", "Field", "Grass", "PlacedWind"}

_PROJECT = Template("""\
[project]
name = "tallgrass-$dashed"
version = "0.1.0"
dependencies = ["tallgrass"]
[project.entry-points."tallgrass.wind"]
$kind = "$module:$title"
""")

_MODULE = Template('''\
"""A wind for tallgrass: $kind."""

import numpy as np
from pydantic import Field

from tallgrass import Extent, Grass, PlacedWind


class $title(PlacedWind):
    """A round patch of wind that blows ahead and swells like breathing."""

    interface = $interface
    kind: str = "$kind"
    """A patch of wind."""
    radius: float = Field(default=5.0, ge=0.5, le=100.0)
    """Radius of the patch [m]."""
    strength: float = Field(default=0.6, ge=0.0, le=1.0)
    """Posture index in its middle."""
    period: float = Field(default=4.0, ge=0.1, le=60.0)
    """How long one breath takes [s]."""

    def rates(self) -> tuple[float]:
        """Return how many breaths it draws in a second: `phases` counts them, whatever a game changes."""
        return (1.0 / self.period,)

    def extent(self, *, time: float) -> Extent:
        """Return the square around the patch: elsewhere the wind costs nothing."""
        return Extent(-self.radius, self.radius, -self.radius, self.radius)

    def mask(self, place: np.ndarray, /, *, time: float) -> np.ndarray:
        """Return how far it holds places (n, 2) in its own frame [m]: 1 in the middle, 0 at the rim, shape (n,)."""
        away = np.sqrt((place * place).sum(axis=1))
        return np.asarray(np.clip(2.0 - 2.0 * away / self.radius, 0.0, 1.0))

    def action(self, place: np.ndarray, /, *, time: float, seed: int, grass: Grass) -> np.ndarray:
        """Return bending directions times posture indices, shape (n, 2): ahead is -z."""
        breath = 0.75 + 0.25 * np.sin(2.0 * np.pi * self.phases(time=time)[0])
        return np.full_like(place, [0.0, -self.strength * breath])
''')

_TEST = Template('''\
"""The wind `$kind` keeps to what tallgrass asks of every wind."""

from $module import $title

from tallgrass.testing import check_wind


def test_it_is_a_wind_as_tallgrass_asks() -> None:
    """One sentence for each thing that is wrong."""
    check_wind($title)
''')


def scaffold(kind: str, folder: Path) -> list[Path]:
    """Write an installable plugin with one kind of wind into a new folder, and return its files.

    Raises InputError for a name that cannot be one or is taken, a folder that has something in it, and a place that
    cannot be written to.
    """
    _must_be_free(kind)
    words = re.split("[-_]", kind)
    title = "".join(word.capitalize() for word in words)
    names = {
        "kind": kind,
        "dashed": "-".join(words),
        "module": "tallgrass_" + "_".join(words),
        "title": f"{title}Wind" if title in _TAKEN or iskeyword(title) else title,
        "interface": str(INTERFACE),
    }
    files = {
        folder / "pyproject.toml": _PROJECT,
        folder / f"{names['module']}.py": _MODULE,
        folder / "tests" / f"test_{'_'.join(words)}.py": _TEST,
    }
    try:
        if folder.exists() and not (folder.is_dir() and next(folder.iterdir(), None) is None):
            raise InputError(f"'{folder}' is there already; name a new folder with -o")
        (folder / "tests").mkdir(parents=True)
        for file, text in files.items():
            file.write_text(text.substitute(names), "utf-8")
    except OSError as error:
        raise InputError(f"'{error.filename or folder}' cannot be written: {error.strerror or error}") from error
    return list(files)


def _must_be_free(kind: str) -> None:
    if not _NAME.fullmatch(kind) or len(kind) > 60:
        raise InputError(f"a kind is written in lower-case letters and digits, with - or _ between, unlike '{kind}'")
    for provided in wind_kinds().provided():
        if provided.kind == kind:
            raise InputError(f"kind '{kind}' already comes with {provided.distribution} {provided.version}".rstrip())
