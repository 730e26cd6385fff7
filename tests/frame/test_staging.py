"""Grass that is sent to GL while other grass is drawn, and then not wanted (F4)."""

import gc
from collections.abc import Callable
from time import sleep
from typing import Any

import moderngl
import pytest

from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]


def play_until_staged(stage: Stage, prairie: Prairie, *, wholly: bool = False) -> None:
    """Draw frames until a piece of the grass that has grown anew is in GL, or the last one, which is the carpet's."""
    painter = prairie.painter
    assert painter is not None
    carpet: Any = painter.painters["carpet"]
    before, beside = painter._staged, carpet._staged  # noqa: SLF001 - no frame shows them
    for _ in range(500):
        prairie.advance(0.05)
        stage.shot(prairie)
        staged: Any = painter._staged  # noqa: SLF001
        is_whole = carpet._staged is not beside or "carpet" in getattr(staged, "painters", ())  # noqa: SLF001
        if staged not in (None, before) and (is_whole or not wholly):
            return
        sleep(0.01)
    pytest.fail("it never comes")


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("keys", [{}, {"withered": 0.3}], ids=["same programs", "other programs"])
def test_f4_grass_that_is_given_up_half_way_leaves_nothing_behind_in_gl(
    ctx: moderngl.Context, stage: Stage, load: Load, keys: dict[str, Any]
) -> None:
    prairie = load(LITTLE)
    stage.shot(prairie)
    saved = prairie.state()
    gc.collect()  # what other tests have left
    before, ctx.gc_mode = ctx.gc_mode, "context_gc"
    ctx.objects.clear()
    try:
        for pieces in (0, 2, 5):
            prairie.change_kind("tall", height=[0.5, 1.0 + 0.02 * pieces], over=1000.0, **keys)
            play_until_staged(stage, prairie)
            for _ in range(pieces):
                prairie.advance(0.05)
                stage.shot(prairie)
            prairie.restore(saved)
        for stiffness in (1.5, 1.6):
            prairie.restore(saved)
            prairie.change_kind("short", stiffness=stiffness)
            play_until_staged(stage, prairie, wholly=True)
        prairie.release()
        gc.collect()
        dropped = [thing for thing in ctx.objects if not isinstance(thing, moderngl.InvalidObject)]
    finally:
        ctx.gc_mode = before
        ctx.objects.clear()
    assert dropped == []
