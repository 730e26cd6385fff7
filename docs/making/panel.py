"""`python -m docs.making.panel`: draws docs/images/edit.webp, the panel over a scene; it takes a display, or Xvfb."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from tallgrass.app.display import need_display
from tallgrass.app.studio.take import Take
from tallgrass.systems.prairie import Prairie

if TYPE_CHECKING:
    from tallgrass.app.edit.window import EditWalk

FILE = Path(__file__).parents[1] / "images" / "edit.webp"
SCENE, TIME, SIZE = "whirlwind", 6.0, (1120, 630)
PICKED = 2
"""The wind that is picked, by its number in the scene."""


def main() -> None:
    """Draw the picture."""
    need_display()
    from tallgrass.app.edit.window import EditWalk
    from tallgrass.app.window import open_window

    prairie = Prairie.load(SCENE)
    walk = EditWalk(open_window(SIZE), prairie, Take(SCENE, SIZE))
    prairie.advance(TIME)
    walk.hold(0.0)
    walk.tell([])
    walk.editor.picked = PICKED
    walk.editor.set(("light", "elevation"), 24.0)
    for _ in range(4):
        walk.frame(1 / 60)
        walk.window.dispatch_events()
    Image.fromarray(shown(walk)).save(FILE, quality=82, method=6)
    walk.close()
    print(FILE)


def shown(walk: "EditWalk") -> NDArray[np.uint8]:
    """Draw a walk's window once more, and return what is in it."""
    walk.window.switch_to()
    walk.on_draw()
    target = walk.ctx.detect_framebuffer()
    width, height = walk.window.get_framebuffer_size()
    data = np.frombuffer(target.read((0, 0, width, height), alignment=1), np.uint8)
    return data.reshape(height, width, 3)[::-1]


if __name__ == "__main__":
    main()
