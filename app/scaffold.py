"""The files of a new wind plugin and of a new game, which work and are meant to be changed."""

import re
from importlib.resources import files
from keyword import iskeyword
from pathlib import Path
from string import Template

from ..components.wind import INTERFACE
from ..engine.plugins import wind_kinds
from .shell import command_line
from .studio.errors import InputError

_NAME = re.compile(r"[a-z][a-z0-9]*(?:[-_][a-z0-9]+)*")
_TAKEN = {"Extent", "Field", "Grass", "PlacedWind"}


def new_wind(kind: str, folder: str | None) -> None:
    """Write a new plugin into a folder, by default named after its kind, and print the next commands."""
    place = Path(folder or kind)
    _tell(scaffold(kind, place), ["pip", "install", "-e", str(place)], ["tallgrass", "plugins", "check", kind])


def new_game(name: str, folder: str | None) -> None:
    """Write a new game into a folder, by default named after the game, and print the next command."""
    place = Path(folder or name)
    _tell(scaffold_game(name, place), ["python", str(place / "game.py")])


def _tell(written: list[Path], *commands: list[str]) -> None:
    for file in written:
        print(file)
    print(f"next: {' && '.join(map(command_line, commands))}")


def scaffold(kind: str, folder: Path) -> list[Path]:
    """Write an installable plugin with one kind of wind into a new folder, and return its files.

    Raises InputError for a name that cannot be one or is taken, a folder that has something in it, and a place that
    cannot be written to.
    """
    _must_be_name("kind", kind)
    for provided in wind_kinds().provided():
        if provided.name == kind:
            raise InputError(f"kind '{kind}' already comes with {provided.distribution} {provided.version}".rstrip())
    words = re.split("[-_]", kind)
    title = "".join(word.capitalize() for word in words)
    names = {
        "kind": kind,
        "dashed": "-".join(words),
        "module": "tallgrass_" + "_".join(words),
        "title": f"{title}Wind" if title in _TAKEN or iskeyword(title) else title,
        "interface": str(INTERFACE),
    }
    made = {
        "pyproject.toml": "wind-project.toml",
        f"{names['module']}.py": "wind.py",
        f"tests/test_{'_'.join(words)}.py": "wind-test.py",
    }
    return _write(folder, made, names)


def scaffold_game(name: str, folder: Path) -> list[Path]:
    """Write a small game into a new folder, and return its files: raises InputError as `scaffold` does."""
    _must_be_name("game", name)
    made = {
        "game.py": "game.py",
        "walk.py": "walk.py",
        "scene.yaml": "scene.yaml",
        "tests/test_walk.py": "game-test.py",
    }
    return _write(folder, made, {"name": name})


def _write(folder: Path, made: dict[str, str], names: dict[str, str]) -> list[Path]:
    """Write files by their templates; nothing is written over."""
    templates = files(f"{__package__}.templates")
    try:
        if folder.exists() and not (folder.is_dir() and next(folder.iterdir(), None) is None):
            raise InputError(f"'{folder}' is there already; name a new folder with -o")
        (folder / "tests").mkdir(parents=True)
        for file, template in made.items():
            text = Template((templates / f"{template}.tmpl").read_text("utf-8")).substitute(names)
            (folder / file).write_text(text, "utf-8")
    except OSError as error:
        raise InputError(f"'{error.filename or folder}' cannot be written: {error.strerror or error}") from error
    return [folder / file for file in made]


def _must_be_name(what: str, name: str) -> None:
    if not _NAME.fullmatch(name) or len(name) > 60:
        form = "lower-case letters and digits, a letter first, with - or _ between"
        raise InputError(f"a {what} is written in {form}, unlike '{name}'")
