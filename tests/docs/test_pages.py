"""The manual's pages: their files are written, and their programs and commands run, in their order.

The tutorial on winds needs an environment of its own, so it has a test of its own. So does the README.
"""

import ast
import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pyglet
import pytest
import pytest.__main__

from tallgrass.app.cli import run as tallgrass
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.quality import PRESETS, StripRing
from tallgrass.engine.scene import parse_scene
from tallgrass.systems.stock import models

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(page.name for page in DOCS.glob("*.md"))
GENERATED = re.compile("^<!-- generated: .*?^<!-- end of what is generated -->$", re.MULTILINE | re.DOTALL)


def written(page: str) -> str:
    """Return the hand-written text of a page; generated parts have tests of their own."""
    return GENERATED.sub("", (DOCS / page).read_text("utf-8"))


FOLLOWED = [name for name in PAGES if name != "first-wind.md" and "\n```" in written(name)]
BLOCK = re.compile(
    r"(?:^<!-- not run: (?P<reason>[^\n]+) -->\n)?(?:^`(?P<file>[^`\n]+)`:\n\n)?"
    r"^```(?P<language>\w*)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
Python = Callable[..., str]

COARSEST = [StripRing(to=8, strips=2, columns=1, sections=1, texel=0.03)]
LITTLE = PRESETS["low"].model_copy(update={"blades": 40, "models": 1, "strip_rings": COARSEST, "carpet": 16})
"""Quality that replaces the preset low: growing it takes no longer than drawing a picture."""

ALIKE = models.mechanics_of(GrassKind()), 0
"""How all grass bends on these pages, and its seed: to simulate each kind takes longer than to draw its picture."""

POSTURES = models._postures  # noqa: SLF001

GAME = """
import pyglet

flip, left = pyglet.window.Window.flip, [4]


def shown(window):
    flip(window)
    left[0] -= 1
    if not left[0]:
        pyglet.app.exit()


pyglet.window.Window.flip = shown
"""
"""Ends a program that would run until its window is closed, after some pictures."""

HERE = re.compile(r"(tallgrass (shot|film|check) (?!.*--on)[^|>&]*\n)+")
"""Commands that are run in this process, as starting a process takes longer than most of them."""

PROGRAM = re.compile(r"(?:python|pytest -q) (\w+\.py)\n")
"""Commands that run a page's own program, or its own test."""

MEASURED = {"performance.md"}
"""Pages with counts of blades."""

LONG = {
    "cameras.md", "embedding.md", "farm.md", "gallery.md", "ground.md", "mowing.md", "music.md", "smooth.md",
    "systems.md", "world.md",
}  # fmt: skip
"""Pages that take 2 to 17 s; tests of frames, hosts and examples call the same functions."""

COARSE = {
    r"^tallgrass (shot|film)": r"\g<0> --preset low",
    r"--preset (?!low\b)\w+ ": "",
    r"--size \d+x\d+": "--size 160x90",
    r"--seconds \d+": "--seconds 1",
    r"--fps \d+": "--fps 4",
    r"--on local:\d+": "--on local:1",
    r'preset="medium"': 'preset="low"',
    r"stage\(ctx, \(\d+, \d+\)\)": "stage(ctx, (160, 90))",
}
"""Replacements that make commands coarse: growing fine grass takes longer than all else on these pages."""

SMALL = {
    r'preset="medium"': 'preset="low"',
    r"stage\(ctx, \(\d+, \d+\)\)": "stage(ctx, (160, 90))",
    r"Window\(\d+, \d+": "Window(160, 90",
}
"""Replacements that make programs coarse."""


def blocks(page: str) -> list[re.Match[str]]:
    return list(BLOCK.finditer(written(page)))


def opens_a_window(page: str) -> bool:
    return any("pyglet.app.run()" in block["text"] and not block["reason"] for block in blocks(page))


def run(lines: str, folder: Path) -> str:
    """Run lines of a shell as a reader would, and return what they print."""
    place = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    place |= {"PATH": f"{Path(sys.executable).parent}:{place['PATH']}"}
    command = ["/bin/sh", "-e", "-c", lines]
    done = subprocess.run(command, cwd=folder, env=place, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, f"{lines}\n{done.stdout}{done.stderr}"
    return done.stdout


def run_here(text: str, folder: Path) -> str:
    """Run a command of `HERE` as a reader would, but in this process and with little grass; return its output."""
    printed = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.chdir(folder), contextlib.redirect_stdout(printed):
        patch.setenv("TALLGRASS_CACHE", str(folder / "cache"))
        patch.setitem(PRESETS, "low", LITTLE)
        patch.setattr(models, "mechanics_of", lambda _: ALIKE[0])
        patch.setattr(models, "_postures", lambda *_: POSTURES(*ALIKE))
        for line in text.splitlines():
            assert tallgrass(shlex.split(line)[1:]) == 0, line
    return printed.getvalue()


def coarser(text: str, how: dict[str, str] = COARSE) -> str:
    """Return the commands with smaller, coarser and fewer pictures, which take a tenth of the time."""
    for whole, coarse in how.items():
        text = re.sub(whole, coarse, text, flags=re.MULTILINE)
    return text


def follow(page: str, folder: Path, python: Python, little_grass: str, display: str = "") -> None:
    """Follow a page in a folder, with little grass."""
    told, little = "", "" if page in MEASURED else little_grass
    for block in blocks(page):
        text, language = block["text"], block["language"]
        name = folder / (block["file"] or "block.py")
        if block["file"] or language == "python":
            name.parent.mkdir(parents=True, exist_ok=True)
            name.write_text(coarser(text, SMALL) if language == "python" else text, "utf-8")
        if block["reason"] or (language == "python" and block["file"] and "pyglet.app.run()" not in text):
            continue
        if language == "python":
            before = GAME if "pyglet.app.run()" in text else ""
            python(folder, name.name, place={"DISPLAY": display} if display else {}, before=little + before)
        elif language == "yaml":
            parse_scene(text if "tallgrass:" in text else f"tallgrass: 2\ngrass: {{ lawn: {{}} }}\n{text}")
        elif language == "text":
            assert text.strip() in told or not told, f"{page}: {text}"
        told = ""
        if language == "sh":
            if program := PROGRAM.fullmatch(text):
                tested = text.startswith("pytest")
                words = (pytest.__main__.__file__, "-q", program[1]) if tested else (program[1],)
                told = python(folder, *words, place={}, before=little)
            else:
                told = (run_here if HERE.fullmatch(text) else run)(coarser(text), folder)


@pytest.mark.skipif(sys.platform == "win32", reason="the pages are written for a POSIX shell")
@pytest.mark.usefixtures("ctx")
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(name, marks=pytest.mark.slow if name in LONG else ())
        for name in FOLLOWED
        if not opens_a_window(name)
    ],
)
def test_n9_what_a_page_tells_to_do_works(page: str, tmp_path: Path, python: Python, little_grass: str) -> None:
    follow(page, tmp_path, python, little_grass)


