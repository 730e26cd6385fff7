"""Checks that the game and its prairie leave each other's drawing alone."""

from collections.abc import Callable

import numpy as np
import pyglet
from pyglet import gl

from tallgrass.systems.prairie import Prairie

from .game import (
    LOADED,
    SIZE,
    Game,
    Picture,
    clear,
    different,
    framebuffer,
    matrices,
    picture,
    prairies,
    read,
    read_depth,
    together,
)
from .states import STATES, depth_and_culling, disorder, masks, scissor, tidy


def frames(game: Game, prairie: Prairie | None, size: tuple[int, int] = SIZE) -> list[Picture]:
    """Return pictures of the game's own drawing before, between and after two prairies, in a second frame."""
    seen: list[Picture] = []
    draws = (game.draw_raw, game.draw_flat, game.draw_solid)
    game.bind()
    for _ in range(2):
        seen = []
        for draw in (*draws, None, *draws, None, *draws):
            clear()
            if draw is not None:
                draw()
                seen.append(read(size))
                if draw == game.draw_solid:
                    game.bind()
            elif prairie is not None:
                prairie.draw(*matrices(prairie, size))
                prairie.advance(0.03)
    return seen


def around(game: Game, prairie: Prairie, leave: Callable[[], None], size: tuple[int, int] = SIZE) -> str:
    """Compare the game's own drawing around a prairie with the same without one."""
    told: dict[str, str] = {}
    tidy()
    leave()
    alone = frames(game, None, size)
    tidy()
    leave()
    found = frames(game, prairie, size)
    tidy()
    drawn = {"raw": alone[0], "flat": alone[1], "solid": alone[2]}
    if leave in STATES[:2]:
        told |= {
            name: "next to nothing" for name, one in drawn.items() if (one != one[-1, -1]).any(axis=-1).sum() < 500
        }
    names = [f"{what} {when}" for when in ("before", "between", "after") for what in ("raw", "flat", "solid")]
    for name, one, two in zip(names, alone, found, strict=True):
        told[name] = different(one, two)
    return together(**told)


def check_pyglets_drawing(game: Game) -> str:
    """Sprites, labels, shapes, models and raw GL look alike with prairies around them, whatever was set."""
    told = {}
    with prairies(2) as (first, last):
        for leave in STATES:  # one makes what it draws with while nothing is set, the other while everything is
            told[leave.__name__] = around(game, last if leave is disorder else first, leave)
    return together(**told)


def check_samplers(game: Game) -> str:
    """A sampler that the game left on its texture unit stays there, and off the prairie's textures."""
    with prairies() as (prairie,):
        neutral = picture(prairie)

        def leave() -> None:
            for unit in range(4):
                gl.glBindSampler(unit, game.sampler)

        leave()
        return together(prairie=different(picture(prairie), neutral), game=around(game, prairie, leave))


def check_hostile_state(game: Game) -> str:
    """The prairie itself looks alike whatever the game has set; blue alone stays where the game keeps it."""
    told = {}
    with prairies() as (prairie,):
        neutral = picture(prairie)
        clear()
        without_blue = np.concatenate([neutral[..., :2], read()[..., 2:]], axis=-1)
        for leave in STATES:
            game.bind()
            clear()
            leave()
            prairie.draw(*matrices(prairie))
            tidy()
            found = read()
            if leave is scissor:
                inside = np.zeros(found.shape[:2], np.bool_)
                inside[SIZE[1] - 89 : SIZE[1] - 9, 7:127] = True
                told["cut off"] = different(found[inside][None], neutral[inside][None])
                told["beside"] = "" if (found[~inside] == found[0, 0]).all() else "something was drawn"
            else:
                told[leave.__name__] = different(found, without_blue if leave in (masks, disorder) else neutral)
    return together(**told)


def check_host_framebuffer(game: Game) -> str:
    """In a framebuffer of the game's own, of a size of its own, everything is as in the window."""
    large = (2 * SIZE[0], 2 * SIZE[1])
    clear()
    window = read()
    with framebuffer(large):
        with prairies() as (prairie,):
            states = ("tidy", tidy), ("3D", depth_and_culling)
            told = {name: around(game, prairie, leave, large) for name, leave in states}
            found = picture(prairie, large)
        told["prairie"] = "" if len(np.unique(found[-80:].reshape(-1, 3), axis=0)) > 500 else "it is not all there"
    return together(**told, window=different(read(), window))


