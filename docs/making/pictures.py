"""The manual's pictures: each is made by the command that its page tells of, and made again when the sources change."""

import re
import subprocess
import sys
import zlib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PLAYS = ROOT / "docs" / "making" / "played.py"
PAGES = sorted((ROOT / "docs").glob("*.md"))
SOURCES = ("app", "components", "engine", "examples", "scenes", "systems")
NAMED = re.compile(r"^`(?P<file>[^`\n]+)`:\n\n```\w+\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
FIGURE = re.compile(r"\(pictures/figure-(\d+)\.png\)")


@dataclass(frozen=True, slots=True)
class Picture:
    """One picture: what makes it, and the page that holds the scene or the program that it is of."""

    file: str
    command: tuple[str, ...]
    page: str | None = None


IN_FLOWER = ("poppies", "dandelions", "heather")

WOODED = ("hedgerow", "pines")

PLAYED = ("village", "lake", "night_drive", "planet", "split_screen", "farm")
"""Examples whose picture is their own."""

PICTURES = (
    Picture("meadow.png", ("shot", "meadow", "--size", "960x540", "--time", "3")),
    Picture("evening.png", ("shot", "evening.yaml", "--size", "960x540"), "first-scene.md"),
    Picture(
        "crossing.webp",
        ("film", "crossing.yaml", "--size", "480x270", "--seconds", "5", "--fps", "12"),
        "first-scene.md",
    ),
    Picture("levels.png", ("shot", "meadow", "--size", "960x540", "--time", "3", "--overlay", "levels,map")),
    Picture("noon.png", ("shot", "plain", "--size", "960x540", "--time", "2")),
    *(
        Picture(f"{name}.png", ("shot", f"{name}.yaml", "--size", "960x540", "--time", time, *more), "gallery.md")
        for name, time, *more in (
            ("clouds", "20"),
            ("telephoto", "3", "--preset", "ultra"),
            ("ridge", "3"),
            ("dusk", "3"),
        )
    ),
    Picture("grove.png", ("shot", "grove", "--size", "960x540")),
    *(Picture(f"{name}.png", ("shot", name, "--size", "960x540", "--time", "2")) for name in (*IN_FLOWER, *WOODED)),
    Picture("above.png", ("shot", "poppies", "--size", "960x540", "--time", "3", "--camera=-30,26,60,20,-24")),
    Picture("reeds.png", ("shot", "reeds", "--size", "960x540", "--time", "3")),
    Picture("against.png", ("shot", "sundown", "--size", "960x540", "--time", "3")),
    Picture("after.png", ("shot", "storm", "--size", "960x540", "--time", "12")),
    Picture("saucer.png", ("shot", "saucer", "--size", "960x540", "--time", "5")),
    Picture("walk.png", ("shot", "meadow", "--size", "960x540", "--time", "9")),
    Picture("gust.webp", ("film", "gust", "--size", "480x270", "--seconds", "5", "--fps", "12")),
    Picture("flight.webp", ("film", "saucer", "--size", "480x270", "--seconds", "5", "--fps", "12")),
    Picture("day.webp", ("film", "day.yaml", "--size", "480x270", "--seconds", "5", "--fps", "12"), "gallery.md"),
    Picture("bow.png", ("python", "picture.py"), "first-system.md"),
    Picture("lawn.png", ("python", "lawn.py"), "mowing.md"),
    Picture("top-down.png", ("python", "top_down.py"), "cameras.md"),
    Picture("music.webp", ("python", "music.py"), "music.md"),
    *(Picture(f"{name}.png", ("played", name)) for name in PLAYED),
    Picture("storm.png", ("shot", "storm", "--size", "960x540", "--time", "12", "--overlay", "masks,arrows")),
)


def named_blocks(page: Path, /) -> dict[str, str]:
    """Return the files that a page tells to write: those blocks that a line with their name stands above."""
    return {block["file"]: block["text"] for block in NAMED.finditer(page.read_text("utf-8"))}


def make_pictures(folder: Path, /) -> None:
    """Make every picture into a folder, unless they are there and nothing that they show has changed."""
    stamp, made = folder / ".made-from", _made_from()
    if stamp.is_file() and stamp.read_text("utf-8") == made:
        return
    folder.mkdir(parents=True, exist_ok=True)
    stamp.unlink(missing_ok=True)
    for picture in PICTURES:
        if picture.page is not None:
            for name, text in named_blocks(ROOT / "docs" / picture.page).items():
                folder.joinpath(name).write_text(text, "utf-8")
        if picture.command[0] == "played":
            program = ROOT / "examples" / f"{picture.command[1]}.py"
            subprocess.run([sys.executable, PLAYS, program, picture.file, "3"], cwd=folder, check=True)
        elif picture.command[0] == "python":
            subprocess.run([sys.executable, *picture.command[1:]], cwd=folder, check=True)
        else:
            _run(*picture.command, "-o", picture.file, folder=folder)
    _run("figures", "-o", ".", "--only", ",".join(map(str, figures_shown())), folder=folder)
    stamp.write_text(made, "utf-8")


def figures_shown() -> list[int]:
    """Return the numbers of the paper's figures that the pages show."""
    return sorted({int(number) for page in PAGES for number in FIGURE.findall(page.read_text("utf-8"))})


def _made_from() -> str:
    files = [file for name in SOURCES for file in sorted((ROOT / name).rglob("*")) if "__pycache__" not in file.parts]
    files += [*PAGES, Path(__file__)]
    total = 0
    for file in files:
        total = zlib.crc32(file.read_bytes(), total) if file.is_file() else total
    return f"{total}\n"


def _run(*arguments: str, folder: Path) -> None:
    print("tallgrass", *arguments)
    subprocess.run([sys.executable, "-m", "tallgrass.app.cli", *arguments], cwd=folder, check=True)
