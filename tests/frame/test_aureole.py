"""The sun in the sky: the width of its disc, and its aureole (F5)."""

import math
from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from tallgrass.engine.camera import Camera
from tallgrass.systems.light.color import shown_as
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

SCENE = """\
tallgrass: 2
terrain: { size: [60, 60] }
grass: { turf: { height: [0.3, 0.5], blades: 300 } }
quality: low
"""


def test_f5_the_suns_disc_is_half_a_degree_wide(ctx: moderngl.Context, load: Load) -> None:
    """It is the brightest of the sky: its aureole, which dazzles with it, is darker by a tenth from its edge on."""
    prairie = load(f"{SCENE}light: {{ azimuth: 0, elevation: 40 }}", linear=True)
    size, view = (240, 240), math.radians(4.0)
    target = ctx.framebuffer([ctx.texture(size, 4, dtype="f4")], ctx.depth_renderbuffer(size))
    target.use()
    target.clear()
    at_sun = Camera((0.0, 2.0, 0.0), 0.0, math.radians(40.0), view)
    prairie.draw(*Stage(ctx, size).matrices(at_sun))
    seen = np.frombuffer(target.read(components=3, dtype="f4"), np.float32).reshape(*size, 3)
    shine = seen[size[1] // 2, :, 0]
    across = np.flatnonzero(shine > 0.9 * shine.max())
    assert (np.diff(across) == 1).all()
    degrees = math.degrees(2.0 * math.atan(len(across) / size[1] * math.tan(view / 2.0)))
    assert degrees == pytest.approx(0.53, rel=0.06)


def test_f5_the_sun_dazzles_and_the_sky_is_bright_about_it(ctx: moderngl.Context, load: Load) -> None:
    """A degree beside it all is white; its aureole falls off by the square of the angle."""
    prairie = load(f"{SCENE}light: {{ azimuth: 0, elevation: 40 }}")
    view = Camera((0.0, 2.0, 0.0), 0.0, math.radians(40.0), math.radians(16.0))  # a tenth of a degree a pixel
    sky = Stage(ctx, (240, 160)).shot(prairie, view)[80, 120:]
    assert sky[:10].min() > 250
    light = shown_as(sky / 255.0).mean(axis=1)
    near, far, beyond = light[30], light[60], light[110]
    assert 3.0 < (near - beyond) / (far - beyond) < 6.0