@pytest.mark.window
@pytest.mark.parametrize(
    "page",
    [pytest.param(name, marks=pytest.mark.slow if name in LONG else ()) for name in FOLLOWED if opens_a_window(name)],
)
def test_what_a_page_with_windows_tells_to_do_works(
    page: str, tmp_path: Path, python: Python, little_grass: str, display: str
) -> None:
    follow(page, tmp_path, python, little_grass, display)


@pytest.mark.parametrize("page", FOLLOWED)
def test_every_block_of_a_page_is_of_a_language_that_is_run(page: str) -> None:
    text = written(page)
    assert len(blocks(page)) == len(re.findall("^```", text, re.MULTILINE)) // 2
    assert {block["language"] for block in blocks(page)} <= {"glsl", "python", "sh", "text", "yaml"}


def test_blocks_that_are_not_run_are_few_and_say_why() -> None:
    reasons = [block["reason"] for page in FOLLOWED for block in blocks(page) if block["reason"]]
    assert len(reasons) <= 5
    text = "".join(map(written, FOLLOWED))
    assert text.count("<!-- not run") == len(reasons), "a reason stands right above a block"


def test_the_problem_that_the_first_scene_makes_is_told_in_its_words(tmp_path: Path) -> None:
    page = {block["file"]: block["text"] for block in blocks("first-scene.md") if block["file"]}
    scene = tmp_path / "evening.yaml"
    scene.write_text(page["evening.yaml"].replace("stiffness: 0.8", "stifness: 0.8"), "utf-8")
    command = [sys.executable, "-m", "tallgrass.app.cli", "check", scene.name]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    (said,) = re.findall(r"^evening\.yaml:\d.*$", (DOCS / "first-scene.md").read_text("utf-8"), re.MULTILINE)
    assert said in (done.stdout + done.stderr).splitlines()