def check_attachments(_: Game) -> str:
    """In a framebuffer with two attachments the prairie is in the first; in one with depth alone its depth is there."""
    with prairies() as (prairie,):
        window = picture(prairie)
        depths = []
        with framebuffer(SIZE):
            second = pyglet.image.Texture.create(*SIZE)
            place = gl.GL_COLOR_ATTACHMENT1
            gl.glFramebufferTexture2D(gl.GL_FRAMEBUFFER, place, gl.GL_TEXTURE_2D, second.id, 0)
            gl.glDrawBuffers(2, (gl.GLenum * 2)(gl.GL_COLOR_ATTACHMENT0, place))
            found = picture(prairie)
            depths.append(read_depth())
            gl.glReadBuffer(place)
            beside = read()
        for attachment in range(2):
            with framebuffer(SIZE, colors=False):
                clear()
                if attachment:
                    prairie.draw(*matrices(prairie))
                depths.append(read_depth())
        second.delete()
    return together(
        first="" if (found != window).any(axis=-1).mean() < 0.005 else "it is another picture",
        second="" if (beside == beside[0, 0]).all() else "something was drawn",
        depth="" if np.array_equal(depths[0], depths[2]) else "it differs",
        empty="" if (depths[1] == 1.0).all() and (depths[2] < 1.0).any() else "there is none",
    )


def check_batch(_: Game) -> str:
    """In a batch the prairie is drawn in its turn; it can be hidden, taken out, and released there."""
    batch = pyglet.graphics.Batch()
    square = pyglet.image.SolidColorImagePattern((255, 0, 0, 255)).create_image(40, 30)
    orders = {order: pyglet.graphics.Group(order) for order in (0, 2)}
    sprites = {
        order: pyglet.sprite.Sprite(square, 40 * order, 10, batch=batch, group=orders[order]) for order in (0, 2)
    }

    def draw() -> Picture:
        clear()
        batch.draw()
        return read()

    without = draw()
    red = (without == (255, 0, 0)).all(axis=-1)
    behind, front = red & (np.arange(SIZE[0]) < 60), red & (np.arange(SIZE[0]) > 60)
    with prairies() as (prairie,):
        expected = picture(prairie)
        group = prairie.group(batch, lambda: matrices(prairie), order=1)
        found = draw()
        told = {
            "behind": different(found[~front][None], expected[~front][None]),
            "in front": different(found[front][None], without[front][None]),
            "red": "" if behind.any() and front.any() else "the sprites are not seen",
        }
        group.visible = False
        told["hidden"] = different(draw(), without)
        group.visible = True
        told["shown"] = different(draw(), found)
        inside = pyglet.graphics.Group(0, parent=group)
        sprites[0].group = inside
        told["inside"] = "" if (draw() == (255, 0, 0)).all(axis=-1)[behind].all() else "it is not over the prairie"
        sprites[0].group = orders[0]
        group.delete()
        told["taken out"] = different(draw(), without)
        other, again = Prairie(LOADED, live=False), Prairie(LOADED, live=False)
        for order, extra in ((1, other), (3, again)):
            extra.group(batch, lambda extra=extra: matrices(extra), order=order)  # type: ignore[misc]
        draw()
        again.release()
        told["one of two"] = different(draw(), found)
        other.release()
        told["released"] = different(draw(), without)
    return together(**told)


def check_camera_of_a_batch(_: Game) -> str:
    """A group's camera that returns no matrices is told of in one sentence."""
    batch = pyglet.graphics.Batch()
    with prairies() as (prairie,):
        group = prairie.group(batch, lambda: None)  # type: ignore[arg-type, return-value]
        try:
            batch.draw()
        except TypeError as error:
            due = "returns the view and the projection matrix, not None"
            return "" if due in str(error) else str(error)
        finally:
            group.delete()
    return "it is drawn"
