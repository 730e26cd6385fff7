"""Checks with resized, empty, several and closed windows, and without a window."""

import sys
from pathlib import Path
from typing import Any

import pyglet
from pyglet import gl

from tallgrass.engine.gl.homes import Homes

from .drawing import around
from .game import SIZE, Game, configured, different, framebuffer, grown, matrices, objects, picture, prairies, together
from .states import depth_and_culling, tidy


def resize(game: Game, size: tuple[int, int]) -> None:
    """Resize the window, and let the display follow."""
    game.window.set_size(*size)
    for _ in range(3):
        game.window.dispatch_events()
        game.window.dispatch_event("_on_internal_resize", *size)
        game.window.switch_to()
        game.window.flip()


def check_resize(game: Game) -> str:
    """After a resize the prairie fills the window, as in one that always had that size."""
    if pyglet.options.headless:
        return ""  # there, what a window draws into keeps its size
    size = (220, 90)
    with prairies(lod="strips") as (prairie,):
        picture(prairie)
        resize(game, size)
        found, told = picture(prairie, size), around(game, prairie, tidy, size)
    with prairies(lod="strips") as (prairie,):
        expected = picture(prairie, size)
    with framebuffer(size), prairies(lod="strips") as (prairie,):
        elsewhere = picture(prairie, size)
    resize(game, SIZE)
    near = "" if (found != elsewhere).any(axis=-1).mean() < 0.005 else "it is another one"
    return together(prairie=different(found, expected), size=near, game=told)


def check_no_pixels(_: Game) -> str:
    """In a window without any pixels nothing is drawn, and nothing goes wrong."""
    with prairies(lod="strips") as (prairie,):
        for width, height in ((0, 0), (0, 50), (50, 0)):
            gl.glViewport(0, 0, width, height)
            prairie.draw(*matrices(prairie))
        gl.glViewport(0, 0, *SIZE)
        drawn = "" if prairie.painter is None else "something was made ready"
        return together(drawn=drawn, after=different(picture(prairie), picture(prairie)))


def check_two_windows(game: Game) -> str:
    """One prairie is drawn in two windows, each with objects of its own, and leaves nothing in either."""
    other = pyglet.window.Window(*SIZE, config=configured())
    tidy()
    before = []
    for window in (other, game.window):
        window.switch_to()
        before.append(objects())
    told = {}
    with prairies() as (prairie,):
        expected = picture(prairie)
        for number, window in enumerate((other, game.window, other)):
            window.switch_to()
            told[f"window {number}"] = different(picture(prairie), expected)
        game.window.switch_to()
        told["game"] = around(game, prairie, depth_and_culling)
    if pyglet.gl.current_context is not game.window.context:
        told["current"] = "another window is current after the release"
    for number, window in enumerate((other, game.window)):
        window.switch_to()
        told[f"left in {number}"] = grown(before[number])
    other.close()
    game.window.switch_to()
    return together(**told)


def check_window_made_again(game: Game) -> str:
    """A window is closed and another one opened: the prairie is drawn again, and nothing of the first stays."""
    told = {}
    with prairies() as (prairie,):
        expected = picture(prairie)
        before = objects()
        for number in range(3):
            window = pyglet.window.Window(*SIZE, config=configured())
            told[f"window {number}"] = different(picture(prairie), expected)
            window.close()
        homes: Homes[Any] = prairie._screen._painters  # noqa: SLF001
        told["painters"] = "" if len(homes) <= 2 else f"there are {len(homes)}"
        game.window.switch_to()
    empty = {kind: count for kind, count in objects().items() if count > before[kind]}
    return together(**told, objects=str(empty) if empty else "")


def resident() -> float:
    """Return the resident memory of this process [MB], 0 where it is unknown."""
    told = Path("/proc/self/statm")
    return int(told.read_text().split()[1]) * 4096 / 1e6 if told.exists() else 0.0


def check_rounds(_: Game) -> str:
    """Load and release a prairie many times: GL objects and memory do not grow."""
    rounds = int(sys.argv[2])
    memory, before = [], objects()
    for _round in range(rounds):
        with prairies() as (prairie,):
            picture(prairie)
        memory.append(resident())
    growth = memory[-1] - memory[rounds // 3]
    sys.stderr.write(f"{rounds} rounds: {memory[rounds // 3]:.1f} MB after a third, {memory[-1]:.1f} MB\n")
    told = "" if growth < 8.0 + 0.01 * rounds else f"{growth:.1f} MB more after {rounds} rounds"
    return together(objects=grown(before), memory=told)


def check_no_window() -> str:
    """With pyglet's hidden window alone, drawing is refused in one sentence."""
    said = ""
    with prairies() as (prairie,):
        try:
            prairie.draw(*matrices(prairie))
        except RuntimeError as error:
            said = str(error)
    return "" if said.startswith("there is no window yet: create the window") and "\n" not in said else f"said {said!r}"