def test_n10_the_test_of_a_games_own_system_has_fifteen_lines_or_fewer() -> None:
    files: dict[str | None, str] = {block["file"]: block["text"] for block in blocks("testing.md")}
    written = [line for line in files["test_moths.py"].splitlines() if line.strip()]
    assert len(written) <= 15


Slug = Callable[[str], str]


def slug(title: str) -> str:
    """Return the anchor by which the generator links a heading."""
    return re.sub(r"[\s-]+", "-", re.sub(r"[^\w\s-]", "", title).strip().lower())


def anchors(page: Path) -> set[str]:
    return {slug(title) for title in re.findall(r"^#+ (.+)$", page.read_text("utf-8"), re.MULTILINE)}


@pytest.mark.parametrize("page", PAGES)
def test_every_link_of_a_page_leads_somewhere(page: str) -> None:
    for target, anchor in re.findall(r"\]\(([^)#\s]*)(?:#([^)]+))?\)", (DOCS / page).read_text("utf-8")):
        if target.startswith(("https://", "pictures/")):
            continue
        place = DOCS / (target or page)
        assert place.exists(), f"{page} links to {target}"
        if anchor:
            assert anchor in anchors(place), f"{page} links to {target}#{anchor}"


def test_no_page_is_left_out_of_the_manual() -> None:
    listed = re.findall(r"^ +- [^:\n]+: (\S+\.md)$", (DOCS / "mkdocs.yml").read_text("utf-8"), re.MULTILINE)
    assert set(listed) <= set(PAGES)
    linked = {name for page in listed for name in re.findall(r"\]\(([\w-]+\.md)", (DOCS / page).read_text("utf-8"))}
    assert set(PAGES) - set(listed) <= linked, "neither in the list of mkdocs.yml nor linked by a page that is"


def test_what_is_generated_of_the_pages_is_fresh() -> None:
    command = [sys.executable, "-m", "docs.making.pages", "--check"]
    done = subprocess.run(command, cwd=DOCS.parent, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_pages_that_are_generated_can_be_read_where_they_lie() -> None:
    told_by = {
        "scene.md": "| `stiffness` | a number |",
        "api.md": "### Prairie\n",
        "examples.md": "(../examples/day.py)",
    }
    for page, told in told_by.items():
        text = (DOCS / page).read_text("utf-8")
        assert told in text
        assert len(text) > 5 * len(written(page)), "only the generator's mark is there"


def test_a_trap_tells_that_pyglets_framebuffers_bring_no_viewport_of_their_own_and_they_do_not() -> None:
    parsed = ast.parse((Path(pyglet.__file__).parent / "image" / "buffer.py").read_text("utf-8"))
    (kind,) = [each for each in parsed.body if isinstance(each, ast.ClassDef) and each.name == "Framebuffer"]
    methods = [each for each in kind.body if isinstance(each, ast.FunctionDef) and each.name in {"bind", "unbind"}]
    source = "".join(map(ast.unparse, methods))
    assert source.count("glBindFramebuffer") == 2
    assert "iewport" not in source
    traps = written("embedding.md").partition("## Traps")[2]
    (trap,) = re.findall(r"^- \*\*Viewports\.\*\*.*\n(?:  .*\n)*", traps, re.MULTILINE)
    assert "`Framebuffer.bind`" in trap
    assert "glViewport" in trap
