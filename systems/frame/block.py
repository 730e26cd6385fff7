"""What every program knows of a frame, in one uniform block."""

from collections.abc import Mapping, Sequence
from math import cos, radians

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.camera import View, eye_of
from ...engine.declared.scene import Scene
from ...engine.gl.shaders import program
from ...engine.terrain.record import Terrain
from ..around.canopy import canopy_height
from ..grow.record import GIVES, Growth
from .light import daylight, display, grain, linear, lit_kind, to_sun

FRAME = np.dtype(
    [
        ("clip", "16f4"),
        ("unclip", "16f4"),
        ("eye", "4f4"),
        ("sun", "4f4"),
        ("zenith", "4f4"),
        ("haze", "4f4"),
        ("glow", "4f4"),
        ("soil", "4f4"),
        ("terrain", "4f4"),
        ("field", "4f4"),
        ("screen", "4f4"),
        ("root", "(4,4)f4"),
        ("tip", "(4,4)f4"),
        ("grain_x", "(4,4)f4"),
        ("grain_z", "(4,4)f4"),
        ("give", f"({GIVES},4)f4"),
    ]
)
"""The block's fields, as `lib/frame.glsl` declares them (std140)."""


def frame_record(scene: Scene, growths: list[Growth], terrain: Terrain, patch: float) -> NDArray[np.void]:
    """Return the block with all that holds for the whole scene, shape (1,); `aim` fills in the rest."""
    record = np.zeros(1, FRAME)
    light = scene.light
    row = record[0]
    row["sun"] = (*to_sun(light), light.strength * max(0.0, cos(radians(light.elevation))))
    row["zenith"][:3] = display(linear(light.zenith))
    row["haze"] = (*display(linear(light.horizon)), 1.0 / light.haze)
    row["glow"][:3] = display(linear(light.sun)) * min(1.0, light.strength)
    row["soil"] = (*display(linear(light.ground) * daylight(light)), patch)
    postures = growths[0].postures.shape
    row["terrain"] = (*terrain.origin, terrain.cell, postures.shape[2] - 1)
    row["field"] = (*terrain.size, postures.shape[1], postures.shape[0])
    for index, (kind, growth) in enumerate(zip(scene.grass.values(), growths, strict=True)):
        root, tip = lit_kind(kind, light)
        row["root"][index] = (*root, canopy_height(growth))
        row["tip"][index] = (*tip, kind.taper)
        row["grain_x"][index, :3], row["grain_z"][index, :3] = grain(kind, light)
        row["give"][:, index] = growth.postures.give
    return record


def aim(record: NDArray[np.void], view: View, size: tuple[int, int], /) -> None:
    """Write the frame's matrices, eye and picture size [pixels] into the block."""
    clip = view.projection.astype(np.float64) @ view.view.astype(np.float64)
    row = record[0]
    row["clip"] = clip.T.reshape(16)
    row["unclip"] = np.linalg.inv(clip).T.reshape(16)
    row["screen"][:2] = size[0] / 2, size[1] / 2
    row["eye"][:3] = eye_of(view)


def frame_binding(ctx: moderngl.Context) -> int:
    """Return the binding point of the block: the highest, away from a host's own."""
    return int(ctx.info["GL_MAX_UNIFORM_BUFFER_BINDINGS"]) - 1


class FrameBlock:
    """The uniform block on the graphics card."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.buffer = ctx.buffer(reserve=FRAME.itemsize, dynamic=True)
        self.binding = frame_binding(ctx)

    def join(self, program: moderngl.Program) -> None:
        """Tell a program where the block is."""
        program["Frame"].binding = self.binding  # type: ignore[union-attr]

    def write(self, record: NDArray[np.void]) -> None:
        """Send the block and bind it."""
        self.buffer.write(record)
        self.buffer.bind_to_uniform_block(self.binding)

    def release(self) -> None:
        """Give the buffer back."""
        self.buffer.release()


def by_kind(values: Sequence[float]) -> tuple[float, ...]:
    """Return a figure per kind as the four numbers of a shader's vector."""
    return (*values, *[0.0] * (4 - len(values)))


def joined(
    ctx: moderngl.Context,
    block: FrameBlock,
    units: Mapping[str, int],
    vertex: str,
    fragment: str | None,
    defines: Mapping[str, str | int],
    *,
    varyings: tuple[str, ...] = (),
) -> moderngl.Program:
    """Return a program that knows where the block and the textures are; `units` gives each sampler its unit.

    Without a fragment shader, the outputs that `varyings` names are written into a buffer.
    """
    made = program(ctx, vertex, fragment, defines=defines, varyings=varyings)
    block.join(made)
    for name, unit in units.items():
        if name in made:
            made[name] = unit
    return made
